// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a fuzz target on kept inputs: every file of the folders and every file named. Ends with 1 when there is none.
#include "tests/fuzz/fuzz_file.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

namespace {

int replay(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  return LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

} // namespace

int main(int argc, char** argv) {
  int n = 0;
  for (int k = 1; k < argc; ++k) {
    if (!std::filesystem::is_directory(argv[k])) {
      replay(argv[k]);
      ++n;
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(argv[k])) {
      replay(entry.path());
      ++n;
    }
  }
  std::printf("%d inputs\n", n);
  return n > 0 ? 0 : 1;
}

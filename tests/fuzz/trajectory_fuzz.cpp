// SPDX-License-Identifier: GPL-3.0-or-later
// Trajectories: the bytes are changes to a sound file (a dataset removed, replaced by one of another shape or type, a
// value altered, a link put in its place), made with HDF5 itself. What is left is read, started from and evaluated.
#include "bpm/io/input_error.h"
#include "tests/fuzz/fuzz_file.h"
#include "tests/support/hdf5_edits.h"
#include "tests/support/small_trajectory.h"
#include "tests/support/temporary_folder.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace {

using boba::test::Hdf5Edit;

/// The sound file, and the names of what is in it.
struct Sound {
  boba::test::TemporaryFolder folder;
  std::vector<std::uint8_t> bytes;
  std::vector<std::string> datasets;

  Sound() {
    boba::test::write_small_trajectory(folder / "sound.h5");
    const std::string text = boba::test::content_of(folder / "sound.h5");
    bytes.assign(text.begin(), text.end());
    datasets = boba::test::hdf5_datasets(folder / "sound.h5");
  }
};

/// Hands out the input byte by byte, zeros at its end.
class Bytes {
public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  bool empty() const { return at_ == end_; }
  unsigned next() { return empty() ? 0U : *at_++; }

private:
  const std::uint8_t *at_, *end_;
};

double value_of(Bytes& bytes) {
  constexpr std::array<double, 16> odd = {0.0,    -1.0, 1.0,          2.0,          1e300,   -1e300, 1e9,   1.0000001e9,
                                          5e-324, 1e-7, 2147483647.0, 2147483648.0, -9.3e18, 1.8e19, 1e160, 0.5};
  const unsigned kind = bytes.next() % 20;
  if (kind < odd.size()) {
    return odd[kind];
  }
  return kind == 16   ? std::numeric_limits<double>::quiet_NaN()
         : kind == 17 ? std::numeric_limits<double>::infinity()
                      : static_cast<double>(bytes.next()) + static_cast<double>(bytes.next()) / 256.0 - 128.0;
}

std::uint64_t length_of(Bytes& bytes) {
  constexpr std::array<std::uint64_t, 10> odd = {0, 1, 2, 3, 4, 6, 1 << 16, 1ULL << 33, 1ULL << 40, 1ULL << 62};
  const unsigned kind = bytes.next() % 16;
  return kind < odd.size() ? odd[kind] : bytes.next();
}

Hdf5Edit edit_of(Bytes& bytes, const std::vector<std::string>& datasets) {
  Hdf5Edit edit;
  edit.dataset = datasets[bytes.next() % datasets.size()];
  edit.what = static_cast<Hdf5Edit::What>(bytes.next() % 9);
  edit.type = static_cast<Hdf5Edit::Type>(bytes.next() % 10);
  edit.value = value_of(bytes);
  edit.at = bytes.next() + 256ULL * bytes.next();
  edit.other = datasets[bytes.next() % datasets.size()];
  for (unsigned rank = bytes.next() % 5; rank > 0; --rank) {
    edit.shape.push_back(length_of(bytes));
  }
  return edit;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Sound sound;
  Bytes bytes(data, size);
  std::vector<Hdf5Edit> edits;
  while (!bytes.empty() && edits.size() < 4) {
    edits.push_back(edit_of(bytes, sound.datasets));
  }
  // A new file each time: HDF5 knows files by their inode, and would not open one for writing that it still reads.
  static std::uint64_t n_inputs = 0;
  const std::filesystem::path path = sound.folder / ("input-" + std::to_string(n_inputs++) + ".h5");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(sound.bytes.data()), static_cast<std::streamsize>(sound.bytes.size()));
  boba::test::apply(path, edits);
  try {
    boba::test::use_trajectory(path);
  } catch (const boba::InputError&) {
  }
  std::filesystem::remove(path);
  return 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes: parsed, checked against the schema, turned into a Scene; its estimate of memory is asked for too.
#include "bpm/io/input_error.h"
#include "bpm/scene/scene.h"
#include "bpm/scene/scene_size.h"
#include "tests/fuzz/fuzz_file.h"

#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Bytes behind a line "%%" are overrides of the command line, one a line.
  const std::string all(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = all.find("\n%%\n");
  const std::string text = all.substr(0, cut == std::string::npos ? all.size() : cut + 1);
  std::vector<std::string> overrides;
  for (std::size_t at = cut == std::string::npos ? all.size() : cut + 4; at < all.size() && overrides.size() < 4;) {
    const std::size_t end = std::min(all.find('\n', at), all.size());
    overrides.push_back(all.substr(at, end - at));
    at = end + 1;
  }
  try {
    const boba::Scene scene = boba::read_stored_scene(text, "scene.toml", overrides);
    const std::filesystem::path folder = scene.output.directory.lexically_normal();
    if (folder.is_absolute() || *folder.begin() == "..") {
      __builtin_trap(); // a scene writes below the folder it is run in
    }
  } catch (const boba::InputError&) {
  }
  return 0;
}

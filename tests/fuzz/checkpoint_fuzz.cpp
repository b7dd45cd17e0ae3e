// SPDX-License-Identifier: GPL-3.0-or-later
// Checkpoints. Half of the inputs are read as they are; the others get the length and the checksum that fit them first,
// so that what lies behind these checks is reached too, and are turned into a run.
#include "bpm/app/checkpoint_observer.h"
#include "bpm/io/checkpoint.h"
#include "bpm/io/input_error.h"
#include "tests/fuzz/fuzz_file.h"

#include <cstring>
#include <vector>
#include <zlib.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> bytes(data, data + size);
  if (size >= 32 && data[size - 1] % 2 == 0) {
    const std::uint64_t length = size;
    std::memcpy(bytes.data(), "BOBACKP3", 8);
    std::memcpy(bytes.data() + 8, &length, 8);
    const std::uint64_t sum = crc32_z(0, bytes.data(), size - 8);
    std::memcpy(bytes.data() + size - 8, &sum, 8);
  }
  try {
    const std::filesystem::path path = boba::fuzz::file_of(bytes);
    boba::LatestCheckpoint checkpoint{path, boba::read_checkpoint(path), {}};
    boba::setup_from(checkpoint, boba::OutputFolder("fuzz"));
  } catch (const boba::InputError&) {
  }
  return 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// LAMMPS data files: read, and their bonds joined into grains and templates.
#include "bpm/io/input_error.h"
#include "bpm/io/lammps_packing.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const boba::LammpsPacking read = boba::read_lammps_packing({boba::fuzz::file_of({data, size}), {}, {}});
    for (const boba::Vector3& x : read.packing.position) {
      if (!x.allFinite()) {
        __builtin_trap();
      }
    }
  } catch (const boba::InputError&) {
  }
  return 0;
}

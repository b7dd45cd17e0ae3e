// SPDX-License-Identifier: GPL-3.0-or-later
// LAMMPS dumps: the last frame, the list of frames, and the frame of a time step.
#include "bpm/io/input_error.h"
#include "bpm/io/lammps_dump.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path path = boba::fuzz::file_of({data, size});
  try {
    const boba::LammpsFrame frame = boba::read_lammps_dump(path);
    for (const boba::Vector3& x : frame.position) {
      if (!x.allFinite()) {
        __builtin_trap();
      }
    }
    const auto steps = boba::lammps_dump_timesteps(path);
    boba::read_lammps_dump(path, steps.front());
  } catch (const boba::InputError&) {
  }
  return 0;
}

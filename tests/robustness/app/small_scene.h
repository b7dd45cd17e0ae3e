// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace boba::test {

/// Four small grains: placed, compressed, sheared; a second or less.
inline const std::string small_scene = R"(title = "four small grains"
seed = 3

[run]
threads = 1

[output]
directory = "out"

[output.table]
every_strain = 0.01
every_time = 20

[output.trajectory]
every_strain = 0.05
velocities = true

[[template]]
name = "grain"
nodes = 60

[[species]]
count = 4
alpha = 2.0

[[stage]]
type = "insert"
packing_fraction = 0.2

[[stage]]
type = "compress"
pressure = 0.1
rate = 4e-3
pressure_tolerance = 0.01
kinetic_tolerance = 1e-2

[[stage]]
type = "shear"
rate = 1e-3
strain = 0.5
pressure = 0.1
gain = 0.05
)";

/// Runs `boba` with these arguments in the folder.
inline ProgramResult boba(const std::vector<std::string>& arguments, const TemporaryFolder& folder,
                          std::optional<Disturbance> disturbance = std::nullopt) {
  std::vector<std::string> command{BOBA_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_program(command, (folder / "").string(), disturbance);
}

/// A table without its last column, the speed: the only one that depends on the clock.
inline std::string table_without_speed(const std::filesystem::path& path) {
  std::istringstream in(content_of(path));
  std::string text;
  for (std::string line; std::getline(in, line);) {
    text += line.substr(0, line.rfind(',')) + "\n";
  }
  return text;
}

} // namespace boba::test

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/run_program.h"

#include <cstdlib>
#include <string>
#include <vector>

namespace boba::test {

/// Runs a command on so many ranks, without mpirun for one. Ranks of a test share cores; a container's user may be
/// root.
inline ProgramResult run_on_ranks(int ranks, const std::string& folder, const std::vector<std::string>& command,
                                  std::optional<Disturbance> disturbance = std::nullopt) {
  for (const char* name :
       {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "OMPI_MCA_mpi_yield_when_idle"}) {
    setenv(name, "1", 1);
  }
  setenv("OMPI_MCA_btl", "self,vader", 1); // this machine's memory only
  std::vector<std::string> words;
  if (ranks > 1) {
    words = {BOBA_MPIRUN, "--oversubscribe", "--bind-to", "none", "-np", std::to_string(ranks)};
  }
  words.insert(words.end(), command.begin(), command.end());
  return run_program(words, folder, disturbance);
}

} // namespace boba::test

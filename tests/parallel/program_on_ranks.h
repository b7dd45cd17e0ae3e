// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/parallel/mpirun.h"
#include "tests/support/temporary_folder.h"

#include <string>
#include <vector>

namespace boba::test {

/// Runs the program itself on so many ranks, in the folder.
inline ProgramResult boba_on(int ranks, const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
  std::vector<std::string> command{BOBA_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_on_ranks(ranks, (folder / "").string(), command);
}

/// How often a part stands in a text.
inline int count_of(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++n;
  }
  return n;
}

} // namespace boba::test

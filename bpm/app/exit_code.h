// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// What a command tells the shell. The table in README.md and every script rely on these numbers.
enum class ExitCode {
  done = 0,
  failed = 1,       ///< the run could not go on, a file could not be written, ...
  wrong_input = 2,  ///< nothing was written
  check_failed = 3, ///< the command did its work and the answer is no
  stopped = 75      ///< by a signal or the wall-time limit, with a checkpoint to go on from
};

} // namespace boba

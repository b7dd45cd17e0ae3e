// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/exit_code.h"
#include "bpm/app/run_setup.h"
#include "bpm/parallel/ranks.h"

namespace boba {

/// Runs the stages of a scene from its beginning, or from where its checkpoint was, and writes what it asks for.
///
/// All ranks call it; rank 0 alone writes. Prints a line a stage and a summary. Returns done, or stopped after a signal
/// or the wall-time limit (with a checkpoint). \throws BlowUp, std::runtime_error; the last checkpoint stays.
ExitCode run_scene(RunSetup setup, const Ranks& ranks);

} // namespace boba

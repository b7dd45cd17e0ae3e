// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// The program `boba`: reads the command line, runs one command, turns errors into exit codes (ExitCode).
///
/// A program of your own registers its stages and starts (bpm/stages/stage_registry.h), then calls this in main().
/// \param argc, argv of main()
int run_command_line(int argc, char** argv);

} // namespace boba

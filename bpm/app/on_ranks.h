// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/exit_code.h"
#include "bpm/parallel/ranks.h"

#include <functional>

namespace boba {

/// Runs `work` on the ranks the program was started on; without mpirun it is simply called.
///
/// An error is told once, with the rank that met it, and ends all ranks.
ExitCode on_all_ranks(const std::function<ExitCode(const Ranks&)>& work);

/// The program is one of several, and not the first: what all of them would print alike, it keeps to itself.
bool is_other_rank();

} // namespace boba

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

/// The launcher's variables say that the program is one of several, and not the first.
bool is_other_rank();

/// What all ranks would say alike, the first says: others wait this long before they say it too. By then the launcher
/// has ended them; where there is no first rank (a variable that was left over), it is not lost.
void wait_for_first_rank(int milliseconds);

} // namespace boba

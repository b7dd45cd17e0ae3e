// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// Lets threads that wait at the end of a loop sleep after about 0.1 ms instead of spinning for tens of ms, and starts
/// this program again with that setting; returns when it is in force (or cannot be had).
///
/// The OpenMP runtime reads it once, before main. Spinning costs nothing on an idle machine, but when another program
/// has one of the cores, each step waits for a thread that waits for its core: 5.7 against 22 M node-steps/s were seen
/// with two threads. A user's own OMP_WAIT_POLICY or GOMP_SPINCOUNT stands.
void shorten_thread_waiting(char** argv);

} // namespace boba

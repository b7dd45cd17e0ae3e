// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// Says on standard error when more threads are to run than there are cores for: each step waits for the slowest.
void warn_of_threads(int threads);

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// What is told when memory runs out.
inline constexpr const char* out_of_memory =
    "out of memory: the process may not have as much as it needs; `boba check` "
    "tells what a scene needs, and checkpoints that were written are kept";

/// An error inside a loop over threads cannot be caught outside of it and would end in an abort. From now on it ends
/// the process with its message in one line and exit code 1.
void tell_uncaught_errors();

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace boba {

/// Most steps that a stage may have: far beyond any run, and far from what integers and doubles can count.
inline constexpr double most_steps = 1e15;

/// Steps of length dt that a duration takes: ceil(duration / dt), a whole number up to rounding being that number.
/// \throws std::invalid_argument when there are more than `most_steps`, or when that is no number.
std::int64_t step_count(double duration, double dt);

} // namespace boba

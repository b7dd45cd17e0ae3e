// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

namespace boba::measure {

/// Mean of a correlated series with the standard error of that mean.
struct BlockedMean {
  double mean = 0.0;
  double standard_error = 0.0;
  double naive_error = 0.0; ///< as if the values were independent; the ratio squared is the statistical inefficiency
  std::int64_t n_values = 0;
  std::int64_t block_size = 1;  ///< values a block at which the error was read
  bool reached_plateau = false; ///< false: the series is too short for its correlation; the error is a lower bound
};

/// Blocking: neighbouring values are averaged in pairs again and again; the error of the mean of blocks of size B,
/// e_B = sqrt(variance of the blocks / (n_blocks - 1)), grows until blocks are independent and then only gets noisier.
/// Read at the smallest B with B^3 > 2 n (e_B / e_1)^4, where both effects are balanced, with at least 8 blocks; a
/// series without such a B yields the largest e_B and reached_plateau = false.
///
/// \throws std::invalid_argument for fewer than two values or one that is not finite.
/// Source: Flyvbjerg, Petersen, J. Chem. Phys. 91, 461 (1989); block size: Lee, Conduit, Nemec, Lopez Rios, Drummond,
/// Phys. Rev. E 83, 066706 (2011).
BlockedMean blocked_mean(std::span<const double> values);

/// The same over the values whose abscissa lies in (first, last), e.g. mu over 1 < strain < 5. Values must be evenly
/// spaced for the blocks to mean anything.
/// \throws std::invalid_argument also when fewer than two values fall into the window.
BlockedMean blocked_mean_in_window(std::span<const double> abscissae, std::span<const double> values, double first,
                                   double last);

} // namespace boba::measure

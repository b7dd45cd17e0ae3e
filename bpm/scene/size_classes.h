// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace boba {

/// "normal", "lognormal", "uniform".
const std::vector<std::string>& size_distributions();

/// Diameters (over their mean) of `n` classes with the same share each, in growing order: the means of the
/// distribution's n slices of equal weight, stretched about 1 so that mean and standard deviation are exactly 1 and
/// `spread`.
///
/// With Phi and phi the normal distribution and its density and q_i = Phi^-1(i/n), the slice means are
/// normal: 1 + spread n (phi(q_i) - phi(q_i+1)); lognormal, s^2 = ln(1 + spread^2): n (Phi(s - q_i) - Phi(s - q_i+1)).
/// \throws std::invalid_argument for another name, n < 2, or when the smallest class is below a twentieth of the mean.
std::vector<double> size_classes(const std::string& distribution, double spread, int n);

/// Shares of the grains by number from shares of their volume: w_i / d_i^3, not normalised.
std::vector<double> shares_by_number(const std::vector<double>& shares_of_volume, const std::vector<double>& diameters);

/// `count` grains dealt out in the ratio of `shares` (positive): the whole part for each class, what is left to the
/// largest remainders, the first of equals.
std::vector<std::int64_t> dealt_out(std::int64_t count, const std::vector<double>& shares);

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/size_classes.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace boba {

namespace {

double normal_density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}

double normal_distribution(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// Phi^-1(i / n).
double quantile(int i, int n) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (i == 0 || i == n) {
    return i == 0 ? -infinity : infinity;
  }
  return std::numbers::sqrt2 * boost::math::erf_inv(2.0 * i / n - 1.0);
}

/// Mean deviation of slice i of n from the mean of a distribution.
double slice_deviation(const std::string& distribution, double spread, int i, int n) {
  if (distribution == "uniform") {
    return std::numbers::sqrt3 * spread * (2.0 * i + 1.0 - n) / n;
  }
  const double low = quantile(i, n), high = quantile(i + 1, n);
  if (distribution == "normal") {
    return spread * n * (normal_density(low) - normal_density(high));
  }
  const double s = std::sqrt(std::log1p(spread * spread));
  return n * (normal_distribution(s - low) - normal_distribution(s - high)) - 1.0;
}

} // namespace

const std::vector<std::string>& size_distributions() {
  static const std::vector<std::string> names = {"normal", "lognormal", "uniform"};
  return names;
}

std::vector<double> size_classes(const std::string& distribution, double spread, int n) {
  const std::vector<std::string>& known = size_distributions();
  if (std::find(known.begin(), known.end(), distribution) == known.end()) {
    throw std::invalid_argument(fmt::format("there is no distribution \"{}\"", distribution));
  }
  if (n < 2) {
    throw std::invalid_argument(fmt::format("{} classes; allowed: 2 and more", n));
  }
  std::vector<double> deviations;
  for (int i = 0; i < n; ++i) {
    deviations.push_back(slice_deviation(distribution, spread, i, n));
  }
  const double mean = std::accumulate(deviations.begin(), deviations.end(), 0.0) / n; // rounding alone
  double square = 0.0;
  for (double& deviation : deviations) {
    deviation -= mean;
    square += deviation * deviation;
  }
  const double stretch = spread / std::sqrt(square / n);
  std::vector<double> diameters;
  for (const double deviation : deviations) {
    diameters.push_back(1.0 + stretch * deviation);
  }
  constexpr double smallest = 0.05;
  if (!(diameters.front() >= smallest)) {
    throw std::invalid_argument(fmt::format("the smallest of {} classes has {:.3g} times the mean diameter; allowed: "
                                            "{} and more",
                                            n, diameters.front(), smallest));
  }
  return diameters;
}

std::vector<double> shares_by_number(const std::vector<double>& shares_of_volume,
                                     const std::vector<double>& diameters) {
  std::vector<double> shares;
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    shares.push_back(shares_of_volume[i] / std::pow(diameters[i], 3.0));
  }
  return shares;
}

std::vector<std::int64_t> dealt_out(std::int64_t count, const std::vector<double>& shares) {
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  std::vector<std::int64_t> counts;
  std::vector<double> remainders;
  for (const double share : shares) {
    const double exact = static_cast<double>(count) * (share / sum);
    counts.push_back(static_cast<std::int64_t>(std::floor(exact)));
    remainders.push_back(exact - std::floor(exact));
  }
  std::vector<std::size_t> order(shares.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return remainders[a] > remainders[b]; });
  const std::int64_t left = count - std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  for (std::int64_t i = 0; i < left; ++i) {
    ++counts[order[static_cast<std::size_t>(i) % order.size()]];
  }
  return counts;
}

} // namespace boba

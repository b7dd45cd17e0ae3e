// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/blocking.h"

#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace boba::measure {

namespace {

double error_of_mean(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double square = 0.0;
  for (const double value : values) {
    square += (value - mean) * (value - mean);
  }
  return std::sqrt(square / n / (n - 1.0));
}

std::vector<double> pair_means(const std::vector<double>& values) {
  std::vector<double> means(values.size() / 2);
  for (std::size_t i = 0; i < means.size(); ++i) {
    means[i] = 0.5 * (values[2 * i] + values[2 * i + 1]);
  }
  return means;
}

} // namespace

BlockedMean blocked_mean(std::span<const double> values) {
  if (values.size() < 2) {
    throw std::invalid_argument(fmt::format("blocking: {} values; at least 2 are needed", values.size()));
  }
  for (const double value : values) {
    if (!std::isfinite(value)) {
      throw std::invalid_argument(fmt::format("blocking: a value is {}; all must be finite", value));
    }
  }
  std::vector<double> blocks(values.begin(), values.end());
  BlockedMean result;
  result.n_values = static_cast<std::int64_t>(values.size());
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  result.naive_error = result.standard_error = error_of_mean(blocks);
  const double n = static_cast<double>(values.size());
  for (std::int64_t size = 2; blocks.size() / 2 >= 8; size *= 2) {
    blocks = pair_means(blocks);
    const double error = error_of_mean(blocks);
    const double inflation = result.naive_error > 0.0 ? error / result.naive_error : 1.0;
    if (std::pow(static_cast<double>(size), 3) > 2.0 * n * std::pow(inflation, 4)) {
      result.standard_error = error;
      result.block_size = size;
      result.reached_plateau = true;
      break;
    }
    if (error > result.standard_error) {
      result.standard_error = error;
      result.block_size = size;
    }
  }
  return result;
}

BlockedMean blocked_mean_in_window(std::span<const double> abscissae, std::span<const double> values, double first,
                                   double last) {
  if (abscissae.size() != values.size()) {
    throw std::invalid_argument(fmt::format("blocking: {} abscissae but {} values", abscissae.size(), values.size()));
  }
  std::vector<double> inside;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (abscissae[i] > first && abscissae[i] < last) {
      inside.push_back(values[i]);
    }
  }
  if (inside.size() < 2) {
    throw std::invalid_argument(
        fmt::format("blocking: {} values between {} and {}; at least 2 are needed", inside.size(), first, last));
  }
  return blocked_mean(inside);
}

} // namespace boba::measure

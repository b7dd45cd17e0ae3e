// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/poisson_table.h"

#include "base/program.h"
#include "bpm/io/input_error.h"
#include "bpm/toml/toml_node.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

/// Slopes at the points: zero at a turn, else the weighted harmonic mean of the chords; one-sided three-point formula
/// at the ends, limited so that the first and last piece stay monotone.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> h(n - 1), chord(n - 1), slope(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = x[i + 1] - x[i];
    chord[i] = (y[i + 1] - y[i]) / h[i];
  }
  if (n == 2) {
    return {chord[0], chord[0]};
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = 2.0 * h[i] + h[i - 1], right = h[i] + 2.0 * h[i - 1];
    slope[i] = chord[i - 1] * chord[i] <= 0.0 ? 0.0 : (left + right) / (left / chord[i - 1] + right / chord[i]);
  }
  const auto end_slope = [](double h0, double h1, double c0, double c1) {
    const double s = ((2.0 * h0 + h1) * c0 - h0 * c1) / (h0 + h1);
    if (s * c0 <= 0.0) {
      return 0.0;
    }
    return std::abs(s) > 3.0 * std::abs(c0) ? 3.0 * c0 : s;
  };
  slope[0] = end_slope(h[0], h[1], chord[0], chord[1]);
  slope[n - 1] = end_slope(h[n - 2], h[n - 3], chord[n - 2], chord[n - 3]);
  return slope;
}

double number_of(const TomlNode& entry, const std::string& key) {
  const TomlNode* value = entry.find(key);
  if (value != nullptr && value->kind == TomlNode::Kind::integer) {
    return static_cast<double>(value->integer);
  }
  if (value == nullptr || value->kind != TomlNode::Kind::real || !std::isfinite(value->real)) {
    throw InputError(fmt::format("{}: {} must be a number", value == nullptr ? entry.place : value->place, key));
  }
  return value->real;
}

} // namespace

MonotoneCurve::MonotoneCurve(std::vector<double> x, std::vector<double> y, const std::string& name)
    : x_(std::move(x)), y_(std::move(y)) {
  if (x_.size() < 2 || x_.size() != y_.size()) {
    throw std::invalid_argument(fmt::format("{}: {} points; at least 2 are needed", name, x_.size()));
  }
  for (std::size_t i = 1; i < x_.size(); ++i) {
    if (!(x_[i] > x_[i - 1]) || !((y_[i] - y_[i - 1]) * (y_[1] - y_[0]) > 0.0)) {
      throw std::invalid_argument(fmt::format(
          "{}: the point at {} breaks the order; arguments must increase and values be monotone", name, x_[i]));
    }
  }
  slope_ = monotone_slopes(x_, y_);
}

double MonotoneCurve::operator()(double x) const {
  if (!(x >= lowest() && x <= highest())) {
    throw std::out_of_range(fmt::format("{} lies outside [{}, {}]", x, lowest(), highest()));
  }
  const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  const std::size_t i = static_cast<std::size_t>(above - x_.begin()) - 1;
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h;
  // Hermite's cubic between the two points.
  return (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t) * y_[i] + t * (1.0 - t) * (1.0 - t) * h * slope_[i] +
         t * t * (3.0 - 2.0 * t) * y_[i + 1] - t * t * (1.0 - t) * h * slope_[i + 1];
}

double MonotoneCurve::inverse(double y) const {
  const auto [low, high] = std::minmax(y_.front(), y_.back());
  if (!(y >= low && y <= high)) {
    throw std::out_of_range(fmt::format("{} lies outside [{}, {}]", y, low, high));
  }
  const bool rising = y_.back() > y_.front();
  double a = lowest(), b = highest();
  for (int i = 0; i < 200 && a < b; ++i) {
    const double middle = 0.5 * (a + b);
    if (middle == a || middle == b) {
      break;
    }
    const bool below = (*this)(middle) < y;
    (below == rising ? a : b) = middle;
  }
  return std::abs((*this)(a)-y) <= std::abs((*this)(b)-y) ? a : b;
}

PoissonTable::PoissonTable(const std::filesystem::path& file) : file_(file) {
  const TomlNode root = parse_toml(read_text_file(file), file.string());
  const TomlNode* entries = root.find("entry");
  if (entries == nullptr || entries->kind != TomlNode::Kind::array) {
    throw InputError(fmt::format("{}: no [[entry]] tables with alpha, young and poisson", file.string()));
  }
  if (const TomlNode* source = root.find("source"); source != nullptr) {
    source_ = source->text;
  }
  if (root.find("stability_limit") != nullptr) {
    stability_limit_ = number_of(root, "stability_limit");
  }
  std::vector<double> alpha, young, poisson;
  for (const TomlNode& entry : entries->items) {
    alpha.push_back(number_of(entry, "alpha"));
    young.push_back(number_of(entry, "young"));
    poisson.push_back(number_of(entry, "poisson"));
  }
  try {
    young_ = MonotoneCurve(alpha, young, "young against alpha");
    poisson_ = MonotoneCurve(alpha, poisson, "poisson against alpha");
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

PoissonTable PoissonTable::installed() {
  return PoissonTable(data_folder() / "poisson_table.toml");
}

double PoissonTable::alpha_of_poisson(double poisson, double k) const {
  try {
    return k * poisson_.inverse(poisson);
  } catch (const std::out_of_range&) {
    const double a = poisson_(poisson_.lowest()), b = poisson_(poisson_.highest());
    throw InputError(
        fmt::format("the installed table ({}) reaches from {:g} to {:g} and is not extrapolated; give alpha "
                    "instead",
                    file_.string(), std::min(a, b), std::max(a, b)));
  }
}

std::optional<double> PoissonTable::stability_limit(double k) const {
  return stability_limit_ ? std::optional(k * *stability_limit_) : std::nullopt;
}

double PoissonTable::checked(double alpha, double k) const {
  const double scaled = alpha / k;
  if (!(scaled >= poisson_.lowest() && scaled <= poisson_.highest())) {
    throw InputError(fmt::format("alpha = {:g} lies outside the installed table ({}: {:g} to {:g}), which is not "
                                 "extrapolated",
                                 alpha, file_.string(), k * poisson_.lowest(), k * poisson_.highest()));
  }
  return scaled;
}

double PoissonTable::poisson(double alpha, double k) const {
  return poisson_(checked(alpha, k));
}

double PoissonTable::young(double alpha, double k) const {
  return k * young_(checked(alpha, k));
}

std::optional<double> PoissonTable::effective_modulus(double alpha, double k) const {
  const double scaled = alpha / k;
  if (!(scaled >= poisson_.lowest() && scaled <= poisson_.highest())) {
    return std::nullopt;
  }
  const double nu = poisson_(scaled);
  return k * young_(scaled) / (2.0 - 2.0 * nu * nu);
}

} // namespace boba

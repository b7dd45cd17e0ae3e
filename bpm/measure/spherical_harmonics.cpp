// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/spherical_harmonics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace boba::measure {

namespace {

double factorial(int n) {
  return std::tgamma(n + 1.0);
}

/// The 3j symbols of one degree, [m1 + l][m2 + l]; computed once.
template <int l> const std::vector<double>& table_3j() {
  static const std::vector<double> table = [] {
    std::vector<double> values;
    for (int m1 = -l; m1 <= l; ++m1) {
      for (int m2 = -l; m2 <= l; ++m2) {
        values.push_back(std::abs(m1 + m2) <= l ? wigner_3j(l, m1, m2) : 0.0);
      }
    }
    return values;
  }();
  return table;
}

} // namespace

double wigner_3j(int l, int m1, int m2) {
  // Racah's formula for three equal angular momenta. Source: Messiah, Quantum Mechanics II, appendix C.
  const int m3 = -m1 - m2;
  if (std::abs(m1) > l || std::abs(m2) > l || std::abs(m3) > l) {
    return 0.0;
  }
  double scale = factorial(l) * factorial(l) * factorial(l) / factorial(3 * l + 1);
  for (const int m : {m1, m2, m3}) {
    scale *= factorial(l + m) * factorial(l - m);
  }
  double sum = 0.0;
  for (int t = std::max({0, -m1, m2}); t <= std::min({l, l - m1, l + m2}); ++t) {
    const double denominator = factorial(t) * factorial(t + m1) * factorial(t - m2) * factorial(l - t) *
                               factorial(l - t - m1) * factorial(l - t + m2);
    sum += (t % 2 == 0 ? 1.0 : -1.0) / denominator;
  }
  return (m3 % 2 == 0 ? 1.0 : -1.0) * std::sqrt(scale) * sum;
}

template <int l> Harmonics<l> spherical_harmonics(const Vector3& direction) {
  const double theta = std::acos(std::clamp(direction[2] / direction.norm(), -1.0, 1.0));
  const double phi = std::atan2(direction[1], direction[0]);
  Harmonics<l> y;
  for (int m = 0; m <= l; ++m) {
    // std::sph_legendre holds the norm and the Condon-Shortley phase.
    y[l + m] = std::polar(1.0, m * phi) * std::sph_legendre(l, m, theta);
    y[l - m] = (m % 2 == 0 ? 1.0 : -1.0) * std::conj(y[l + m]);
  }
  return y;
}

template <int l> double second_invariant(const Harmonics<l>& q) {
  double sum = 0.0;
  for (const auto& component : q) {
    sum += std::norm(component);
  }
  return std::sqrt(4.0 * std::numbers::pi / (2 * l + 1) * sum);
}

template <int l> double third_invariant(const Harmonics<l>& q) {
  const std::vector<double>& table = table_3j<l>();
  std::complex<double> sum = 0.0;
  double norm = 0.0;
  for (int m1 = -l; m1 <= l; ++m1) {
    norm += std::norm(q[l + m1]);
    for (int m2 = std::max(-l, -l - m1); m2 <= std::min(l, l - m1); ++m2) {
      sum += table[(m1 + l) * (2 * l + 1) + m2 + l] * q[l + m1] * q[l + m2] * q[l - m1 - m2];
    }
  }
  return norm > 0.0 ? sum.real() / std::pow(norm, 1.5) : 0.0;
}

template Harmonics<4> spherical_harmonics<4>(const Vector3&);
template Harmonics<6> spherical_harmonics<6>(const Vector3&);
template double second_invariant<4>(const Harmonics<4>&);
template double second_invariant<6>(const Harmonics<6>&);
template double third_invariant<4>(const Harmonics<4>&);
template double third_invariant<6>(const Harmonics<6>&);

} // namespace boba::measure

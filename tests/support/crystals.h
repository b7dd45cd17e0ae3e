// SPDX-License-Identifier: GPL-3.0-or-later
// Perfect crystals with nearest-neighbour distance 1 in periodic cells.
#pragma once

#include "bpm/packing/box.h"

#include <cmath>
#include <random>
#include <vector>

namespace boba::crystals {

struct Crystal {
  Box box;
  std::vector<Vector3> centres;
};

/// Repeats an orthogonal cell with a basis in fractional coordinates.
inline Crystal repeat(const Vector3& cell, const std::vector<Vector3>& basis, int n1, int n2, int n3) {
  Crystal crystal{Box(Vector3(0.3, -1.0, 2.0), cell.cwiseProduct(Vector3(n1, n2, n3))), {}};
  for (int i = 0; i < n1 * n2 * n3; ++i) {
    for (const Vector3& s : basis) {
      const Vector3 at = s + Eigen::Vector3i(i % n1, i / n1 % n2, i / (n1 * n2)).cast<double>();
      crystal.centres.push_back(crystal.box.origin() + at.cwiseProduct(cell) + Vector3::Constant(1e-3));
    }
  }
  return crystal;
}

inline Crystal fcc(int n) {
  return repeat(Vector3::Constant(std::sqrt(2.0)), {{0, 0, 0}, {0, .5, .5}, {.5, 0, .5}, {.5, .5, 0}}, n, n, n);
}

inline Crystal bcc(int n) {
  return repeat(Vector3::Constant(2.0 / std::sqrt(3.0)), {{0, 0, 0}, {.5, .5, .5}}, n, n, n);
}

inline Crystal hcp(int n) {
  return repeat({1.0, std::sqrt(3.0), std::sqrt(8.0 / 3.0)},
                {{0, 0, 0}, {.5, .5, 0}, {.5, 5. / 6., .5}, {0, 1. / 3., .5}}, n, n, n);
}

/// fcc in its primitive, tilted cell: a = (1,0,0), b = (1/2, sqrt(3)/2, 0), c = (1/2, sqrt(3)/6, sqrt(2/3)), n copies.
inline Crystal tilted_fcc(int n) {
  const Matrix3 h =
      (Matrix3() << 1.0, 0.5, 0.5, 0.0, std::sqrt(3.0) / 2.0, std::sqrt(3.0) / 6.0, 0.0, 0.0, std::sqrt(2.0 / 3.0))
          .finished();
  Crystal crystal{Box(Vector3::Zero(), n * h.diagonal(), {n * h(0, 1), n * h(0, 2), n * h(1, 2)}), {}};
  for (int i = 0; i < n * n * n; ++i) {
    crystal.centres.emplace_back(h * Eigen::Vector3i(i % n, i / n % n, i / (n * n)).cast<double>());
  }
  return crystal;
}

inline std::vector<Vector3> icosahedron() {
  const double golden = (1.0 + std::sqrt(5.0)) / 2.0;
  std::vector<Vector3> corners;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double one : {-1.0, 1.0}) {
      for (const double tall : {-golden, golden}) {
        Vector3 x = Vector3::Zero();
        x[axis] = one;
        x[(axis + 1) % 3] = tall;
        corners.push_back(x);
      }
    }
  }
  return corners;
}

/// Every centre moved by normal random numbers of this standard deviation.
inline Crystal shaken(Crystal crystal, double sigma, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> move(0.0, sigma);
  for (Vector3& x : crystal.centres) {
    x += Vector3(move(generator), move(generator), move(generator));
  }
  return crystal;
}

/// Independent random centres at number density `density`.
inline Crystal gas(int n, double density, unsigned seed) {
  const double edge = std::cbrt(n / density);
  Crystal crystal{Box(Vector3::Zero(), Vector3::Constant(edge)), {}};
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> coordinate(0.0, edge);
  for (int i = 0; i < n; ++i) {
    crystal.centres.emplace_back(coordinate(generator), coordinate(generator), coordinate(generator));
  }
  return crystal;
}

} // namespace boba::crystals

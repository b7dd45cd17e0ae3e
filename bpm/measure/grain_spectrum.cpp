// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/grain_spectrum.h"

#include "base/bounds.h"
#include "bpm/measure/lane_products.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace boba::measure {

namespace {

constexpr int width = 12;             ///< grid points a node is spread over, in each direction
constexpr double beta = 2.30 * width; ///< best for a grid twice as fine as the wave numbers need

/// exp(beta (sqrt(1 - (2 x / width)^2) - 1)), 0 beyond width / 2.
double kernel(double x) {
  const double t = 2.0 * x / width;
  return t * t < 1.0 ? std::exp(beta * (std::sqrt(1.0 - t * t) - 1.0)) : 0.0;
}

/// phi^(n) = integral of kernel(x) cos(2 pi n x / M) dx.
double kernel_transform(int n, int grid) {
  // x = width/2 sin(t) makes the integrand smooth and periodic: the trapezoidal rule then converges exponentially.
  constexpr int n_points = 200;
  double sum = 0.0;
  for (int k = -n_points; k <= n_points; ++k) {
    const double t = 0.5 * std::numbers::pi * k / n_points;
    const double x = 0.5 * width * std::sin(t);
    sum += std::exp(beta * (std::cos(t) - 1.0)) * std::cos(2.0 * std::numbers::pi * n * x / grid) * std::cos(t);
  }
  return sum * 0.5 * width * 0.5 * std::numbers::pi / n_points;
}

std::int64_t remainder(std::int64_t a, std::int64_t m) {
  const std::int64_t r = a % m;
  return r < 0 ? r + m : r;
}

int padded(int n) {
  return (n + 7) / 8 * 8;
}

} // namespace

SpectrumPlan::SpectrumPlan(const Box& box, const ReciprocalLattice& lattice)
    : box_(box), n_vectors_(static_cast<double>(lattice.n_vectors())),
      n_rows_(static_cast<double>(lattice.rows().size())) {
  for (const ReciprocalRow& row : lattice.rows()) {
    n_max_[0] = std::max(n_max_[0], std::abs(row.n1));
    n_max_[1] = std::max(n_max_[1], std::abs(row.n2));
    n_max_[2] = std::max({n_max_[2], std::abs(row.low), std::abs(row.high)});
  }
  for (int axis = 0; axis < 3; ++axis) {
    grid_[axis] = 2 * (2 * n_max_[axis] + 1);
    for (int k = 0; k < grid_[axis]; ++k) {
      turn_[axis].push_back(std::polar(1.0, 2.0 * std::numbers::pi * k / grid_[axis]));
    }
    for (int n = 0; n <= n_max_[axis]; ++n) {
      weight_[axis].push_back(1.0 / kernel_transform(n, grid_[axis]));
    }
  }
}

SpectrumPlan::Block SpectrumPlan::spread(std::span<const Vector3> nodes) const {
  std::vector<Vector3> at(nodes.size()); // in units of the grid
  Bounds bounds;
  const Vector3 s0 = box_.to_fractional(nodes.front()).array().floor(); // whole cells change nothing and cost digits
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    at[i] = (box_.to_fractional(nodes[i]) - s0).cwiseProduct(Vector3(grid_[0], grid_[1], grid_[2]));
    bounds.include(at[i]);
  }
  Block block;
  for (int axis = 0; axis < 3; ++axis) {
    block.first[axis] = static_cast<std::int64_t>(std::ceil(bounds.low[axis] - 0.5 * width));
    block.size[axis] =
        static_cast<int>(static_cast<std::int64_t>(std::ceil(bounds.high[axis] - 0.5 * width)) - block.first[axis]) +
        width;
  }
  block.size[2] = padded(block.size[2]);
  block.value.assign(static_cast<std::size_t>(block.size[0]) * block.size[1] * block.size[2], 0.0);
  for (const Vector3& u : at) {
    std::array<int, 3> corner{};
    double phi[3][width];
    for (int axis = 0; axis < 3; ++axis) {
      const double start = std::ceil(u[axis] - 0.5 * width);
      corner[axis] = static_cast<int>(static_cast<std::int64_t>(start) - block.first[axis]);
      for (int k = 0; k < width; ++k) {
        phi[axis][k] = kernel(u[axis] - start - k);
      }
    }
    for (int a = 0; a < width; ++a) {
      for (int b = 0; b < width; ++b) {
        const double ab = phi[0][a] * phi[1][b];
        double* out = block.value.data() +
                      (static_cast<std::size_t>(corner[0] + a) * block.size[1] + corner[1] + b) * block.size[2] +
                      corner[2];
        for (int c = 0; c < width; ++c) {
          out[c] += ab * phi[2][c];
        }
      }
    }
  }
  const int stride = padded(2 * n_max_[2] + 1);
  block.phase_re.assign(static_cast<std::size_t>(block.size[2]) * stride, 0.0);
  block.phase_im = block.phase_re;
  std::vector<double> re(block.size[2]), im(block.size[2]);
  for (int n = -n_max_[2]; n <= n_max_[2]; ++n) {
    phases(2, n, block.first[2], block.size[2], re.data(), im.data());
    for (int c = 0; c < block.size[2]; ++c) {
      block.phase_re[c * stride + n + n_max_[2]] = re[c];
      block.phase_im[c * stride + n + n_max_[2]] = im[c];
    }
  }
  return block;
}

void SpectrumPlan::phases(int axis, int n, std::int64_t first, int size, double* re, double* im) const {
  const std::int64_t m = grid_[axis];
  const double weight = weight_[axis][std::abs(n)];
  std::int64_t k = remainder(n * remainder(first, m), m);
  const std::int64_t step = remainder(n, m);
  for (int a = 0; a < size; ++a) {
    re[a] = weight * turn_[axis][k].real();
    im[a] = weight * turn_[axis][k].imag();
    k += step;
    k -= k >= m ? m : 0;
  }
}

void SpectrumPlan::transform(const Block& block, std::span<const ReciprocalRow> rows, std::span<double> re,
                             std::span<double> im) const {
  const auto [na, nb, nc] = block.size;
  const int plane = nb * nc;
  thread_local std::vector<double> scratch;
  const int stride3 = padded(2 * n_max_[2] + 1), longest = std::max(na, nb);
  scratch.resize(2 * (static_cast<std::size_t>(longest) + plane + nc));
  double* c_re = scratch.data();
  double* c_im = c_re + longest;
  double* plane_re = c_im + longest;
  double* plane_im = plane_re + plane;
  double* line_re = plane_im + plane;
  double* line_im = line_re + nc;
  phases(0, rows.front().n1, block.first[0], na, c_re, c_im);
  multiply_row(c_re, c_im, na, {block.value.data(), nullptr, plane}, plane, plane_re, plane_im);
  std::size_t v = 0;
  for (const ReciprocalRow& row : rows) {
    assert(row.n1 == rows.front().n1);
    phases(1, row.n2, block.first[1], nb, c_re, c_im);
    multiply_row(c_re, c_im, nb, {plane_re, plane_im, nc}, nc, line_re, line_im);
    const int first = row.low + n_max_[2];
    multiply_row(line_re, line_im, nc, {block.phase_re.data() + first, block.phase_im.data() + first, stride3},
                 row.size(), re.data() + v, im.data() + v);
    v += static_cast<std::size_t>(row.size());
  }
}

double SpectrumPlan::cost(std::size_t n_nodes, const std::array<int, 3>& size) const {
  const auto [na, nb, nc] = size;
  const double plane = static_cast<double>(nb) * nc, spread_products = width * width * width;
  return static_cast<double>(n_nodes) * spread_products / 4.0 + (n_max_[0] + 1.0) * na * plane / 2.0 + n_rows_ * plane +
         n_vectors_ * nc;
}

std::array<int, 3> SpectrumPlan::block_size(const Vector3& extent) const {
  std::array<int, 3> size{};
  for (int axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<int>(extent[axis] * grid_[axis]) + width + 1;
  }
  return size;
}

} // namespace boba::measure

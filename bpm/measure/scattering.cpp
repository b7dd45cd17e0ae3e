// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/scattering.h"

#include "bpm/measure/parallel_loop.h"
#include "bpm/measure/phase_sums.h"

#include <cmath>
#include <complex>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

namespace boba::measure {

namespace {

/// Consecutive rows with one n1 that are summed together, so that a node's sines and cosines serve many rows.
struct RowRange {
  std::size_t first = 0, last = 0;
};

std::vector<RowRange> row_ranges(const std::vector<ReciprocalRow>& rows) {
  constexpr std::size_t rows_together = 32;
  std::vector<RowRange> ranges;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (ranges.empty() || rows[r].n1 != rows[ranges.back().first].n1 || r - ranges.back().first >= rows_together) {
      ranges.push_back({r, r});
    }
    ranges.back().last = r + 1;
  }
  return ranges;
}

void sum_range(const Box& box, const GrainNodes& grains, std::span<const ReciprocalRow> rows,
               ScatteringAmplitudes& amplitudes) {
  const std::int64_t first = rows.front().first;
  const std::int64_t n_vectors = rows.back().first + rows.back().size() - first;
  std::vector<std::complex<double>> total(n_vectors), of_grain(n_vectors);
  std::vector<double> form_factor(n_vectors, 0.0);
  PhaseSums phases;
  for (int grain = 0; grain < grains.n_grains(); ++grain) {
    const auto nodes = grains.nodes_of(grain);
    phases.start(box, nodes, rows.front());
    for (const ReciprocalRow& row : rows) {
      phases.sum_row(row, std::span(of_grain).subspan(row.first - first, row.size()));
    }
    for (std::int64_t v = 0; v < n_vectors; ++v) {
      total[v] += of_grain[v];
      form_factor[v] += std::norm(of_grain[v]) / static_cast<double>(nodes.size());
    }
  }
  for (std::int64_t v = 0; v < n_vectors; ++v) {
    amplitudes.intensity[first + v] = std::norm(total[v]) / static_cast<double>(grains.n_nodes());
    amplitudes.form_factor[first + v] = form_factor[v] / grains.n_grains();
  }
}

} // namespace

ScatteringAmplitudes scattering_amplitudes(const Box& box, const GrainNodes& grains, const ReciprocalLattice& lattice) {
  ScatteringAmplitudes amplitudes;
  amplitudes.intensity.resize(lattice.n_vectors());
  amplitudes.form_factor.resize(lattice.n_vectors());
  const std::vector<RowRange> ranges = row_ranges(lattice.rows());
  parallel_loop(static_cast<std::int64_t>(ranges.size()), [&](std::int64_t i) {
    const RowRange& range = ranges[i];
    sum_range(box, grains, std::span(lattice.rows()).subspan(range.first, range.last - range.first), amplitudes);
  });
  return amplitudes;
}

std::vector<ScatteringShell> shell_average(const Box& box, const ReciprocalLattice& lattice,
                                           const ScatteringAmplitudes& amplitudes, double shell_width) {
  if (!(shell_width >= 0.0) || !std::isfinite(shell_width)) {
    throw std::invalid_argument(
        fmt::format("scattering: shell_width is {} / d; it must be positive, or 0 for 2 pi / V^(1/3)", shell_width));
  }
  const double width = shell_width > 0.0 ? shell_width : 2.0 * std::numbers::pi / std::cbrt(box.volume());
  std::map<std::int64_t, ScatteringShell> shells;
  for (const ReciprocalRow& row : lattice.rows()) {
    for (int n3 = row.low; n3 <= row.high; ++n3) {
      const double q = lattice.q(row.n1, row.n2, n3).norm();
      // Shells are centred on multiples of the width, so that no vector of a cubic box sits on their limits.
      ScatteringShell& shell = shells[std::llround(q / width)];
      const std::int64_t v = row.first + n3 - row.low;
      shell.q += q;
      shell.intensity += amplitudes.intensity[v];
      shell.form_factor += amplitudes.form_factor[v];
      ++shell.n_vectors;
    }
  }
  std::vector<ScatteringShell> averaged;
  for (auto& [number, shell] : shells) {
    const double n = static_cast<double>(shell.n_vectors);
    shell.q /= n;
    shell.intensity /= n;
    shell.form_factor /= n;
    shell.structure =
        shell.form_factor > 0.0 ? shell.intensity / shell.form_factor : std::numeric_limits<double>::quiet_NaN();
    shell.n_vectors *= 2; // the other half of the lattice
    averaged.push_back(shell);
  }
  return averaged;
}

std::vector<ScatteringShell> scattering(const Box& box, const GrainNodes& grains, const ScatteringOptions& options) {
  const ReciprocalLattice lattice(box, options.q_max);
  return shell_average(box, lattice, scattering_amplitudes(box, grains, lattice), options.shell_width);
}

double direct_intensity(std::span<const Vector3> nodes, const Vector3& q) {
  double re = 0.0, im = 0.0;
  for (const Vector3& x : nodes) {
    re += std::cos(q.dot(x));
    im += std::sin(q.dot(x));
  }
  return (re * re + im * im) / static_cast<double>(nodes.size());
}

double ball_form_factor(double q, double radius) {
  const double x = q * radius;
  if (std::abs(x) < 1e-2) {
    return 1.0 - x * x / 5.0 + 3.0 * x * x * x * x / 175.0; // series of the formula, which cancels for small x
  }
  const double amplitude = 3.0 * (std::sin(x) - x * std::cos(x)) / (x * x * x);
  return amplitude * amplitude;
}

} // namespace boba::measure

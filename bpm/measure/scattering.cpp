// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/scattering.h"

#include "base/bounds.h"
#include "bpm/measure/grain_spectrum.h"
#include "bpm/measure/parallel_loop.h"
#include "bpm/measure/phase_sums.h"

#include <algorithm>
#include <array>
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

/// Rows of one n1: they share the first direction's transform.
std::vector<RowRange> slabs(const std::vector<ReciprocalRow>& rows) {
  std::vector<RowRange> result;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (result.empty() || rows[r].n1 != rows[result.back().first].n1) {
      result.push_back({r, r});
    }
    result.back().last = r + 1;
  }
  return result;
}

/// Gives all ranks the values at the wave vectors of all ranges, each from the rank that has summed there.
void share_ranges(const DealtItems& items, const std::vector<ReciprocalRow>& rows, const std::vector<RowRange>& ranges,
                  std::vector<double>& values) {
  if (!items.ranks().is_distributed()) {
    return;
  }
  const auto begin = [&](std::size_t i) { return values.begin() + rows[ranges[i].first].first; };
  const auto end = [&](std::size_t i) {
    const ReciprocalRow& last = rows[ranges[i].last - 1];
    return values.begin() + last.first + last.size();
  };
  std::vector<std::vector<double>> lists(ranges.size());
  for (std::int64_t k = 0; k < items.n_own(); ++k) {
    lists[items.own(k)].assign(begin(items.own(k)), end(items.own(k)));
  }
  items.share(lists);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    std::copy(lists[i].begin(), lists[i].end(), begin(i));
  }
}

/// Sums over the grains so far, at every wave vector.
struct RunningSums {
  std::vector<double> re, im, form_factor;
  explicit RunningSums(std::size_t n) : re(n, 0.0), im(n, 0.0), form_factor(n, 0.0) {}
};

/// Adds some grains at the wave vectors of one slab.
void add_slab(const SpectrumPlan& plan, std::span<const SpectrumPlan::Block> blocks, std::span<const double> n_nodes,
              std::span<const ReciprocalRow> rows, RunningSums& sums) {
  const std::int64_t first = rows.front().first;
  const auto n = static_cast<std::size_t>(rows.back().first + rows.back().size() - first);
  thread_local std::vector<double> re, im;
  re.resize(n);
  im.resize(n);
  for (std::size_t g = 0; g < blocks.size(); ++g) {
    plan.transform(blocks[g], rows, re, im);
    for (std::size_t v = 0; v < n; ++v) {
      sums.re[first + v] += re[v];
      sums.im[first + v] += im[v];
      sums.form_factor[first + v] += (re[v] * re[v] + im[v] * im[v]) / n_nodes[g];
    }
  }
}

/// Gives all ranks the grids of all grains, each from the rank that has spread its nodes.
void share_blocks(const DealtItems& items, std::vector<SpectrumPlan::Block>& blocks) {
  using Block = SpectrumPlan::Block;
  items.share(blocks, &Block::first);
  items.share(blocks, &Block::size);
  items.share(blocks, &Block::value);
  items.share(blocks, &Block::phase_re);
  items.share(blocks, &Block::phase_im);
}

/// Products of the two ways for the whole packing, {transform, direct}.
std::array<double, 2> costs(const Box& box, const GrainNodes& grains, const ReciprocalLattice& lattice,
                            const Ranks& ranks) {
  const SpectrumPlan plan(box, lattice);
  const DealtItems items(ranks, grains.n_grains());
  std::vector<std::array<double, 2>> of_grain(grains.n_grains());
  parallel_loop(items, [&](std::int64_t g) {
    const auto nodes = grains.nodes_of(static_cast<int>(g));
    Bounds fractional;
    for (const Vector3& x : nodes) {
      fractional.include(box.to_fractional(x));
    }
    of_grain[g] = {nodes.empty() ? 0.0 : plan.cost(nodes.size(), plan.block_size(fractional.extent())),
                   static_cast<double>(nodes.size()) * static_cast<double>(lattice.n_vectors())};
  });
  items.share(of_grain);
  std::array<double, 2> total{};
  for (const auto& [transform, direct] : of_grain) {
    total[0] += transform;
    total[1] += direct;
  }
  return total;
}

} // namespace

ScatteringAmplitudes transformed_amplitudes(const Box& box, const GrainNodes& grains, const ReciprocalLattice& lattice,
                                            const Ranks& ranks) {
  const int grains_together = std::clamp(ranks.size(), 32, 128); // whose grids are held at once
  const SpectrumPlan plan(box, lattice);
  const std::vector<RowRange> ranges = slabs(lattice.rows());
  const auto n_vectors = static_cast<std::size_t>(lattice.n_vectors());
  const DealtItems slab_items(ranks, static_cast<std::int64_t>(ranges.size()));
  RunningSums sums(n_vectors);
  for (int begin = 0; begin < grains.n_grains(); begin += grains_together) {
    const int n = std::min(grains_together, grains.n_grains() - begin);
    std::vector<SpectrumPlan::Block> blocks(n);
    std::vector<double> n_nodes(n);
    for (int g = 0; g < n; ++g) {
      n_nodes[g] = static_cast<double>(grains.nodes_of(begin + g).size());
    }
    const DealtItems items(ranks, n);
    parallel_loop(items,
                  [&](std::int64_t g) { blocks[g] = plan.spread(grains.nodes_of(begin + static_cast<int>(g))); });
    share_blocks(items, blocks);
    parallel_loop(slab_items, [&](std::int64_t i) {
      const RowRange& range = ranges[i];
      add_slab(plan, blocks, n_nodes, std::span(lattice.rows()).subspan(range.first, range.last - range.first), sums);
    });
  }
  ScatteringAmplitudes amplitudes;
  amplitudes.intensity.resize(n_vectors);
  amplitudes.form_factor = std::move(sums.form_factor);
  for (std::size_t v = 0; v < n_vectors; ++v) {
    amplitudes.intensity[v] =
        (sums.re[v] * sums.re[v] + sums.im[v] * sums.im[v]) / static_cast<double>(grains.n_nodes());
    amplitudes.form_factor[v] /= grains.n_grains();
  }
  share_ranges(slab_items, lattice.rows(), ranges, amplitudes.intensity);
  share_ranges(slab_items, lattice.rows(), ranges, amplitudes.form_factor);
  return amplitudes;
}

ScatteringAmplitudes scattering_amplitudes(const Box& box, const GrainNodes& grains, const ReciprocalLattice& lattice,
                                           const Ranks& ranks) {
  const auto [transformed, summed] = costs(box, grains, lattice, ranks);
  return transformed < summed ? transformed_amplitudes(box, grains, lattice, ranks)
                              : summed_amplitudes(box, grains, lattice, ranks);
}

ScatteringAmplitudes summed_amplitudes(const Box& box, const GrainNodes& grains, const ReciprocalLattice& lattice,
                                       const Ranks& ranks) {
  ScatteringAmplitudes amplitudes;
  amplitudes.intensity.resize(lattice.n_vectors());
  amplitudes.form_factor.resize(lattice.n_vectors());
  const std::vector<RowRange> ranges = row_ranges(lattice.rows());
  const DealtItems items(ranks, static_cast<std::int64_t>(ranges.size()));
  parallel_loop(items, [&](std::int64_t i) {
    const RowRange& range = ranges[i];
    sum_range(box, grains, std::span(lattice.rows()).subspan(range.first, range.last - range.first), amplitudes);
  });
  share_ranges(items, lattice.rows(), ranges, amplitudes.intensity);
  share_ranges(items, lattice.rows(), ranges, amplitudes.form_factor);
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

std::vector<ScatteringShell> scattering(const Box& box, const GrainNodes& grains, const ScatteringOptions& options,
                                        const Ranks& ranks) {
  const ReciprocalLattice lattice(box, options.q_max);
  return shell_average(box, lattice, scattering_amplitudes(box, grains, lattice, ranks), options.shell_width);
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

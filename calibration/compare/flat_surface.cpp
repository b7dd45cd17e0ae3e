// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/compare/flat_surface.h"

#include "calibration/specimen/nonlinear_network.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::calibration {

namespace {

constexpr double step = 0.15;              // d, of the gap between two relaxed states
constexpr double bulk_step = 0.01;         // of the uncut box's stretch
constexpr double smallest_share = 0.02;    // of the largest pressure; below, single nodes carry the load
constexpr double surface_tolerance = 1e-6; // k d, root mean square residual; pressures to 1e-5
constexpr double softest_start =
    0.2; // c1 over p/g at the largest overlap: a layer without a slope at rest has no tangent

/// The box without the bonds that cross its faces across z, far from its images there.
GrainTemplate slab_of(const GrainTemplate& box) {
  GrainTemplate slab = box;
  std::erase_if(slab.bonds, [&](const Bond& bond) {
    return std::abs(box.position[bond.i].z() - box.position[bond.j].z()) > 0.5 * box.period->z();
  });
  slab.period->z() += 10.0;
  return slab;
}

double stiffness_of(const GrainTemplate& network) {
  double sum = 0.0;
  for (const Bond& bond : network.bonds) {
    sum += bond.r0 * bond.r0;
  }
  return sum;
}

/// Stretch along z of the uncut box at the pressures of the states, by interpolation between its own states.
void add_bulk_stretch(const GrainTemplate& box, double alpha, std::vector<SlabState>& states) {
  NonlinearNetwork network(box, alpha);
  double before = 0.0, pressure = 0.0, stretch = 1.0; // pressures at the last two stretches
  for (SlabState& state : states) {
    while (pressure < state.pressure) {
      before = pressure;
      stretch -= bulk_step;
      network.deform_cell(Vector3(1.0, 1.0, stretch).asDiagonal());
      network.relax(surface_tolerance);
      pressure = -network.stress()(2, 2);
    }
    state.bulk_stretch = stretch + bulk_step * (pressure - state.pressure) / (pressure - before);
  }
}

} // namespace

std::vector<SlabState> press_slab(const GrainTemplate& box, double alpha, double largest_pressure) {
  if (!box.period) {
    throw std::invalid_argument("a slab is cut from a periodic box");
  }
  const GrainTemplate slab = slab_of(box);
  NonlinearNetwork network(slab, alpha);
  network.hold_steady({true, true, false, false, false, false});
  const double area = box.period->x() * box.period->y();
  const double body = box.period->z() * stiffness_of(slab) / stiffness_of(box);
  std::vector<SlabState> states;
  std::vector<Vector3> before = network.position();
  double gap = box.period->z() + 1.0;
  do {
    gap -= step;
    network.set_walls(-0.5 * gap, 0.5 * gap);
    // On as it went: half of Newton's steps are saved.
    std::vector<Vector3> ahead = network.position();
    for (std::size_t n = 0; n < ahead.size(); ++n) {
      ahead[n] += ahead[n] - before[n];
    }
    before = network.position();
    network.set_positions(std::move(ahead));
    network.relax(surface_tolerance);
    const auto load = network.wall_loads();
    states.push_back({0.5 * (load[0] + load[1]) / area, gap, 1.0, body});
    if (states.back().pressure < largest_pressure && gap < 0.5 * box.period->z()) {
      throw std::runtime_error(
          fmt::format("a slab of {:.3g} d does not carry {} k/d", box.period->z(), largest_pressure));
    }
  } while (states.back().pressure < largest_pressure);
  add_bulk_stretch(box, alpha, states);
  return states;
}

FlatSurface fit_surface(const std::vector<SlabState>& states) {
  FlatSurface best{.residual = INFINITY};
  for (const SlabState& state : states) {
    best.largest_pressure = std::max(best.largest_pressure, state.pressure);
  }
  // For each place of the surface p(g) is linear in c1 and c3; the place by a scan, finer about the best.
  const auto attempt = [&](double beyond) {
    double aa = 0, ab = 0, bb = 0, ap = 0, bp = 0;
    double largest_squared = 0.0;
    std::vector<std::array<double, 2>> points;
    for (const SlabState& state : states) {
      const double g = beyond - state.beyond_body(), p = state.pressure;
      if (p < smallest_share * best.largest_pressure) {
        continue;
      }
      points.push_back({g, p});
      largest_squared = std::max(largest_squared, g * g);
      aa += g * g, ab += std::pow(g, 4), bb += std::pow(g, 6), ap += g * p, bp += g * g * g * p;
    }
    const double determinant = aa * bb - ab * ab;
    FlatSurface fit{.beyond = beyond, .residual = INFINITY, .largest_pressure = best.largest_pressure};
    fit.c1 = (ap * bb - bp * ab) / determinant;
    fit.c3 = (bp * aa - ap * ab) / determinant;
    if (fit.c3 < 0.0) {
      fit.c3 = 0.0;
      fit.c1 = ap / aa;
    } else if (fit.c1 < softest_start * (fit.c1 + fit.c3 * largest_squared)) {
      return fit;
    }
    double sum = 0.0;
    for (const auto& [g, p] : points) { // in the overlap: the misfit of p over the slope there
      const double slope = fit.c1 + 3.0 * fit.c3 * g * g;
      sum += std::pow((p - fit.c1 * g - fit.c3 * g * g * g) / slope, 2);
    }
    fit.residual = std::sqrt(sum / static_cast<double>(points.size()));
    return fit;
  };
  double centre = 0.6;
  for (const double width : {0.6, 0.06, 0.006}) {
    for (int n = -20; n <= 20; ++n) {
      const FlatSurface fit = attempt(centre + width * n / 20.0);
      if (fit.c1 > 0.0 && fit.residual < best.residual) {
        best = fit;
      }
    }
    centre = best.beyond;
  }
  if (!std::isfinite(best.residual)) {
    throw std::runtime_error("no layer with a positive stiffness fits the slab's surface");
  }
  return best;
}

} // namespace boba::calibration

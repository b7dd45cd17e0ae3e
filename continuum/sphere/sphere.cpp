// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/sphere/sphere.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

namespace boba::continuum {
namespace {

using Clock = std::chrono::steady_clock;

/// A mesh serves contact radii within this factor: beyond it a second factorisation costs less than the elements.
constexpr double widest_range = 2.5;

struct Range {
  double lowest, highest;
  bool holds(double value) const { return value >= lowest && value <= highest; }
};

/// A body meshed for a range of contact radii.
struct Stage {
  Range edges;
  std::shared_ptr<MeridianBody> body;
  std::unique_ptr<PlatePress> linear;
  std::unique_ptr<FinitePress> finite;
  /// Height of the plate of the last load.
  double plate;

  const ContactSurface& surface() const { return finite ? finite->surface() : linear->surface(); }
  PressState press(double height, const SphereProblem& problem) {
    if (!finite) {
      return linear->press(height, problem.interface, problem.max_active_sets);
    }
    const double from = plate;
    PressState state = finite->press(from, height, problem.interface);
    plate = height;
    return state;
  }
};

class Run {
public:
  explicit Run(const SphereProblem& problem) : problem_(problem) {}

  std::vector<SphereLoad> loads() {
    std::vector<SphereLoad> result;
    for (std::size_t i = 0; i < problem_.approaches.size(); ++i) {
      result.push_back(load(i));
    }
    return result;
  }

private:
  /// Contact radius to expect: Hertz's, corrected by what the last load had.
  double expected_edge(double approach) const {
    const double radius = problem_.radius;
    return std::min(ratio_ * hertz(radius, problem_.material, approach / 2).contact_radius, 0.85 * radius);
  }

  /// Contact radii of this load and of those after it that are near enough to share a mesh.
  Range range_from(std::size_t first) const {
    const double edge = expected_edge(problem_.approaches[first]);
    Range range{edge, edge};
    for (std::size_t i = first + 1; i < problem_.approaches.size(); ++i) {
      const double next = expected_edge(problem_.approaches[i]);
      const Range wider{std::min(range.lowest, next), std::max(range.highest, next)};
      if (wider.highest > widest_range * wider.lowest) {
        break;
      }
      range = wider;
    }
    return {0.93 * range.lowest, std::min(1.07 * range.highest, 0.9 * problem_.radius)};
  }

  void prepare(const Range& edges) {
    SphereMeshSize size;
    size.lowest_edge = edges.lowest;
    size.highest_edge = edges.highest;
    size.elements_across = problem_.elements_across;
    size.elements_inside = std::max(8., problem_.elements_across / 3);
    Stage stage;
    stage.edges = edges;
    stage.body = std::make_shared<MeridianBody>(sphere_mesh(problem_.radius, size), problem_.discretisation);
    stage.plate = problem_.radius;
    const double limit = std::min(1.3 * edges.highest, 0.97 * problem_.radius);
    if (problem_.finite_law) {
      stage.finite = std::make_unique<FinitePress>(*stage.body, *problem_.finite_law, plate_side, limit);
    } else {
      stage.linear = std::make_unique<PlatePress>(*stage.body, problem_.material, plate_side, limit);
    }
    stage_ = std::move(stage);
  }

  SphereLoad load(std::size_t i) {
    const auto start = Clock::now();
    const double approach = problem_.approaches[i];
    if (!stage_ || !stage_->edges.holds(expected_edge(approach))) {
      prepare(range_from(i));
    }
    SphereLoad result = solved(approach);
    // A surprise (auxetic or deep contact): mesh again around the edge that was found.
    for (int repeat = 0; repeat < 4 && !stage_->edges.holds(result.reference_contact_radius); ++repeat) {
      remember(result);
      const double edge = result.reference_contact_radius;
      prepare({0.93 * std::min(edge, 0.9 * problem_.radius), std::min(1.07 * edge, 0.9 * problem_.radius)});
      result = solved(approach);
    }
    remember(result);
    result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return result;
  }

  void remember(const SphereLoad& load) { ratio_ = load.reference_contact_radius / load.hertz.contact_radius; }

  SphereLoad solved(double approach) {
    SphereLoad load;
    const PressState state = stage_->press(problem_.radius - approach / 2, problem_);
    const ContactSurface& surface = stage_->surface();
    load.approach = approach;
    load.hertz = hertz(problem_.radius, problem_.material, approach / 2);
    load.force = state.force;
    const double edge = contact_edge(surface.r(), state, problem_.interface);
    load.reference_contact_radius = edge;
    load.central_pressure = central_pressure(surface.r(), state, edge);
    load.peak_pressure = std::max(load.central_pressure, off_axis_peak(surface.r(), state, edge));
    load.active_set_iterations = state.active_set_iterations;
    load.newton_iterations = state.newton_iterations;
    load.n_unknowns = stage_->body->n_unknowns();
    load.n_contact_unknowns = int(state.pressure.size());
    load.r = surface.r();
    load.pressure = state.pressure;
    load.overlap = state.overlap;
    load.body = stage_->body;
    load.displacement = state.displacement;
    load.profile = stage_->body->boundary_points(plate_side, state.displacement);
    load.equatorial_bulge = load.profile.front().u_r;
    load.contact_radius = edge;
    if (problem_.finite_law) {
      load.contact_radius += radial_displacement_at(load.profile, edge);
      load.ellipticity =
          check_ellipticity(*stage_->body, *problem_.finite_law, state.displacement) / problem_.material.shear();
    }
    return load;
  }

  /// u_r of the upper surface at radius r, linear between vertices (which run from equator to pole).
  static double radial_displacement_at(const std::vector<FieldPoint>& profile, double r) {
    for (std::size_t i = profile.size() - 1; i > 0; --i) {
      const FieldPoint& inner = profile[i];
      const FieldPoint& outer = profile[i - 1];
      if (outer.r >= r) {
        return inner.u_r + (outer.u_r - inner.u_r) * (r - inner.r) / (outer.r - inner.r);
      }
    }
    return profile.front().u_r;
  }

  /// Largest nodal pressure away from the axis, where the smoothed central value does not speak.
  static double off_axis_peak(const Eigen::VectorXd& r, const PressState& state, double edge) {
    double peak = 0;
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      if (r[i] > 0.4 * edge) {
        peak = std::max(peak, state.pressure[i]);
      }
    }
    return peak;
  }

  const SphereProblem& problem_;
  double ratio_ = 1;
  std::optional<Stage> stage_;
};

} // namespace

void check(const SphereProblem& problem) {
  check(static_cast<const CompressedBody&>(problem));
  if (problem.approaches.empty()) {
    throw std::invalid_argument("approach = (none) is not allowed: give at least one in (0, 2 radius)");
  }
  for (const double approach : problem.approaches) {
    if (!(approach > 0 && approach < 2 * problem.radius)) {
      throw std::invalid_argument(fmt::format(
          "approach = {} is not allowed: it must lie in (0, {}), or the plates cross", approach, 2 * problem.radius));
    }
  }
  if (!(problem.elements_across >= 8) || problem.elements_across > 4096) {
    throw std::invalid_argument(
        fmt::format("elements-across = {} is not allowed: it must lie in [8, 4096] elements across the contact radius",
                    problem.elements_across));
  }
  if (problem.max_active_sets < 1) {
    throw std::invalid_argument(
        fmt::format("active-sets = {} is not allowed: it must be at least 1", problem.max_active_sets));
  }
}

std::vector<SphereLoad> solve(const SphereProblem& problem) {
  check(problem);
  return Run(problem).loads();
}

} // namespace boba::continuum

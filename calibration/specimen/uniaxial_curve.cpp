// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/specimen/uniaxial_curve.h"

#include "calibration/specimen/nonlinear_network.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

namespace boba::calibration {

namespace {

constexpr double largest_step = 0.05;         // of axial strain between two relaxed states
constexpr double lateral_stress_limit = 1e-6; // k/d

/// A box under uniaxial strain whose lateral stretch is adjusted until the lateral stress vanishes.
class UniaxialBox {
public:
  UniaxialBox(const GrainTemplate& box, double alpha) : network_(box, alpha) {}

  UniaxialPoint go_to(double axial_stretch) {
    const double from = point_.axial_stretch;
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(axial_stretch - from) / largest_step - 1e-9)));
    for (int s = 1; s <= steps; ++s) {
      settle(from + (axial_stretch - from) * s / steps);
    }
    return point_;
  }

private:
  /// Nominal lateral stress at a cell; the network is relaxed there.
  double lateral_stress(double axial, double lateral) {
    network_.deform_cell(Vector3(axial, lateral, lateral).asDiagonal());
    network_.relax();
    const Matrix3 cauchy = network_.stress();
    point_ = {axial, lateral, cauchy(0, 0) * lateral * lateral, 0.5 * (cauchy(1, 1) + cauchy(2, 2)) * axial * lateral,
              network_.n_contacts()};
    return point_.lateral_stress;
  }

  /// Secant method in the lateral stretch.
  void settle(double axial) {
    double a = point_.lateral_stretch - slope_ * (axial - point_.axial_stretch);
    double stress_a = lateral_stress(axial, a);
    double b = a - stress_a / lateral_modulus_;
    for (int iteration = 0; std::abs(stress_a) > lateral_stress_limit; ++iteration) {
      if (iteration == 20) {
        throw std::runtime_error(
            fmt::format("lateral stress {:.3e} k/d does not vanish at axial stretch {}", stress_a, axial));
      }
      const double stress_b = lateral_stress(axial, b);
      if (std::abs(b - a) > 1e-12 && (stress_b - stress_a) / (b - a) > 0.0) {
        lateral_modulus_ = (stress_b - stress_a) / (b - a);
      }
      a = b;
      stress_a = stress_b;
      b = a - stress_a / lateral_modulus_;
    }
    if (previous_ && std::abs(axial - previous_->axial_stretch) > 1e-9) {
      slope_ = -(a - previous_->lateral_stretch) / (axial - previous_->axial_stretch);
    }
    previous_ = point_;
  }

  NonlinearNetwork network_;
  UniaxialPoint point_;
  std::optional<UniaxialPoint> previous_;
  double slope_ = 0.0;           // -d lateral / d axial stretch
  double lateral_modulus_ = 2.5; // k/d; corrected by the secants
};

} // namespace

std::vector<UniaxialPoint> uniaxial_curve(const GrainTemplate& box, double alpha, const std::vector<double>& strains) {
  std::vector<std::size_t> order(strains.size());
  for (std::size_t n = 0; n < order.size(); ++n) {
    order[n] = n;
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::abs(strains[a]) < std::abs(strains[b]); });
  std::vector<UniaxialPoint> points(strains.size());
  for (const bool tension : {false, true}) {
    UniaxialBox specimen(box, alpha);
    for (const std::size_t n : order) {
      if ((strains[n] > 0.0) == tension) {
        points[n] = specimen.go_to(1.0 + strains[n]);
      }
    }
  }
  return points;
}

} // namespace boba::calibration

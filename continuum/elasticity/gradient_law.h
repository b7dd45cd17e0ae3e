// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/material.h"

#include <Eigen/Core>
#include <memory>

namespace boba::continuum {

/// The displacement gradient of an axisymmetric body without torsion: (rr, rz, zr, zz, hoop), where rz is d u_r / d z
/// and hoop is u_r / r.
using Gradient = Eigen::Matrix<double, 5, 1>;
using GradientTangent = Eigen::Matrix<double, 5, 5>;

/// First Piola-Kirchhoff stress, ordered as Gradient, and its derivative.
struct GradientResponse {
  Gradient stress;
  GradientTangent tangent;
};

/// A material law seen from the displacement gradient: linear elasticity and hyperelastic laws alike.
class GradientLaw {
public:
  GradientLaw() = default;
  GradientLaw(const GradientLaw&) = delete;
  GradientLaw& operator=(const GradientLaw&) = delete;
  virtual ~GradientLaw() = default;
  /// Stress and tangent (unit of E) at a displacement gradient (dimensionless).
  virtual GradientResponse at(const Gradient& gradient) const = 0;
};

/// Small strain: sigma = 2 mu eps + lambda tr(eps) 1.
class LinearLaw : public GradientLaw {
public:
  LinearLaw(double shear, double lame);
  GradientResponse at(const Gradient& gradient) const override;

private:
  GradientTangent tangent_;
};

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/contact/interface_law.h"
#include "continuum/elasticity/hyperelastic.h"
#include "continuum/elasticity/meridian_body.h"

#include <memory>
#include <vector>

namespace boba::continuum {

/// What every compression has: a body of revolution, its material, and what lies between it and the plates.
/// Lengths and stresses in any consistent unit.
struct CompressedBody {
  double radius = 1;
  Material material;
  InterfaceLaw interface;
  /// Law of finite kinematics; null: small strain.
  std::shared_ptr<const HyperelasticLaw> finite_law;
  Discretisation discretisation;
};

/// Throws std::invalid_argument (name, value, range) for a body that cannot exist.
void check(const CompressedBody& body);

/// What every solved load has.
struct CompressionLoad {
  /// Axial force, compression positive.
  double force = 0;
  int newton_iterations = 0;
  /// Finite kinematics: lowest eigenvalue of the acoustic tensor over mu; 1 at rest or less.
  double ellipticity = 0;
  double seconds = 0;
  /// The free side or the surface, from mid-height upward.
  std::vector<FieldPoint> profile;
  Eigen::VectorXd displacement;
};

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/contact/interface_law.h"
#include "continuum/cylinder/cylinder_mesh.h"
#include "continuum/elasticity/hyperelastic.h"

namespace boba::continuum {

enum class Ends {
  /// The end faces slide without friction under rigid plates: uniaxial stress.
  sliding,
  /// The end faces are held rigidly, as the end slabs of a particle specimen are.
  bonded
};

/// One compressed cylinder. Lengths and stresses in any consistent unit.
struct CylinderProblem {
  double radius = 1;
  /// Height between the held ends.
  double height = 2;
  Material material;
  Ends ends = Ends::bonded;
  /// Nominal compressive strains: shortening over height; negative ones stretch.
  std::vector<double> strains = {0.01};
  /// Layer between sliding ends and plates.
  InterfaceLaw interface;
  /// Law of finite kinematics; null: small strain.
  std::shared_ptr<const HyperelasticLaw> finite_law;
  Discretisation discretisation;
  CylinderMeshSize mesh;
};

struct CylinderLoad {
  double strain = 0;
  /// Axial force, compression positive.
  double force = 0;
  /// Force / (pi R^2 strain).
  double apparent_modulus = 0;
  /// Radial strain of the side at mid-height over the nominal axial strain.
  double midheight_poisson = 0;
  /// The same over the axial strain of the side at mid-height.
  double midheight_poisson_local = 0;
  int newton_iterations = 0;
  /// Finite kinematics: lowest eigenvalue of the acoustic tensor over mu; 1 at rest or less.
  double ellipticity = 0;
  double seconds = 0;
  /// The side, from mid-height to the end.
  std::vector<FieldPoint> profile;
  Eigen::VectorXd displacement;
};

struct CylinderResult {
  std::vector<CylinderLoad> loads;
  /// Kept for field output.
  std::shared_ptr<MeridianBody> body;
  double setup_seconds = 0;
};

/// Axial strain of the side at mid-height, from the slope of u_z between the lowest vertices of its profile.
double local_axial_strain(const std::vector<FieldPoint>& side);

/// Throws std::invalid_argument (name, value, range) for a problem that cannot be posed.
void check(const CylinderProblem& problem);

/// Solves all loads; linear problems factorise once. Throws what check() throws, NotSettled for a failed iteration.
CylinderResult solve(const CylinderProblem& problem);

} // namespace boba::continuum

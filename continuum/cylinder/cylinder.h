// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/contact/compressed_body.h"
#include "continuum/cylinder/cylinder_mesh.h"

namespace boba::continuum {

enum class Ends {
  /// The end faces slide without friction under rigid plates: uniaxial stress.
  sliding,
  /// The end faces are held rigidly, as the end slabs of a particle specimen are.
  bonded
};

/// One compressed cylinder.
struct CylinderProblem : CompressedBody {
  /// Height between the held ends.
  double height = 2;
  Ends ends = Ends::bonded;
  /// Nominal compressive strains: shortening over height; negative ones stretch.
  std::vector<double> strains = {0.01};
  CylinderMeshSize mesh;
};

struct CylinderLoad : CompressionLoad {
  double strain = 0;
  /// Force / (pi R^2 strain).
  double apparent_modulus = 0;
  /// Radial strain of the side at mid-height over the nominal axial strain.
  double midheight_poisson = 0;
  /// The same over the axial strain of the side at mid-height.
  double midheight_poisson_local = 0;
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

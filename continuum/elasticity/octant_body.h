// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/meridian_body.h"

#include <functional>
#include <memory>

namespace boba::continuum {

/// Boundary ids of an octant mesh: the planes x = 0, y = 0, z = 0 (mirrors), the pressed boundary and the free side.
enum OctantBoundary : unsigned { mirror_x = 0, mirror_y = 1, mirror_z = 2, octant_plate_side = 3, octant_lateral = 4 };

/// MPI and PETSc for the life of this object; nothing that runs in three dimensions may outlive it.
class MpiSession {
public:
  MpiSession();
  ~MpiSession();
  /// Number of this rank, from 0, and how many there are.
  int rank() const;
  int size() const;

private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

/// A solved octant; forces are those of the whole circumference (four octants).
struct OctantSolution {
  double force = 0;
  /// Pressure of the node on the axis; contact radius of a disc as large as the pressed nodes' area. 0 if not pressed.
  double central_pressure = 0;
  double contact_radius = 0;
  /// Radial displacement of the side or the equator at mid-height.
  double midheight_radial = 0;
  /// Conjugate-gradient iterations of the last linear system, and how often the active set changed.
  int iterations = 0;
  int active_set_iterations = 0;
  long n_unknowns = 0;
  double assemble_seconds = 0, precondition_seconds = 0, solve_seconds = 0;
};

/// Which octant: quarter of a cylinder's upper half, or of a sphere's.
struct OctantShape {
  /// height: of the whole cylinder; 0 for a sphere.
  double radius = 1, height = 0;
  /// Elements of size `wanted(x, y, z)` or smaller after the even refinements.
  unsigned refinements = 2;
  std::function<double(double, double, double)> wanted = nullptr;
};

/// Small-strain elasticity on an octant in three dimensions: p4est mesh, PETSc conjugate gradients, hypre BoomerAMG.
///
/// Runs on all ranks of MPI_COMM_WORLD, which must be initialised (with PETSc) by the caller.
/// The displacement form is used: for nu > 0.45 take the axisymmetric solver.
class OctantBody {
public:
  /// Throws std::invalid_argument for a degree other than 1 and 2.
  OctantBody(const OctantShape& shape, unsigned degree);
  ~OctantBody();

  /// The end moved by -shortening / 2; bonded: u_x = u_y = 0 there.
  OctantSolution solve_held(const Material& material, double shortening, bool bonded);
  /// A rigid frictionless plate at height `plate`; first_radius: first guess of the contact.
  /// Throws NotSettled when the active set does not settle.
  OctantSolution press(const Material& material, double plate, double first_radius);
  /// Writes the displacement of the last solution as folder/fields_0000*.vtu and a .pvtu.
  void write(const std::string& folder) const;

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace boba::continuum

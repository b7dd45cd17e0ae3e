// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/direct_solver.h"
#include "continuum/elasticity/gradient_law.h"
#include "continuum/elasticity/material.h"

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

namespace dealii {
template <int, int> class Triangulation;
}

namespace boba::continuum {

/// Boundary ids of every meridian mesh.
enum Boundary : unsigned { axis = 0, mid_plane = 1, plate_side = 2, lateral = 3 };

/// A mesh of the quarter meridian r >= 0, z >= 0.
struct MeridianMesh {
  std::shared_ptr<dealii::Triangulation<2, 2>> triangulation;
  /// Polynomial degree of the geometry; 1 where the boundary is straight.
  unsigned mapping_degree = 1;
};

/// How the volume change enters the stiffness.
enum class Formulation {
  /// projected for nu > 0.45, displacement otherwise.
  automatic,
  displacement,
  /// The divergence is projected, cell by cell, on discontinuous polynomials one degree lower. This is the stable
  /// mixed pair Q_k / P_(k-1) with its pressure eliminated: no volumetric locking as nu -> 1/2.
  projected
};

struct Discretisation {
  /// Polynomial degree of the displacement, 1 to 4.
  unsigned degree = 2;
  Formulation formulation = Formulation::automatic;
};

/// One value of a field at one point of the meridian.
struct FieldPoint {
  double r, z;
  double u_r, u_z;
};

/// Cauchy stress at one integration point, with the current weight 2 pi r dr dz of the point.
struct StressPoint {
  double r, z;
  double rr, zz, hoop, rz;
  double weight;
};

/// Displacement gradient at one integration point.
struct GradientPoint {
  double r, z;
  Gradient gradient;
};

/// Finite elements for an axisymmetric body with a mirror plane z = 0: u_r = 0 on the axis, u_z = 0 on the mid plane.
///
/// Forces and stiffness are those of the whole circumference (integrals carry 2 pi r), of the half z >= 0.
/// Vectors of displacement hold one entry per degree of freedom, hanging nodes included.
class MeridianBody {
public:
  /// held: the boundary whose displacement is prescribed and the components held there (r, z); none by default.
  struct Held {
    Boundary boundary = plate_side;
    bool radial = false;
    bool axial = false;
  };

  /// Throws std::invalid_argument for a degree outside 1 to 4.
  MeridianBody(MeridianMesh mesh, Discretisation discretisation, Held held);
  explicit MeridianBody(MeridianMesh mesh, Discretisation discretisation = {});
  ~MeridianBody();
  MeridianBody(MeridianBody&&) noexcept;

  int n_unknowns() const;
  int n_cells() const;

  /// Tangent stiffness of the law at displacement u, on the free unknowns (constrained rows carry a positive diagonal).
  SparseMatrix stiffness(const GradientLaw& law, const Eigen::VectorXd& u) const;
  /// The same for linear elasticity in the formulation that suits the material.
  SparseMatrix stiffness(const Material& material) const;
  /// Internal nodal forces of the law at u, before constraints: on held nodes it is the reaction.
  Eigen::VectorXd internal_force(const GradientLaw& law, const Eigen::VectorXd& u) const;
  /// The same for linear elasticity.
  Eigen::VectorXd internal_force(const Material& material, const Eigen::VectorXd& u) const;

  /// Moves the forces on hanging nodes to their masters and drops those on held ones, in place of the constrained rows.
  Eigen::VectorXd condensed(const Eigen::VectorXd& force) const;
  /// Fills hanging nodes from their masters and zeroes the held ones.
  Eigen::VectorXd distributed(const Eigen::VectorXd& u) const;
  /// The displacement that equals value(r, z) = {u_r, u_z} on the held boundary and 0 elsewhere.
  Eigen::VectorXd lifted(const std::function<Eigen::Vector2d(double, double)>& value) const;
  /// Nodal interpolation of a displacement field.
  Eigen::VectorXd interpolated(const std::function<Eigen::Vector2d(double, double)>& value) const;
  /// Nodal forces of a body force (force per volume; r and z components).
  Eigen::VectorXd body_force(const std::function<Eigen::Vector2d(double, double)>& force) const;

  /// Axial force on a boundary: the work of the nodal forces (internal_force) in its unit displacement along z.
  double axial_force_on(Boundary boundary, const Eigen::VectorXd& force) const;
  /// Vertices of a boundary, sorted by z, then r.
  std::vector<FieldPoint> boundary_points(Boundary boundary, const Eigen::VectorXd& u) const;
  /// Cauchy stress at the integration points of lower order (superconvergent points of the displacement element).
  std::vector<StressPoint> stress(const GradientLaw& law, const Eigen::VectorXd& u) const;
  /// The same for linear elasticity (small strain).
  std::vector<StressPoint> stress(const Material& material, const Eigen::VectorXd& u) const;
  /// Displacement gradient at the integration points.
  std::vector<GradientPoint> gradients(const Eigen::VectorXd& u) const;
  /// L2 norm of the error of u and of its gradient (hoop strain included), weighted with 2 pi r.
  Eigen::Vector2d error(const Eigen::VectorXd& u, const std::function<Eigen::Vector2d(double, double)>& value,
                        const std::function<Gradient(double, double)>& gradient) const;

  /// deal.II objects, for the few files that read the mesh (meridian_parts.h).
  struct Parts;
  const Parts& parts() const { return *parts_; }

private:
  std::unique_ptr<Parts> parts_;
};

} // namespace boba::continuum

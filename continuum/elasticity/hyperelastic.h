// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/gradient_law.h"

#include <stdexcept>
#include <vector>

namespace boba::continuum {

/// Derivatives of the energy density W by the principal stretches: w_i = dW/dl_i and w_ij.
struct StretchResponse {
  Eigen::Vector3d first;
  Eigen::Matrix3d second;
};

/// First Piola-Kirchhoff stress dW/dF, its derivative and W at a deformation gradient; component iJ of F is row 3 i +
/// J.
struct SolidResponse {
  Eigen::Matrix3d stress;
  Eigen::Matrix<double, 9, 9> tangent;
  double energy;
};

/// A point of the body has turned inside out: no stress exists. Newton's method answers with a shorter step.
class Inverted : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// An isotropic hyperelastic law, total Lagrangian: W of the principal stretches.
///
/// With the singular values F = U diag(l) V^T the Piola stress is U diag(w) V^T; its derivative is w_ij on the
/// diagonal and, for each pair, (w_i - w_j)/(l_i - l_j) for symmetric and (w_i + w_j)/(l_i + l_j) for skew changes.
/// Source: R. W. Ogden, Non-linear Elastic Deformations, Ellis Horwood 1984, section 6.1.4.
class HyperelasticLaw : public GradientLaw {
public:
  /// Throws std::invalid_argument when a stretch is not positive.
  virtual StretchResponse response(const Eigen::Vector3d& stretches) const = 0;
  /// W, energy per reference volume (unit of E); 0 at rest.
  virtual double energy(const Eigen::Vector3d& stretches) const = 0;

  /// Throws Inverted where det F <= 0.
  GradientResponse at(const Gradient& gradient) const override;
  /// The same in three dimensions, F the deformation gradient. Throws Inverted where det F <= 0.
  SolidResponse solid(const Eigen::Matrix3d& deformation) const;

  /// Lowest eigenvalue of the acoustic tensor Q_ik = C_iJkL N_J N_L over directions N: the law is elliptic while it is
  /// positive. Unit of E.
  double lowest_acoustic(const Gradient& gradient) const;
};

/// W = mu/2 (l1^2 + l2^2 + l3^2 - 3) - mu ln J + lambda/2 (ln J)^2; lambda < 0 for auxetic materials.
class NeoHookean : public HyperelasticLaw {
public:
  explicit NeoHookean(const Material& material) : shear_(material.shear()), lame_(material.lame()) {}
  StretchResponse response(const Eigen::Vector3d& stretches) const override;
  double energy(const Eigen::Vector3d& stretches) const override;

private:
  double shear_, lame_;
};

/// One term of a foam: mu (stress), exponent alpha (not 0), Poisson's ratio nu of the term, beta = nu / (1 - 2 nu).
struct FoamTerm {
  double shear, exponent, poisson;
};

/// W = sum 2 mu / alpha^2 [ l1^alpha + l2^alpha + l3^alpha - 3 + (J^(-alpha beta) - 1) / beta ].
///
/// One term keeps the logarithmic Poisson ratio at nu for every strain while alpha sets how the modulus changes with
/// strain; a second term lets nu change too. Source: B. Storakers, J. Mech. Phys. Solids 34 (1986) 125.
class Foam : public HyperelasticLaw {
public:
  /// Throws std::invalid_argument for an exponent 0, a nu outside (-1, 0.5) or a sum of mu that is not positive.
  explicit Foam(std::vector<FoamTerm> terms);
  StretchResponse response(const Eigen::Vector3d& stretches) const override;
  double energy(const Eigen::Vector3d& stretches) const override;
  const std::vector<FoamTerm>& terms() const { return terms_; }

private:
  std::vector<FoamTerm> terms_;
};

/// One state of a uniaxial test: stretches along the axis and across, nominal stress (force per reference area).
struct UniaxialState {
  double axial_stretch, lateral_stretch, stress;
};

/// Stretch across and nominal stress of a law under uniaxial stress. Throws std::runtime_error when it finds none.
UniaxialState uniaxial(const HyperelasticLaw& law, double axial_stretch);

/// The terms (1 or 2) of the foam that fits a measured uniaxial test best: least squares in the axial stress and in the
/// lateral stress, which is to vanish, at the measured stretches, over E. material: moduli at small strain, the first
/// guess. Throws std::invalid_argument for fewer states than parameters.
std::vector<FoamTerm> fitted_foam(const std::vector<UniaxialState>& states, const Material& material, int n_terms);

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace boba::calibration {

using Stiffness = Eigen::Matrix<double, 6, 6>; ///< Voigt order xx yy zz yz xz xy, engineering shear strains; k/d

/// Isotropic elastic constants; moduli in k/d.
struct ElasticConstants {
  double bulk = 0.0;
  double shear = 0.0;
  double young() const { return 9.0 * bulk * shear / (3.0 * bulk + shear); }
  double poisson() const { return (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)); }
};

/// The isotropic tensor nearest to C (Frobenius norm): 9 K = C_iijj, 10 G = C_ijij - C_iijj / 3.
ElasticConstants isotropic_part(const Stiffness& c);

/// The stiffness of an isotropic solid, k/d.
Stiffness isotropic_stiffness(const ElasticConstants& constants);

/// |C - C_iso| / |C| in the Frobenius norm of the fourth-rank tensor; 0 for an isotropic solid.
double anisotropy(const Stiffness& c);

/// |C - C^T| / |C|: how far the stress-strain law is from having an energy.
double asymmetry(const Stiffness& c);

/// A mean over samples and its standard error (sample standard deviation over sqrt(n)); NaN for a single sample.
struct Estimate {
  double mean = 0.0;
  double error = 0.0;
};
Estimate estimate(const std::vector<double>& samples);

} // namespace boba::calibration

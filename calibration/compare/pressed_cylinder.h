// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "calibration/specimen/bulk_cut.h"

#include <Eigen/Core>
#include <vector>

namespace boba::calibration {

enum class CylinderEnds {
  bonded,  ///< the nodes of the end slabs move rigidly
  sliding, ///< the nodes of the end slabs follow the mean shortening along the axis and are free across
};

/// The continuum body that a cylinder of nodes stands for, fixed by its undeformed bonds.
///
/// Radius: the area by bonds (cylinder.h). Ends: a held end acts from behind the slab's face, at the mean depth of the
/// held ends of the bonds that cross the face, each weighted by e_z^2, its share in the axial force. Then a uniform
/// strain between the two planes gives every crossing bond on average the force it has in the bulk.
struct CylinderBody {
  double radius = 0.0; ///< d
  double height = 0.0; ///< d, between the planes at which the ends are held
};

struct CylinderState {
  double strain = 0.0;        ///< shortening over `height`
  double force = 0.0;         ///< k d, compression positive
  double poisson = 0.0;       ///< radial strain of the side at mid-height over `strain`
  double sway = 0.0;          ///< how far the end slabs have moved apart across the axis, d: buckling
  double seconds = 0.0;       ///< processor time
  std::vector<double> z, u_r; ///< d: the side's radial displacement against |z|, both halves together
  std::vector<Eigen::Vector3d> position;
  std::vector<Eigen::Matrix3d> virial;
};

/// Squeezes a cylinder cut from the bulk, to each strain in turn (rising).
class CylinderPress {
public:
  /// \throws std::invalid_argument when the slabs (thickness in d) leave nothing.
  CylinderPress(const GrainTemplate& cylinder, const BulkDensity& bulk, double slab = 2.0);

  const CylinderBody& body() const { return body_; }
  /// \throws std::runtime_error when a state cannot be relaxed.
  std::vector<CylinderState> squeeze(double alpha, CylinderEnds ends, const std::vector<double>& strains) const;

private:
  CylinderState measure(const std::vector<Eigen::Vector3d>& position, double strain) const;

  const GrainTemplate& cylinder_;
  double low_ = 0.0, high_ = 0.0; // faces of the slabs
  std::vector<int> lower_, upper_;
  CylinderBody body_;
};

} // namespace boba::calibration

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/material.h"
#include "bpm/packing/packing.h"

#include <vector>

namespace boba::test {

/// Forces on every node and the virial sum r_ij f_ij, by the plainest loops there are: every pair, every image, long
/// double. Bonds beyond Breaking::strain are left out, as they are once they have broken. The oracle of the lane
/// kernels and of the contact search; a few hundred nodes at most.
struct PlainForces {
  std::vector<Vector3> force;
  Matrix3 virial = Matrix3::Zero();
  int n_contacts = 0;
};

/// `n_images`: how many cell translations each way are looked at. `velocity_of_cell`: d/dt of the cell matrix that
/// images move with.
PlainForces plain_forces(const Packing& packing, const Material& material, int n_images = 2,
                         const Matrix3& velocity_of_cell = Matrix3::Zero());

} // namespace boba::test

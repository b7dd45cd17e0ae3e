// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/frame_rest.h"
#include "bpm/grain/build_template.h"
#include "bpm/measure/template_matching.h"
#include "tests/support/crystals.h"

#include <gtest/gtest.h>
#include <omp.h>
#include <stdexcept>

namespace boba {
namespace {

using measure::Lattice;

/// Spheres of one node in an fcc crystal that is compressed by a tenth, shaken and flying apart.
struct ShakenSpheres {
  Packing packing;
  Snapshot snapshot;
};

ShakenSpheres shaken_spheres() {
  crystals::Crystal crystal = crystals::fcc(3);
  for (Vector3& x : crystal.centres) {
    x = 0.9 * x;
  }
  crystal.box = Box(0.9 * crystal.box.origin(), 0.9 * crystal.box.lengths());
  crystal = crystals::shaken(crystal, 0.06, 3);
  const auto sphere = std::make_shared<const GrainTemplate>(build_template({.n_nodes = 1}));
  std::vector<Placement> placements;
  for (const Vector3& x : crystal.centres) {
    placements.push_back({Grain{}, x, Eigen::Quaterniond::Identity()});
  }
  ShakenSpheres spheres{make_packing(crystal.box, {sphere}, placements), {}};
  spheres.snapshot.box = crystal.box;
  spheres.snapshot.position = spheres.packing.position;
  for (std::size_t i = 0; i < spheres.packing.position.size(); ++i) {
    spheres.snapshot.velocity.emplace_back(i % 2 ? 1.0 : -1.0, 0.0, 0.0);
    spheres.packing.position[i].setConstant(1e3); // the snapshot's are taken
  }
  return spheres;
}

TEST(FrameRest, ShakenCrystalComesToItsLattice) {
  const ShakenSpheres spheres = shaken_spheres();
  const Snapshot before = spheres.snapshot;
  omp_set_num_threads(1); // one block of grains: a second thread would only wait
  const FrameRest rest(spheres.packing, Material{}, 0.1, 80.0);
  const std::vector<Vector3> centres = rest.rested_centres(spheres.snapshot);
  ASSERT_EQ(centres.size(), 108U);
  double moved = 0.0, rmsd_before = 0.0;
  for (const auto& match : measure::match_templates(before.box, before.position)) {
    rmsd_before += match.rmsd / 108.0;
  }
  for (const auto& match : measure::match_templates(before.box, centres)) {
    EXPECT_EQ(match.lattice, Lattice::fcc);
    EXPECT_LT(match.rmsd, 1e-3);
  }
  for (std::size_t i = 0; i < centres.size(); ++i) {
    moved = std::max(moved, (centres[i] - before.position[i]).norm());
  }
  EXPECT_GT(rmsd_before, 0.05);
  EXPECT_LT(moved, 0.5); // nobody changes place
  EXPECT_EQ(centres, rest.rested_centres(spheres.snapshot));
}

TEST(FrameRest, RefusesAFrameOfAnotherPacking) {
  const ShakenSpheres spheres = shaken_spheres();
  EXPECT_THROW(FrameRest(spheres.packing, Material{}, 0.05, 10.0).rested_centres(Snapshot{}), std::invalid_argument);
}

} // namespace
} // namespace boba

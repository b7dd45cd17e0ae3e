// SPDX-License-Identifier: GPL-3.0-or-later
// Surveys of bonds against closed forms of a grain that is blown up by a factor.
#include "bpm/forces/bond_forces.h"
#include "bpm/forces/bond_survey.h"
#include "bpm/grain/build_template.h"

#include <gtest/gtest.h>
#include <numeric>

namespace boba::test {
namespace {

/// A grain of 60 nodes, every length `factor` times as long.
struct Blown {
  explicit Blown(double factor) : grain(std::make_shared<const GrainTemplate>(build_template({.n_nodes = 60}))) {
    packing = make_packing(Box(Vector3::Zero(), Vector3::Constant(40.0)), {grain},
                           {{Grain{.alpha = 2.0}, Vector3::Constant(20.0)}});
    for (Vector3& x : packing.position) {
      x = Vector3::Constant(20.0) + factor * (x - Vector3::Constant(20.0));
    }
    layout.emplace(packing);
    state.emplace(packing, *layout);
    bonds.emplace(packing, *layout, Material{}, kernels::best_table());
  }
  BondSurvey survey() const {
    return {bonds->network_of_grain(), bond_law(Material{}), *layout, *state, Distribution::alone()};
  }

  std::shared_ptr<const GrainTemplate> grain;
  Packing packing;
  std::optional<LaneLayout> layout;
  std::optional<LaneState> state;
  std::optional<BondForces> bonds;
};

TEST(BondSurvey, EnergyOfADilationIsASumOfSquares) {
  const Blown blown(1.03);
  double energy = 0.0;
  for (const Bond& bond : blown.grain->bonds) {
    energy += 0.5 * 0.03 * 0.03 * bond.r0 * bond.r0;
  }
  EXPECT_NEAR(blown.survey().energy(blown.packing.box), energy, 1e-12 * energy);
}

TEST(BondSurvey, TheLargestStretchIsTheFactor) {
  EXPECT_NEAR(Blown(1.03).survey().largest_stretch(Blown(1.03).packing.box).ratio, 1.03, 1e-12);
}

TEST(BondSurvey, EveryBondHasTwoEnds) {
  const Blown blown(1.0);
  const std::vector<int> whole = blown.survey().whole_bonds(0);
  EXPECT_EQ(std::accumulate(whole.begin(), whole.end(), 0), 2 * static_cast<int>(blown.grain->bonds.size()));
  EXPECT_EQ(blown.survey().n_broken(), 0);
  for (const double damage : blown.survey().damage(0)) {
    EXPECT_EQ(damage, 0.0);
  }
}

} // namespace
} // namespace boba::test

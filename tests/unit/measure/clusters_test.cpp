// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/clusters.h"
#include "bpm/measure/long_range_order.h"
#include "tests/support/crystals.h"

#include <array>
#include <cmath>
#include <deque>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>

namespace {

using namespace boba;
using namespace boba::measure;
using crystals::Crystal;

/// Bonds between all centres nearer than `reach`, to their nearest copies and, in small cells, to others.
std::vector<GrainBond> bonds_within(const Crystal& crystal, double reach) {
  std::vector<GrainBond> bonds;
  const int n = static_cast<int>(crystal.centres.size());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const Vector3 nearest = crystal.box.minimum_image(crystal.centres[j] - crystal.centres[i]);
      for (int k = 0; k < 27; ++k) {
        const Vector3 v = nearest + crystal.box.h() * Vector3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        if (v.norm() < reach && v.norm() > 1e-9) {
          bonds.push_back({i, j, v});
        }
      }
    }
  }
  return bonds;
}

std::vector<Cluster> clusters_within(const Crystal& crystal, double reach) {
  return clusters(crystal.box, crystal.centres, std::vector<bool>(crystal.centres.size(), true),
                  bonds_within(crystal, reach));
}

TEST(Clusters, ChainThroughTheCellPercolatesAlongItAlone) {
  Crystal crystal{Box(Vector3::Zero(), {4.0, 9.0, 9.0}), {}};
  for (int k = 0; k < 4; ++k) {
    crystal.centres.emplace_back(k + 0.3, 4.0 * k * 9.0, 0.2); // far copies: centres are unwrapped
  }
  const auto found = clusters_within(crystal, 1.1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].grains, (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(found[0].percolates, (std::array{true, false, false}));
  EXPECT_EQ(found[0].dimension, 1);
  EXPECT_EQ(largest_finite(found), 0);

  crystal.centres.pop_back(); // the ring is open
  const auto open = clusters_within(crystal, 1.1);
  ASSERT_EQ(open.size(), 1U);
  EXPECT_EQ(open[0].dimension, 0);
  EXPECT_EQ(largest_finite(open), 3);
}

TEST(Clusters, ClusterAroundACornerOfTheCellIsFinite) {
  Crystal crystal{Box(Vector3::Zero(), Vector3::Constant(6.0)), {{3.0, 3.0, 3.0}}};
  for (int k = 0; k < 8; ++k) { // a cube of edge 1 around the origin, torn into the eight corners
    crystal.centres.push_back(crystal.box.wrapped({k & 1 ? -0.5 : 0.5, k & 2 ? -0.5 : 0.5, k & 4 ? -0.5 : 0.5}));
  }
  const auto found = clusters_within(crystal, 1.1);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].grains.size(), 8U);
  EXPECT_FALSE(found[0].spans());
  EXPECT_EQ(found[1].grains, std::vector{0});
}

TEST(Clusters, SheetsAndCrystalsHaveTheirDimension) {
  const Crystal sheet = crystals::repeat({1.0, 1.0, 5.0}, {{0, 0, 0}}, 4, 4, 1);
  const auto flat = clusters_within(sheet, 1.1);
  ASSERT_EQ(flat.size(), 1U);
  EXPECT_EQ(flat[0].percolates, (std::array{true, true, false}));
  EXPECT_EQ(flat[0].dimension, 2);
  EXPECT_EQ(clusters_within(crystals::fcc(3), 1.1)[0].dimension, 3);
}

TEST(Clusters, FlippedCellHasTheSameClusters) {
  // A chain along b of a cell that leans by 0.6 of its length, and the same lattice leaning the other way.
  for (const double tilt : {2.4, -1.6}) {
    Crystal crystal{Box(Vector3::Zero(), {4.0, 5.0, 9.0}, {tilt, 0.0, 0.0}), {}};
    for (int k = 0; k < 5; ++k) {
      crystal.centres.emplace_back(-1.6 * k / 5.0, k, 1.0); // from the origin to b = (-1.6, 5, 0)
    }
    const auto found = clusters_within(crystal, 1.2);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].percolates, (std::array{false, true, false})) << tilt;
  }
}

/// The periodic copies of `start` reached by walking over the bonds of the endless packing, up to 6 cells away.
std::set<std::array<int, 3>> copies_reached(const Crystal& crystal, const std::vector<GrainBond>& bonds, int start) {
  using State = std::array<int, 4>; // grain, cell
  std::map<int, std::vector<State>> steps;
  for (const GrainBond& bond : bonds) {
    const Vector3 s =
        crystal.box.h_inverse() * (bond.vector - (crystal.centres[bond.second] - crystal.centres[bond.first]));
    const std::array<int, 3> c = {static_cast<int>(std::lround(s[0])), static_cast<int>(std::lround(s[1])),
                                  static_cast<int>(std::lround(s[2]))};
    steps[bond.first].push_back({bond.second, c[0], c[1], c[2]});
    steps[bond.second].push_back({bond.first, -c[0], -c[1], -c[2]});
  }
  std::set<State> seen = {{start, 0, 0, 0}};
  std::deque<State> open(seen.begin(), seen.end());
  std::set<std::array<int, 3>> copies;
  while (!open.empty()) {
    const State at = open.front();
    open.pop_front();
    for (const State& step : steps[at[0]]) {
      const State next = {step[0], at[1] + step[1], at[2] + step[2], at[3] + step[3]};
      if (std::abs(next[1]) > 6 || std::abs(next[2]) > 6 || std::abs(next[3]) > 6 || !seen.insert(next).second) {
        continue;
      }
      open.push_back(next);
      if (next[0] == start) {
        copies.insert({next[1], next[2], next[3]});
      }
    }
  }
  return copies;
}

TEST(Clusters, RandomNetworksAreAsAWalkThroughTheEndlessPackingFindsThem) {
  std::set<int> dimensions;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Crystal crystal = crystals::gas(30, 1.0, seed);
    const double reach = 0.7 + 0.01 * seed;
    const auto bonds = bonds_within(crystal, reach);
    for (const Cluster& cluster : clusters_within(crystal, reach)) {
      std::array<bool, 3> percolates{};
      for (const auto& copy : copies_reached(crystal, bonds, cluster.grains.front())) {
        for (int axis = 0; axis < 3; ++axis) {
          percolates[axis] = percolates[axis] || copy[axis] != 0;
        }
      }
      EXPECT_EQ(cluster.percolates, percolates) << "seed " << seed;
      EXPECT_EQ(cluster.spans(), percolates != (std::array{false, false, false}));
      dimensions.insert(cluster.dimension);
    }
  }
  EXPECT_EQ(dimensions, (std::set{0, 1, 2, 3}));
}

TEST(Clusters, CrystalOfOrderedGrainsInADisorderedOne) {
  // A ball of fcc in a gas: one finite cluster, in one place.
  const Crystal whole = crystals::fcc(6);
  Crystal crystal = crystals::gas(864, std::sqrt(2.0), 3);
  crystal.box = whole.box;
  for (Vector3& x : crystal.centres) {
    x += whole.box.origin();
  }
  const Vector3 middle = whole.box.to_position(Vector3::Constant(0.02)); // the ball is torn by the cell's faces
  const auto inside = [&](const Vector3& x) { return whole.box.minimum_image(x - middle).norm() < 2.3; };
  std::erase_if(crystal.centres, inside);
  int n_ball = 0;
  for (const Vector3& x : whole.centres) {
    if (inside(x)) {
      crystal.centres.push_back(x);
      ++n_ball;
    }
  }
  const NeighbourLists neighbours = solid_angle_neighbours(crystal.box, crystal.centres);
  const auto found = solid_clusters(crystal.box, crystal.centres, neighbours, bond_order(neighbours));
  ASSERT_FALSE(found.empty());
  EXPECT_FALSE(found[0].spans());
  EXPECT_GT(found[0].grains.size(), 15U);
  EXPECT_LE(static_cast<int>(found[0].grains.size()), n_ball + 5);
  EXPECT_EQ(largest_finite(found), static_cast<int>(found[0].grains.size()));

  const NeighbourLists perfect = solid_angle_neighbours(whole.box, whole.centres);
  const auto one = solid_clusters(whole.box, whole.centres, perfect, bond_order(perfect));
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].grains.size(), 864U);
  EXPECT_EQ(one[0].dimension, 3);
}

TEST(Clusters, BadInputIsNamed) {
  const Crystal crystal = crystals::fcc(2);
  const std::vector<bool> all(crystal.centres.size(), true);
  EXPECT_THROW(clusters(crystal.box, crystal.centres, all, std::vector<GrainBond>{{0, 99, Vector3::Zero()}}),
               std::invalid_argument);
  EXPECT_TRUE(clusters(crystal.box, crystal.centres, std::vector<bool>(all.size(), false), {}).empty());
}

TEST(LongRangeOrder, PerfectCrystalsHavePeaksOfHeightOne) {
  const auto expect = [](const Crystal& crystal) {
    const BraggPeak peak = bragg_peak(crystal.box, crystal.centres);
    EXPECT_NEAR(peak.height, 1.0, 1e-9);
    std::complex<double> sum = 0.0;
    for (const Vector3& x : crystal.centres) {
      sum += std::polar(1.0, peak.q.dot(x));
    }
    EXPECT_NEAR(std::norm(sum) / std::pow(crystal.centres.size(), 2), 1.0, 1e-9);
  };
  for (const Crystal& crystal : {crystals::fcc(3), crystals::tilted_fcc(4), crystals::bcc(4), crystals::hcp(3),
                                 crystals::repeat(Vector3::Ones(), {{0, 0, 0}}, 5, 5, 5)}) {
    expect(crystal);
  }
}

TEST(LongRangeOrder, NoiseLowersThePeakByTheDebyeWallerFactorAndAGasHasNone) {
  constexpr double sigma = 0.05;
  const Crystal crystal = crystals::shaken(crystals::fcc(8), sigma, 2);
  const BraggPeak peak = bragg_peak(crystal.box, crystal.centres);
  EXPECT_NEAR(peak.height, std::exp(-peak.q.squaredNorm() * sigma * sigma), 0.02);
  const double n = 1000.0;
  EXPECT_LT(bragg_peak(crystals::gas(1000, 1.0, 3).box, crystals::gas(1000, 1.0, 3).centres).height,
            (std::log(6.0 * n) + 5.0) / n);
}

TEST(LongRangeOrder, PairDistributionCountsTheShellsOfFcc) {
  // Pairs at distances 1, sqrt 2, sqrt 3, 2: 12, 6, 24, 12 from each site, half of them when each pair counts once.
  const Crystal crystal = crystals::fcc(2); // smaller than the reach: copies count too
  std::map<double, std::int64_t> found;
  for (const PairShell& shell : pair_distribution(crystal.box, crystal.centres)) {
    if (shell.n_pairs > 0 && shell.r < 2.1) {
      found[shell.r] = shell.n_pairs;
    }
  }
  const std::vector<std::pair<double, int>> known = {{1.0, 12}, {std::sqrt(2.0), 6}, {std::sqrt(3.0), 24}, {2.0, 12}};
  ASSERT_EQ(found.size(), known.size());
  auto it = found.begin();
  for (const auto& [r, number] : known) {
    EXPECT_NEAR(it->first, r, 0.02);
    EXPECT_EQ(it->second, 32 * number / 2);
    ++it;
  }
}

TEST(LongRangeOrder, PairDistributionOfAGasIsOne) {
  const Crystal crystal = crystals::gas(2000, 1.0, 8);
  for (const PairShell& shell : pair_distribution(crystal.box, crystal.centres)) {
    if (shell.r > 0.3) {
      EXPECT_NEAR(shell.g, 1.0, 5.0 / std::sqrt(static_cast<double>(shell.n_pairs))) << shell.r;
    }
  }
}

TEST(LongRangeOrder, BadInputIsNamed) {
  const Box open(Vector3::Zero(), Vector3::Ones(), Vector3::Zero(), {true, true, false});
  EXPECT_THROW(bragg_peak(open, std::vector<Vector3>{{0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(pair_distribution(open, std::vector<Vector3>{{0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(bragg_peak(Box(Vector3::Zero(), Vector3::Ones()), {}), std::invalid_argument);
}

} // namespace

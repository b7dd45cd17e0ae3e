// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts of single nodes: the cell list against all pairs, the forces against plain loops in long double and, to the
// last bit, against the lists by pairs of grains.
#include "bpm/forces/contact_forces.h"
#include "bpm/forces/force_field.h"
#include "bpm/forces/point_contacts.h"
#include "bpm/grain/build_template.h"
#include "tests/support/plain_forces.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <tuple>

namespace boba::test {
namespace {

struct Case {
  const char* name;
  Box box;
  int n_nodes;
  double spread; ///< of positions, in cells: above 1 some lie in other images
};

const Vector3 origin(0.3, -1.0, 2.0);

const std::vector<Case> cases = {
    {"cube", Box(origin, {6.0, 6.0, 6.0}), 300, 1.0},
    {"tilted", Box(origin, {9.0, 7.0, 8.0}, {4.4, -3.5, 3.4}), 350, 1.0},
    {"far images", Box(origin, {7.0, 6.0, 8.0}, {3.0, 0.5, -2.0}), 250, 50.0},
    {"thinner than the reach", Box(origin, {1.1, 9.0, 9.0}), 60, 3.0},
    {"thin in two directions", Box(origin, {0.9, 0.8, 12.0}, {0.4, 0.3, -0.2}), 8, 2.0},
    {"one alone", Box(origin, {1.0, 0.9, 0.95}, {0.3, 0.2, 0.1}), 1, 1.0},
    {"two cells wide", Box(origin, {2.9, 2.5, 30.0}), 120, 1.0},
    {"open in z", Box(origin, {6.0, 6.0, 5.0}, Vector3::Zero(), {true, true, false}), 300, 3.0},
    {"open", Box(origin, {6.0, 6.0, 6.0}, Vector3::Zero(), {false, false, false}), 300, 1.5},
};

std::vector<Vector3> random_positions(const Case& c, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-0.5 * (c.spread - 1.0), 0.5 * (c.spread + 1.0));
  std::vector<Vector3> position;
  for (int i = 0; i < c.n_nodes; ++i) {
    position.push_back(c.box.origin() + c.box.h() * Vector3(uniform(random), uniform(random), uniform(random)));
  }
  return position;
}

Packing packing_of(const Case& c, unsigned seed) {
  const auto sphere = std::make_shared<const GrainTemplate>(build_template({.n_nodes = 1}));
  std::vector<Placement> placements;
  for (const Vector3& x : random_positions(c, seed)) {
    placements.push_back({Grain{.alpha = 0.0}, x});
  }
  Packing packing = make_packing(c.box, {sphere}, placements);
  std::mt19937_64 random(seed + 1);
  std::normal_distribution<double> normal(0.0, 0.1);
  for (Vector3& v : packing.velocity) {
    v = {normal(random), normal(random), normal(random)};
  }
  return packing;
}

using Seen = std::tuple<int, int, int, int, int>; ///< grain, other grain, image

std::set<Seen> all_pairs(const std::vector<Vector3>& x, const Box& box, double reach) {
  std::set<Seen> pairs;
  const auto& periodic = box.periodic();
  for (int i = 0; i < static_cast<int>(x.size()); ++i) {
    for (int j = 0; j < static_cast<int>(x.size()); ++j) {
      const Vector3 nearest = box.h_inverse() * (x[i] - x[j]);
      const auto around = [&](int axis) { return periodic[axis] ? static_cast<int>(std::round(nearest[axis])) : 0; };
      const int range[3] = {periodic[0] ? 3 : 0, periodic[1] ? 3 : 0, periodic[2] ? 3 : 0};
      for (int c = around(2) - range[2]; c <= around(2) + range[2]; ++c) {
        for (int b = around(1) - range[1]; b <= around(1) + range[1]; ++b) {
          for (int a = around(0) - range[0]; a <= around(0) + range[0]; ++a) {
            if ((i != j || a != 0 || b != 0 || c != 0) && (x[i] - x[j] - box.h() * Vector3(a, b, c)).norm() < reach) {
              pairs.insert({i, j, a, b, c});
            }
          }
        }
      }
    }
  }
  return pairs;
}

TEST(PointList, HasAllPairsThatAreCloserThanTheReach) {
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const std::vector<Vector3> x = random_positions(c, 7);
    const double reach = 1.37;
    PointList list;
    list.build(x, c.box, reach);
    std::set<Seen> found;
    for (const PointChunk& chunk : list.chunks()) {
      for (std::int32_t k = 0; k < chunk.n_slots(); ++k) {
        for (std::int32_t e = chunk.first[k]; e < chunk.first[k + 1]; ++e) {
          const ImageVector& n = chunk.images[chunk.image[e]];
          EXPECT_TRUE(
              found.insert({list.grain_of(chunk.begin + k), list.grain_of(chunk.other[e]), n.a, n.b, n.c}).second);
        }
      }
    }
    const std::set<Seen> wanted = all_pairs(x, c.box, reach);
    EXPECT_GT(wanted.size(), 2U);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), wanted.begin(), wanted.end()));
    EXPECT_LE(found.size(), wanted.size() + 2); // a hair beyond the reach at most
    EXPECT_EQ(list.n_candidates(), static_cast<std::int64_t>(found.size()));
  }
}

TEST(PointContacts, ForcesAreThoseOfAllPairs) {
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Packing packing = packing_of(c, 11);
    const Material material;
    const Matrix3 residual = (Matrix3() << 0.0, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0).finished();
    const LaneLayout layout(packing, Precision::full);
    LaneState state(packing, layout);
    ForceField forces(packing, layout, material, 0.3);
    forces.evaluate(state, packing.box, {.virial = Virial::full, .keep_forces = true, .residual_rate = residual});
    if (c.spread > 3.0) {
      continue; // plain_forces looks at near images alone; the next test has these
    }
    const PlainForces plain = plain_forces(packing, material, 4, residual);
    double largest = 0.0;
    for (const Vector3& f : plain.force) {
      largest = std::max(largest, f.norm());
    }
    for (int g = 0; g < packing.n_grains(); ++g) {
      EXPECT_LE((state.force(g, 0) - plain.force[g]).norm(), 1e-13 * std::max(1.0, largest)) << "node " << g;
    }
    EXPECT_EQ(forces.contact_totals().n_touching, plain.n_contacts);
    EXPECT_GT(plain.n_contacts, 0);
  }
}

/// Forces and sums of the contacts of a state, grain by grain.
struct Contacts {
  std::vector<double> force;
  std::vector<kernels::ContactSums> sums;
};

template <class Real> Contacts by_points(PointContacts& points, const LaneLayout& layout, const ForceSums& sums) {
  Contacts found{{}, sums.contacts};
  for (int g = 0; g < layout.n_grains(); ++g) {
    const Block& block = layout.blocks()[layout.block_of(g)];
    std::vector<Real> f(3 * static_cast<std::size_t>(block.n_lanes), Real{0});
    points.add(block, f.data());
    for (int k = 0; k < 3; ++k) {
      found.force.push_back(static_cast<double>(f[k * block.n_lanes + layout.lane_of(g)]));
    }
  }
  return found;
}

template <class Real>
Contacts by_pairs(const Packing& packing, const LaneLayout& layout, const LaneState& state, const Box& box,
                  const Material& material, const Evaluation& what) {
  ContactForces contacts(layout, material, 0.3, kernels::best_table(), Distribution::alone());
  contacts.layout_changed();
  const NetworkData network(*packing.templates[0]);
  const std::vector<const NetworkData*> networks(layout.n_grains(), &network);
  contacts.prepare(state, box, networks);
  for (const int pair : contacts.own_part().pairs) {
    contacts.evaluate(pair, box, what);
  }
  Contacts found;
  for (int g = 0; g < layout.n_grains(); ++g) {
    const int stride = layout.stride(g);
    std::vector<Real> f(3 * static_cast<std::size_t>(stride), Real{0});
    kernels::ContactSums sums{};
    contacts.add(g, f.data(), &sums);
    for (int k = 0; k < 3; ++k) {
      found.force.push_back(static_cast<double>(f[static_cast<std::size_t>(k) * stride]));
    }
    found.sums.push_back(sums);
  }
  return found;
}

void expect_same_bits(const Contacts& a, const Contacts& b) {
  ASSERT_EQ(a.force.size(), b.force.size());
  for (std::size_t k = 0; k < a.force.size(); ++k) {
    ASSERT_EQ(a.force[k], b.force[k]) << "grain " << k / 3;
  }
  for (std::size_t g = 0; g < a.sums.size(); ++g) {
    for (int c = 0; c < 6; ++c) {
      ASSERT_EQ(a.sums[g].virial[c], b.sums[g].virial[c]) << "grain " << g;
    }
    ASSERT_EQ(a.sums[g].smallest_r2, b.sums[g].smallest_r2);
    ASSERT_EQ(a.sums[g].potential, b.sums[g].potential);
    ASSERT_EQ(a.sums[g].n_touching, b.sums[g].n_touching);
  }
}

/// Moves nodes and cell for some steps, some nodes fast, and compares at each.
template <class Real> void follow(const Case& c, Precision precision) {
  SCOPED_TRACE(c.name);
  const Packing packing = packing_of(c, 3);
  const LaneLayout layout(packing, precision);
  LaneState state(packing, layout);
  const Material material{.contact = "hertz", .contact_parameters = {0.7}};
  const auto law = contact_model(between_grains(material));
  PointContacts points(layout, *law, 0.3);
  const Evaluation what{.virial = Virial::full,
                        .residual_rate = (Matrix3() << 0.0, 0.01, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0).finished()};
  Box box = c.box;
  const bool is_periodic = box.periodic()[0] && box.periodic()[1];
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 0.004);
  constexpr int n_steps = 25;
  for (int step = 0; step < n_steps; ++step) {
    ForceSums sums;
    sums.reset(layout.n_grains());
    points.prepare(state, box);
    points.evaluate(precision, box, what, sums);
    expect_same_bits(by_points<Real>(points, layout, sums),
                     by_pairs<Real>(packing, layout, state, box, material, what));
    const Vector3 tilts(box.h()(0, 1) + (is_periodic ? 2e-3 * box.h()(1, 1) : 0.0), box.h()(0, 2), box.h()(1, 2));
    const Box next(box.origin(), box.h().diagonal() * (1.0 - 1e-3), tilts, box.periodic());
    const Matrix3 map = next.h() * box.h_inverse();
    for (int g = 0; g < layout.n_grains(); ++g) {
      const double share = g % 50 == step ? 100.0 : 1.0;
      const Vector3 carried = next.origin() + map * (state.position(g, 0) - box.origin());
      state.set_position(g, 0, carried + share * Vector3(normal(random), normal(random), normal(random)));
    }
    box = next;
  }
  EXPECT_GE(points.n_builds(), 1);
}

TEST(PointContacts, AreThoseOfPairsOfGrainsToTheLastBit) {
  for (const Case& c : cases) {
    follow<double>(c, Precision::full);
  }
}

TEST(PointContacts, AreThoseOfPairsOfGrainsInMixedPrecision) {
  for (const Case& c : cases) {
    if (c.spread <= 3.0) { // far from its origin a node of mixed precision has no place
      follow<float>(c, Precision::mixed);
    }
  }
}

TEST(PointContacts, TheListLastsWhileNodesMoveLittle) {
  const Case& c = cases.front();
  const Packing packing = packing_of(c, 3);
  const LaneLayout layout(packing, Precision::full);
  LaneState state(packing, layout);
  const auto law = contact_model(Material{});
  PointContacts points(layout, *law, 0.3);
  for (int step = 0; step < 100; ++step) {
    points.prepare(state, c.box);
    for (int g = 0; g < layout.n_grains(); ++g) {
      state.set_position(g, 0, state.position(g, 0) + Vector3(1e-3, 0.0, 0.0));
    }
  }
  EXPECT_LE(points.n_builds(), 4); // 0.1 d of motion in all, the skins at least 0.1 d
  EXPECT_GE(points.n_builds(), 1);
}

TEST(PointContacts, ServesPackingsOfSingleNodesAlone) {
  const Packing points = packing_of(cases.front(), 3);
  EXPECT_TRUE(PointContacts::serves(LaneLayout(points)));
  const auto sphere = std::make_shared<const GrainTemplate>(build_template({.n_nodes = 1}));
  const auto grain = std::make_shared<const GrainTemplate>(build_template({.n_nodes = 40}));
  const Packing mixed =
      make_packing(cases.front().box, {sphere, grain},
                   {{Grain{.alpha = 0.0}, Vector3::Zero()}, {Grain{.template_index = 1}, Vector3(4.0, 4.0, 4.0)}});
  EXPECT_FALSE(PointContacts::serves(LaneLayout(mixed)));
}

} // namespace
} // namespace boba::test

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/lammps_data.h"
#include "bpm/packing/network_grouping.h"
#include "bpm/packing/node_order.h"
#include "bpm/packing/whole_grains.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <set>

namespace boba {
namespace {

using Rows = std::vector<std::array<std::int64_t, 2>>;

/// Owner of what BondedNodes looks at.
struct Nodes {
  Box box = Box(Vector3::Zero(), Vector3(20, 20, 20));
  std::vector<std::int64_t> id, molecule;
  std::vector<int> type;
  std::vector<Vector3> position;
  Rows bonds;

  void add(std::int64_t the_molecule, const Vector3& x) {
    id.push_back(static_cast<std::int64_t>(id.size()) + 1);
    molecule.push_back(the_molecule);
    type.push_back(1);
    position.push_back(x);
  }
  GroupedNetwork group() const { return group_network({box, id, molecule, type, position, bonds}); }
};

Nodes from_file(const std::string& name) {
  const LammpsData data = read_lammps_data(std::string(BOBA_TEST_DATA) + "/forces/" + name);
  return {data.box, data.id, data.molecule, data.type, data.position, data.bond_rows()};
}

/// The packing's bonds as pairs of file ids with the length there, from the templates.
std::set<std::pair<std::int64_t, std::int64_t>> bonds_by_id(const Packing& packing) {
  std::set<std::pair<std::int64_t, std::int64_t>> pairs;
  for (const Topology::Pair& bond : packing.topology(true).bonds) {
    pairs.insert(std::minmax(packing.id[bond.i], packing.id[bond.j]));
  }
  return pairs;
}

void expect_same_network(const Nodes& nodes, const GroupedNetwork& grouped) {
  std::set<std::pair<std::int64_t, std::int64_t>> wanted;
  for (const auto& [i, j] : nodes.bonds) {
    wanted.insert(std::minmax(nodes.id[i], nodes.id[j]));
  }
  EXPECT_EQ(bonds_by_id(grouped.packing), wanted);
  const std::vector<Vector3>& x = grouped.packing.position;
  for (const Topology::Pair& bond : grouped.packing.topology(true).bonds) {
    ASSERT_NEAR((x[bond.i] - x[bond.j]).norm(), bond.r0, 1e-12); // whole, and r0 belongs to this pair
  }
  for (std::size_t node = 0; node < grouped.row.size(); ++node) {
    ASSERT_EQ(grouped.packing.id[node], nodes.id[grouped.row[node]]);
    const Vector3 s = nodes.box.h_inverse() * (x[node] - nodes.position[grouped.row[node]]);
    ASSERT_LT((s - s.array().round().matrix()).norm(), 1e-12); // moved by lattice vectors only
  }
}

TEST(NetworkGrouping, FixtureGrainsShareOneTemplate) {
  for (const std::string name : {"ortho.ref.data.gz", "tri.ref.data.gz"}) {
    const Nodes nodes = from_file(name);
    const GroupedNetwork grouped = nodes.group();
    ASSERT_EQ(grouped.packing.n_grains(), 2) << name;
    EXPECT_EQ(grouped.packing.templates.size(), 1u);
    EXPECT_EQ(grouped.packing.templates[0]->n_nodes(), 303);
    EXPECT_EQ(grouped.packing.templates[0]->bonds.size(), 1651u);
    EXPECT_FALSE(grouped.packing.templates[0]->period);
    EXPECT_EQ(grouped.packing.grains[1].molecule, 2);
    EXPECT_EQ(grouped.packing.grains[1].species, 0);
    expect_same_network(nodes, grouped);
    Vector3 mean = Vector3::Zero();
    for (const Vector3& x : grouped.packing.templates[0]->position) {
      mean += x;
    }
    EXPECT_LT(mean.norm(), 1e-10);
  }
}

TEST(NetworkGrouping, DoesNotDependOnWrapping) {
  Nodes nodes = from_file("tri.ref.data.gz");
  std::mt19937 random(5);
  std::uniform_int_distribution<int> image(-3, 3);
  for (Vector3& x : nodes.position) {
    x += nodes.box.h() * Vector3(image(random), image(random), image(random));
  }
  const GroupedNetwork grouped = nodes.group();
  EXPECT_EQ(grouped.packing.templates.size(), 1u);
  expect_same_network(nodes, grouped);
}

TEST(NetworkGrouping, FindsTheNetworkUnderShuffledIdsAndRows) {
  Nodes nodes = from_file("ortho.ref.data.gz");
  std::mt19937 random(11);
  std::shuffle(nodes.id.begin(), nodes.id.end(), random);
  std::shuffle(nodes.bonds.begin(), nodes.bonds.end(), random);
  const GroupedNetwork grouped = nodes.group();
  EXPECT_EQ(grouped.packing.templates.size(), 1u);
  expect_same_network(nodes, grouped);
}

TEST(NetworkGrouping, DifferentNetworksGetTheirOwnTemplates) {
  Nodes nodes = from_file("ortho.ref.data.gz");
  const Nodes as_it_is = nodes;
  nodes.position[nodes.bonds.back()[0]] += Vector3(1e-9, 0, 0);
  EXPECT_EQ(nodes.group().packing.templates.size(), 2u);
  expect_same_network(nodes, nodes.group());
  nodes = as_it_is;
  nodes.bonds.pop_back();
  EXPECT_EQ(nodes.group().packing.templates.size(), 2u);
  expect_same_network(nodes, nodes.group());
}

TEST(NetworkGrouping, FallsBackToConnectedPieces) {
  for (const std::array<std::int64_t, 4> molecules :
       {std::array<std::int64_t, 4>{0, 0, 0, 0}, {1, 1, 1, 1}, {1, 2, 2, 1}, {0, 0, 5, 5}}) {
    Nodes nodes;
    nodes.add(molecules[0], Vector3(1, 1, 1));
    nodes.add(molecules[1], Vector3(2, 1, 1));
    nodes.add(molecules[2], Vector3(5, 1, 1));
    nodes.add(molecules[3], Vector3(6, 1, 1));
    nodes.bonds = {{2, 3}, {0, 1}};
    const GroupedNetwork grouped = nodes.group();
    ASSERT_EQ(grouped.packing.n_grains(), 2);
    EXPECT_EQ(grouped.packing.grains[0].molecule, 1);
    EXPECT_EQ(grouped.packing.grains[1].molecule, 2);
    EXPECT_EQ(grouped.packing.templates.size(), 1u);
    expect_same_network(nodes, grouped);
  }
}

TEST(NetworkGrouping, KeepsAMoleculeOfSeveralPiecesTogether) {
  Nodes nodes;
  nodes.add(7, Vector3(19.9, 1, 1));
  nodes.add(7, Vector3(0.9, 1, 1));
  nodes.add(7, Vector3(19.5, 3, 1)); // alone
  nodes.add(3, Vector3(10, 10, 10));
  nodes.type = {2, 3, 2, 1};
  nodes.bonds = {{0, 1}};
  const GroupedNetwork grouped = nodes.group();
  ASSERT_EQ(grouped.packing.n_grains(), 2);
  EXPECT_EQ(grouped.packing.grains[0].molecule, 3);
  EXPECT_EQ(grouped.packing.grains[1].molecule, 7);
  EXPECT_EQ(grouped.packing.grains[1].species, 1);
  double far = 0.0;
  for (int i = 1; i < 4; ++i) {
    for (int j = 1; j < 4; ++j) {
      far = std::max(far, (grouped.packing.position[i] - grouped.packing.position[j]).norm());
    }
  }
  EXPECT_LT(far, 3.0);
}

TEST(NetworkGrouping, RefusesWhatCannotBeRight) {
  Nodes pair;
  pair.add(1, Vector3(1, 1, 1));
  pair.add(1, Vector3(2, 1, 1));
  const auto message = [](const Nodes& nodes) {
    return test::message_of<std::invalid_argument>([&] { nodes.group(); });
  };
  Nodes twice = pair;
  twice.bonds = {{0, 1}, {1, 0}};
  EXPECT_NE(message(twice).find("nodes 1 and 2 is given twice"), std::string::npos) << message(twice);
  Nodes length_zero = pair;
  length_zero.position[1] = pair.position[0];
  length_zero.bonds = {{0, 1}};
  EXPECT_NE(message(length_zero).find("length 0"), std::string::npos) << message(length_zero);
  Nodes half = pair;
  half.position[1] = Vector3(11, 1, 1);
  half.bonds = {{0, 1}};
  EXPECT_NE(message(half).find("half the distance"), std::string::npos) << message(half);
  EXPECT_NE(message(Nodes()).find("no nodes"), std::string::npos);
}

/// A chain of 10 nodes, 2 d apart, closed through the boundary.
Nodes closed_chain() {
  Nodes chain;
  for (int i = 0; i < 10; ++i) {
    chain.add(1, Vector3(2.0 * i, 1, 1));
    chain.bonds.push_back({i, (i + 1) % 10});
  }
  return chain;
}

TEST(NetworkGrouping, AGrainBondedToItsOwnImageIsPeriodic) {
  Nodes chain = closed_chain();
  const GroupedNetwork grouped = chain.group();
  ASSERT_TRUE(grouped.packing.templates[0]->period);
  EXPECT_EQ(*grouped.packing.templates[0]->period, Vector3(20, 20, 20));
  for (const Bond& bond : grouped.packing.templates[0]->bonds) {
    EXPECT_DOUBLE_EQ(bond.r0, 2.0);
  }
  chain.box = Box(Vector3::Zero(), Vector3(20, 20, 20), Vector3(3, 0, 0));
  EXPECT_NE(test::message_of<std::invalid_argument>([&] { chain.group(); }).find("tilted cell"), std::string::npos);
}

TEST(WholePositions, RefusesAStateThatTearsAGrain) {
  const Nodes nodes = from_file("ortho.ref.data.gz");
  const GroupedNetwork grouped = nodes.group();
  std::vector<Vector3> state = grouped.packing.position;
  state[5] += Vector3(7.9, 0, 0);
  const std::string message =
      test::message_of<std::invalid_argument>([&] { whole_positions(grouped.packing, nodes.box, state); });
  EXPECT_NE(message.find("half the distance"), std::string::npos) << message;
}

TEST(NodeOrder, IsAPermutationThatBringsBondsTogether) {
  Nodes nodes = from_file("ortho.ref.data.gz");
  const GrainTemplate shape = *nodes.group().packing.templates[0];
  std::vector<int> shuffled(shape.n_nodes());
  std::iota(shuffled.begin(), shuffled.end(), 0);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  std::vector<Bond> bonds = shape.bonds;
  for (Bond& bond : bonds) {
    bond.i = shuffled[bond.i];
    bond.j = shuffled[bond.j];
  }
  const std::vector<int> order = local_node_order(shape.n_nodes(), bonds);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), 303u);
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[order[k]] = static_cast<int>(k);
  }
  const auto mean_distance = [&](auto where) {
    double sum = 0.0;
    for (const Bond& bond : bonds) {
      sum += std::abs(where(bond.i) - where(bond.j));
    }
    return sum / static_cast<double>(bonds.size());
  };
  // A random order gives a third of 303.
  EXPECT_NEAR(mean_distance([](int node) { return node; }), 101.0, 10.0);
  EXPECT_LT(mean_distance([&](int node) { return place[node]; }), 45.0);
  EXPECT_TRUE(local_node_order(0, {}).empty());
  EXPECT_EQ(local_node_order(3, {}).size(), 3u);
}

} // namespace
} // namespace boba

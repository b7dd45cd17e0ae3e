// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/contact_network.h"
#include "bpm/measure/footprint.h"
#include "bpm/measure/stress.h"
#include "tests/support/crystals.h"
#include "tests/support/shapes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <stdexcept>

namespace {

using namespace boba;
using namespace boba::measure;
using std::numbers::pi;

TEST(Footprint, DiscsOnASquareAndOnALine) {
  std::vector<Vector3> square;
  for (const Vector3& x : shapes::cube()) {
    square.push_back(shapes::some_rotation() * x + Vector3(7, 8, 9));
  }
  const Vector3 normal = shapes::some_rotation().col(2);
  EXPECT_NEAR(footprint_area(square, normal, 0.5), 4.0 + 8.0 * 0.5 + pi * 0.25, 1e-12);
  EXPECT_NEAR(footprint_area(std::vector<Vector3>{{1, 2, 3}}, normal, 0.5), pi / 4.0, 1e-15);
  const std::vector<Vector3> line = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  EXPECT_NEAR(footprint_area(line, Vector3::UnitZ(), 0.5), 3.0 + pi / 4.0, 1e-12);
}

TEST(ContactNetwork, OnePairOfNodesAcrossAFace) {
  // Two grains of one node each, 0.9 apart through the face of a tilted cell.
  const Box box(Vector3::Zero(), {6.0, 5.0, 4.0}, {2.0, 0.0, 0.0});
  const std::vector<Vector3> nodes = {{0.2, 2.0, 1.0}, {0.2 + 6.0 * 3 - 0.9, 2.0, 1.0}};
  const std::vector<std::int64_t> first_node = {0, 1, 2};
  const auto contacts = contact_network(box, {nodes, first_node});
  ASSERT_EQ(contacts.size(), 1u);
  const GrainContact& contact = contacts.front();
  EXPECT_EQ(contact.image, (std::array{-3, 0, 0}));
  const double force = 0.1 + 50.0 * 0.001;                                // k (d - r) + 50 (d - r)^3
  EXPECT_NEAR((contact.force - Vector3(force, 0, 0)).norm(), 0.0, 1e-12); // pushed to +x, away from the other
  EXPECT_NEAR((contact.normal - Vector3(-1, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((contact.branch - Vector3(-0.9, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((contact.point - Vector3(-0.25, 2.0, 1.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(contact.area, pi / 4.0, 1e-12);
  EXPECT_NEAR(contact.largest_overlap, 0.1, 1e-12);
  EXPECT_EQ(contact.n_pairs, 1);
}

TEST(ContactNetwork, AgreesWithAllPairsOfAllImages) {
  const Box box({1.0, -2.0, 0.0}, {7.0, 6.0, 6.5}, {3.0, -2.0, 1.0});
  std::vector<Vector3> nodes;
  std::vector<std::int64_t> first_node = {0};
  for (int g = 0; g < 5; ++g) {
    for (const Vector3& x : shapes::ball(80, 2.3, 100 + g)) {
      nodes.push_back(box.to_position(Vector3(0.2 * g + 2.0 * (g % 2), 0.37 * g, 0.71 * g)) + x);
    }
    first_node.push_back(static_cast<std::int64_t>(nodes.size()));
  }
  const GrainNodes grains(nodes, first_node);
  std::size_t found = 0;
  const auto contacts = contact_network(box, grains);
  for (int i = 0; i < 5; ++i) {
    for (int j = i; j < 5; ++j) {
      for (int k = 0; k < 9 * 9 * 9; ++k) {
        const std::array<int, 3> image = {k % 9 - 4, k / 9 % 9 - 4, k / 81 - 4};
        if (i == j && image <= std::array{0, 0, 0}) {
          continue;
        }
        int n_pairs = 0;
        Vector3 force = Vector3::Zero();
        for (const Vector3& x : grains.nodes_of(i)) {
          for (const Vector3& y : grains.nodes_of(j)) {
            const Vector3 r = x - y - box.h() * Vector3(image[0], image[1], image[2]);
            const double overlap = 1.0 - r.norm();
            n_pairs += overlap > 0.0;
            force += overlap > 0.0 ? Vector3((overlap + 50.0 * std::pow(overlap, 3)) * r.normalized())
                                   : Vector3(Vector3::Zero());
          }
        }
        const auto match = std::find_if(contacts.begin(), contacts.end(), [&](const GrainContact& c) {
          return c.grain == i && c.other == j && c.image == image;
        });
        ASSERT_EQ(match != contacts.end(), n_pairs > 0);
        if (n_pairs > 0) {
          ++found;
          EXPECT_EQ(match->n_pairs, n_pairs);
          EXPECT_NEAR((match->force - force).norm(), 0.0, 1e-9 * (1.0 + force.norm()));
          EXPECT_NEAR(match->normal.dot(force.normalized()), -1.0, 1e-9);
        }
      }
    }
  }
  EXPECT_EQ(found, contacts.size());
  EXPECT_GT(found, 10u);
}

/// Single nodes on the sites of a crystal, nearest neighbours overlapping a little.
std::vector<GrainContact> crystal_contacts(const crystals::Crystal& crystal) {
  std::vector<std::int64_t> first_node(crystal.centres.size() + 1);
  std::iota(first_node.begin(), first_node.end(), 0);
  return contact_network(crystal.box, {crystal.centres, first_node}, {.diameter = 1.05});
}

TEST(ContactNetwork, FccHasTwelveContactsAndNoPreferredDirection) {
  const auto crystal = crystals::fcc(2); // two cells an edge: some grains touch twice, through different faces
  const auto contacts = crystal_contacts(crystal);
  EXPECT_EQ(contacts.size(), 6 * crystal.centres.size());
  const Coordination z = coordination(static_cast<int>(crystal.centres.size()), contacts);
  EXPECT_DOUBLE_EQ(z.mean, 12.0);
  EXPECT_DOUBLE_EQ(z.mean_without_rattlers, 12.0);
  EXPECT_EQ(z.n_rattlers, 0);
  EXPECT_NEAR((fabric_tensor(contacts) - Matrix3::Identity() / 3.0).norm(), 0.0, 1e-9);
  EXPECT_NEAR(fabric_anisotropy(fabric_tensor(contacts)), 0.0, 1e-9);
}

TEST(ContactNetwork, GrainTouchesItsOwnImages) {
  const Box box(Vector3::Zero(), {0.95, 3.0, 3.0});
  const std::vector<Vector3> nodes = {{0.5, 1.0, 1.0}};
  const std::vector<std::int64_t> first_node = {0, 1};
  const auto contacts = contact_network(box, {nodes, first_node});
  ASSERT_EQ(contacts.size(), 1u); // +a; -a is the same contact seen from the other side
  EXPECT_EQ(contacts[0].grain, contacts[0].other);
  EXPECT_EQ(coordination(1, contacts).n_contacts[0], 2);
  EXPECT_NEAR(fabric_anisotropy(fabric_tensor(contacts)), 1.0, 1e-12);
}

TEST(Coordination, RattlersGoOneAfterTheOther) {
  // 0-1-2-3-4 all touching each other (4 contacts each); 5 hangs on three of them; 6 hangs on 5 alone.
  std::vector<GrainContact> contacts;
  for (int i = 0; i < 5; ++i) {
    for (int j = i + 1; j < 5; ++j) {
      contacts.push_back({.grain = i, .other = j});
    }
  }
  for (const int other : {0, 1, 2}) {
    contacts.push_back({.grain = other, .other = 5});
  }
  contacts.push_back({.grain = 5, .other = 6});
  const Coordination z = coordination(8, contacts); // grain 7 touches nobody
  EXPECT_EQ(z.n_contacts, (std::vector{5, 5, 5, 4, 4, 4, 1, 0}));
  EXPECT_EQ(z.n_rattlers, 3); // 7 and 6 at once, then 5, which had four contacts with 6
  EXPECT_DOUBLE_EQ(z.mean, 28.0 / 8.0);
  EXPECT_DOUBLE_EQ(z.mean_without_rattlers, 4.0);
  EXPECT_EQ(coordination(3, {}).n_rattlers, 3);
  EXPECT_DOUBLE_EQ(coordination(3, {}).mean_without_rattlers, 0.0);
}

TEST(Stress, SummarySignsAndKineticPart) {
  const StressSummary s = summarise_stress({-2.0, -3.0, -4.0, 0.6, 0.0, 0.0});
  EXPECT_DOUBLE_EQ(s.pressure, 3.0);
  EXPECT_DOUBLE_EQ(s.mu, 0.2);
  EXPECT_DOUBLE_EQ(s.normal_difference_1, 1.0);
  EXPECT_DOUBLE_EQ(s.normal_difference_2, 1.0);
  const Box box({1.0, 1.0, 1.0}, {2.0, 2.0, 2.0});
  const std::vector<Vector3> x = {{1.0, 2.0, 1.0}, {1.0, 3.0, 1.0}};
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 1) = 0.5; // streaming velocity 0.5 (y - 1) along x
  const std::vector<Vector3> v = {{0.5 + 0.1, 0.2, 0.0}, {1.0, 0.0, -0.3}};
  const Tensor6 kinetic = kinetic_stress(box, x, v, 2.0, gradient);
  EXPECT_NEAR(kinetic[0], -2.0 * 0.01 / 8.0, 1e-15);
  EXPECT_NEAR(kinetic[1], -2.0 * 0.04 / 8.0, 1e-15);
  EXPECT_NEAR(kinetic[2], -2.0 * 0.09 / 8.0, 1e-15);
  EXPECT_NEAR(kinetic[3], -2.0 * 0.02 / 8.0, 1e-15);
}

} // namespace

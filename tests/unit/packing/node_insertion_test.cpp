// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/build_template.h"
#include "bpm/packing/node_insertion.h"

#include <gtest/gtest.h>
#include <limits>

namespace boba {
namespace {

using ShapeName = TemplateSpec::Shape;

Insertion insertion_of(const TemplateSpec& spec, int count, double fraction) {
  Insertion insertion;
  insertion.templates = {std::make_shared<const GrainTemplate>(build_template(spec))};
  insertion.grains.assign(count, Grain{});
  insertion.packing_fraction = fraction;
  return insertion;
}

/// Smallest distance of nodes of different grains, or of a grain and an image of itself, by brute force.
double smallest_distance(const Packing& packing) {
  double least = std::numeric_limits<double>::infinity();
  const double edge = packing.box.h()(0, 0);
  const std::vector<int> n_nodes = packing.nodes_of_grains();
  std::size_t first = 0;
  for (const int n : n_nodes) {
    for (std::size_t i = first; i < first + n; ++i) {
      for (std::size_t j = 0; j < packing.position.size(); ++j) {
        Vector3 r = packing.position[j] - packing.position[i];
        const Eigen::Vector3d wraps = (r / edge).array().round();
        r -= edge * wraps;
        if (j < first || j >= first + n || wraps.squaredNorm() > 0.0) {
          least = std::min(least, r.norm());
        }
      }
    }
    first += n;
  }
  return least;
}

TEST(InsertByNodes, CubesAndEllipsoidsKeepTheirDistanceAtDensitiesThatSpheresForbid) {
  const TemplateSpec cube{.shape = ShapeName::polyhedron, .n_nodes = 216};
  const TemplateSpec rod{.shape = ShapeName::ellipsoid, .size = {1, 1, 3}, .n_nodes = 200};
  for (const TemplateSpec& spec : {cube, rod}) {
    const Insertion insertion = insertion_of(spec, 12, 0.25);
    EXPECT_FALSE(are_round(insertion));
    EXPECT_THROW(insert_at_random(insertion), std::invalid_argument);
    const Packing packing = insert_by_nodes(insertion);
    EXPECT_GE(smallest_distance(packing), insertion.diameter);
    EXPECT_NEAR(12 * insertion.templates[0]->reference_volume / packing.box.volume(), 0.25, 1e-12);
  }
}

TEST(InsertByNodes, TheSameSeedGivesTheSamePlaces) {
  Insertion insertion = insertion_of({.shape = ShapeName::polyhedron, .n_nodes = 60}, 6, 0.15);
  const Packing first = insert_by_nodes(insertion), again = insert_by_nodes(insertion);
  insertion.seed = 2;
  const Packing other = insert_by_nodes(insertion);
  EXPECT_EQ(first.position, again.position);
  EXPECT_NE(first.position, other.position);
}

TEST(InsertByNodes, SaysWhenNotAllFit) {
  const Insertion insertion = insertion_of({.shape = ShapeName::polyhedron, .n_nodes = 60}, 6, 0.6);
  EXPECT_THROW(insert_by_nodes(insertion), std::runtime_error);
}

TEST(InsertByNodes, SpheresAreRound) {
  for (const int nodes : {20, 100, 500}) {
    EXPECT_TRUE(are_round(insertion_of({.n_nodes = nodes}, 1, 0.1))) << nodes;
  }
}

} // namespace
} // namespace boba

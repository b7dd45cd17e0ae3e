// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/convex_hull.h"
#include "bpm/measure/hull_facets.h"
#include "bpm/measure/hull_shape.h"
#include "tests/support/shapes.h"
#include "tests/unit/measure/grain_file.h"
#include "tests/unit/measure/qhull_oracle.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

namespace {

using namespace boba;
using namespace boba::measure;
using std::numbers::pi;

/// Every edge is shared by two triangles that run along it in opposite directions, and n . x is largest on the hull.
void expect_closed_and_convex(const ConvexHull& hull, std::span<const Vector3> nodes) {
  EXPECT_EQ(static_cast<int>(hull.vertex.size()) - 3 * hull.n_triangles() / 2 + hull.n_triangles(), 2);
  for (int t = 0; t < hull.n_triangles(); ++t) {
    for (int e = 0; e < 3; ++e) {
      const auto& other = hull.triangle[hull.neighbour[t][e]];
      const int from = hull.triangle[t][e], to = hull.triangle[t][(e + 1) % 3];
      bool reversed = false;
      for (int f = 0; f < 3; ++f) {
        reversed = reversed || (other[f] == to && other[(f + 1) % 3] == from);
      }
      EXPECT_TRUE(reversed) << "triangle " << t << " edge " << e;
    }
    const Vector3 normal = hull.area_vector(t).normalized();
    const double height = normal.dot(hull.vertex[hull.triangle[t][0]]);
    for (const Vector3& x : nodes) {
      ASSERT_LE(normal.dot(x), height + 1e-9 * (1.0 + x.norm()));
    }
  }
}

TEST(Hull, CubeHasTheVolumeAreaAndMomentsOfACube) {
  const auto points = shapes::moved(shapes::cube(), shapes::some_rotation(), {5.0, -7.0, 3.0});
  const ConvexHull hull = convex_hull(points);
  expect_closed_and_convex(hull, points);
  const HullShape shape = hull_shape(hull);
  EXPECT_NEAR(shape.volume, 8.0, 1e-12);
  EXPECT_NEAR(shape.area, 24.0, 1e-12);
  EXPECT_NEAR(shape.asphericity, std::sqrt(6.0 / pi), 1e-12); // (6 a^2)^(3/2) / (6 sqrt(pi) a^3)
  EXPECT_NEAR((shape.centroid - Vector3(5.0, -7.0, 3.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((shape.moments - Vector3::Constant(2.0 / 3.0)).norm(), 0.0, 1e-12); // a^2/6 with a = 2
}

TEST(Hull, BrickHasItsMomentsAlongItsEdges) {
  auto points = shapes::cube();
  for (Vector3& x : points) {
    x = x.cwiseProduct(Vector3(1.0, 2.0, 3.0));
  }
  const Matrix3 rotation = shapes::some_rotation();
  const HullShape shape = hull_shape(convex_hull(shapes::moved(points, rotation, {100.0, 50.0, -80.0})));
  // Edges 2, 4, 6: (b^2 + c^2)/12; the smallest moment is about the longest edge.
  EXPECT_NEAR((shape.moments - Vector3(20.0 / 12.0, 40.0 / 12.0, 52.0 / 12.0)).norm(), 0.0, 1e-11);
  EXPECT_NEAR(std::abs(shape.axes.col(0).dot(rotation.col(2))), 1.0, 1e-11);
  EXPECT_NEAR(std::abs(shape.axes.col(2).dot(rotation.col(0))), 1.0, 1e-11);
  EXPECT_NEAR(shape.axes.determinant(), 1.0, 1e-12);
}

TEST(Hull, RhombicDodecahedronIsTheFccCell) {
  const auto points = shapes::moved(shapes::rhombic_dodecahedron(), shapes::some_rotation(), {0.0, 0.0, 1.0});
  const ConvexHull hull = convex_hull(points);
  const HullShape shape = hull_shape(hull);
  EXPECT_NEAR(shape.volume, 16.0, 1e-12);
  EXPECT_NEAR(shape.area, 24.0 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(shape.asphericity, 1.1621, 5e-5);
  for (const Facets& facets : {transitive_facets(hull), grown_facets(hull)}) {
    ASSERT_EQ(facets.n_facets(), 12);
    EXPECT_NEAR(facets.faceted_share(), 1.0, 1e-12);
    for (const double area : facets.area) {
      EXPECT_NEAR(area, 2.0 * std::sqrt(2.0), 1e-12);
    }
  }
}

TEST(Hull, TruncatedOctahedronIsTheBccCell) {
  const ConvexHull hull = convex_hull(shapes::truncated_octahedron());
  const HullShape shape = hull_shape(hull);
  EXPECT_NEAR(shape.volume, 32.0, 1e-12);
  EXPECT_NEAR(shape.area, 12.0 + 24.0 * std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(shape.asphericity, 1.1521, 5e-5);
  for (const Facets& facets : {transitive_facets(hull), grown_facets(hull)}) {
    ASSERT_EQ(facets.n_facets(), 14);
    for (int f = 0; f < 14; ++f) { // 8 hexagons with edge sqrt(2), then 6 squares
      EXPECT_NEAR(facets.area[f], f < 8 ? 3.0 * std::sqrt(3.0) : 2.0, 1e-12);
    }
  }
}

TEST(Hull, FacetNormalsPointAlongTheFaces) {
  const Facets facets = grown_facets(convex_hull(shapes::cube()));
  ASSERT_EQ(facets.n_facets(), 6);
  for (const Vector3& normal : facets.normal) {
    EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1.0, 1e-12);
  }
}

TEST(Hull, CutSphereHasOneFacetPerPlane) {
  constexpr double radius = 10.0, height = 8.0;
  constexpr int n_rim = 90;
  const Matrix3 rotation = shapes::some_rotation();
  std::vector<Vector3> normals;
  for (int axis = 0; axis < 3; ++axis) {
    normals.push_back(rotation.col(axis));
    normals.push_back(-rotation.col(axis));
  }
  const auto points = shapes::cut_sphere(5000, radius, normals, height, n_rim);
  const ConvexHull hull = convex_hull(points);
  const Facets facets = grown_facets(hull);
  ASSERT_EQ(facets.n_facets(), 6);
  const double rim = std::sqrt(radius * radius - height * height);
  const double polygon = 0.5 * n_rim * rim * rim * std::sin(2.0 * pi / n_rim);
  for (int f = 0; f < 6; ++f) {
    EXPECT_NEAR(facets.area[f], polygon, 1e-9);
    const auto parallel = [&](const Vector3& n) { return n.dot(facets.normal[f]) > 1.0 - 1e-12; };
    EXPECT_EQ(std::count_if(normals.begin(), normals.end(), parallel), 1);
  }
  // Six caps of height R - h are gone: V and A of the rest; the mesh is inscribed, hence a little smaller.
  const double cap = pi * (radius - height) * (radius - height) * (2.0 * radius + height) / 3.0;
  const double volume = 4.0 / 3.0 * pi * radius * radius * radius - 6.0 * cap;
  const double area = 4.0 * pi * radius * radius - 6.0 * (2.0 * pi * radius * (radius - height) - pi * rim * rim);
  const HullShape shape = hull_shape(hull);
  EXPECT_NEAR(shape.volume / volume, 1.0, 2e-3);
  EXPECT_LT(shape.volume, volume);
  EXPECT_NEAR(facets.faceted_share(), 6.0 * pi * rim * rim / area, 2e-3);
}

TEST(Hull, TransitiveRuleJoinsASmoothSphereIntoOneFacetAndTheRobustRuleFindsNone) {
  const ConvexHull hull = convex_hull(shapes::sphere_surface(5000, 10.0));
  const Facets transitive = transitive_facets(hull);
  EXPECT_EQ(transitive.n_facets(), 1);
  EXPECT_NEAR(transitive.faceted_share(), 1.0, 1e-12);
  const Facets grown = grown_facets(hull);
  EXPECT_EQ(grown.n_facets(), 0); // a cap within acos(0.99) is 0.5 % of a sphere: below the area cut
  EXPECT_EQ(std::count(grown.facet_of_triangle.begin(), grown.facet_of_triangle.end(), -1), hull.n_triangles());
}

TEST(Hull, RobustRegionsHaveTheAreaOfASphericalCap) {
  const ConvexHull hull = convex_hull(shapes::sphere_surface(6000, 10.0));
  const Facets facets = grown_facets(hull, {.min_cosine = 0.9, .min_area_share = 0.04});
  ASSERT_GT(facets.n_facets(), 0);
  EXPECT_NEAR(facets.area[0] / facets.hull_area, (1.0 - 0.9) / 2.0, 2e-3); // cap: (1 - cos)/2 of the sphere
}

TEST(Hull, AreaCutAndCosineAreUsed) {
  const ConvexHull hull = convex_hull(shapes::truncated_octahedron());
  // One square is 2/(12 + 24 sqrt(3)) = 3.7 % of the area, one hexagon 9.7 %.
  EXPECT_EQ(grown_facets(hull, {.min_cosine = 0.99, .min_area_share = 0.05}).n_facets(), 8);
  EXPECT_EQ(grown_facets(hull, {.min_cosine = 0.99, .min_area_share = 0.10}).n_facets(), 0);
  // Hexagon and square meet at cos = 1/sqrt(3) = 0.577 between normals, two hexagons at 1/3.
  EXPECT_EQ(transitive_facets(hull, {.min_cosine = 0.5}).n_facets(), 1);
  EXPECT_THROW(grown_facets(hull, {.min_cosine = 1.0}), std::invalid_argument);
  EXPECT_THROW(grown_facets(hull, {.min_area_share = -0.1}), std::invalid_argument);
}

TEST(Hull, SkippingInnerNodesChangesNothing) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto points = shapes::moved(shapes::ball(6000, 10.0, seed), shapes::some_rotation(), {300.0, 10.0, -200.0});
    const std::vector<int> candidates = hull_candidates(points);
    EXPECT_LT(candidates.size(), points.size() / 3);
    const ConvexHull hull = convex_hull(points), full = convex_hull_of_all(points);
    auto some = hull.node, all = full.node;
    std::sort(some.begin(), some.end());
    std::sort(all.begin(), all.end());
    EXPECT_EQ(some, all);
    EXPECT_EQ(hull.triangle, full.triangle); // both sorted: the same mesh, triangle by triangle
  }
}

TEST(Hull, QhullAgreesOnDeformedGrains) {
  for (const char* file : {"deformed_grains_303.csv", "deformed_grain_5141.csv"}) {
    const auto grains = test_data::read_grains(file);
    for (int g = 0; g < grains.n_grains(); ++g) {
      const auto nodes = grains.nodes_of(g);
      const ConvexHull hull = convex_hull(nodes);
      expect_closed_and_convex(hull, nodes);
      const HullShape shape = hull_shape(hull);
      const auto other = test_data::qhull(nodes);
      EXPECT_NEAR(shape.volume / other.volume, 1.0, 1e-12);
      EXPECT_NEAR(shape.area / other.area, 1.0, 1e-12);
      EXPECT_EQ(std::set<int>(hull.node.begin(), hull.node.end()), other.vertices);
    }
  }
}

TEST(Hull, CoplanarNodesOnTheFacesAreNoTrouble) {
  std::vector<Vector3> grid;
  for (int i = 0; i < 9 * 9 * 9; ++i) {
    grid.push_back(0.1 * Eigen::Vector3i(i % 9, (i / 9) % 9, i / 81).cast<double>());
  }
  const ConvexHull hull = convex_hull(grid);
  const HullShape shape = hull_shape(hull);
  EXPECT_NEAR(shape.volume, 0.512, 1e-12);
  EXPECT_NEAR(shape.area, 6.0 * 0.64, 1e-12);
  EXPECT_EQ(grown_facets(hull).n_facets(), 6);
}

TEST(Hull, CoincidentNodesAreOneVertex) {
  auto points = shapes::cube();
  const auto copy = points;
  points.insert(points.end(), copy.begin(), copy.end());
  const ConvexHull hull = convex_hull(points);
  EXPECT_EQ(hull.vertex.size(), 8u);
  EXPECT_LT(*std::max_element(hull.node.begin(), hull.node.end()), 8);
  EXPECT_NEAR(hull_shape(hull).volume, 8.0, 1e-12);
}

TEST(Hull, FourNodesAreATetrahedron) {
  const std::vector<Vector3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const ConvexHull hull = convex_hull(points);
  expect_closed_and_convex(hull, points);
  EXPECT_NEAR(hull_shape(hull).volume, 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(hull_shape(hull).area, 1.5 + std::sqrt(3.0) / 2.0, 1e-15);
  EXPECT_EQ(grown_facets(hull).n_facets(), 4);
  EXPECT_EQ(transitive_facets(hull).n_facets(), 0); // four single triangles: each joins with no neighbour
}

std::string message_of(const std::vector<Vector3>& points) {
  try {
    convex_hull(points);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Hull, DegenerateInputIsNamed) {
  const Vector3 x(0.1, 0.2, 0.3);
  EXPECT_NE(message_of({}).find("0 nodes"), std::string::npos);
  EXPECT_NE(message_of({x, 2 * x, Vector3::UnitX()}).find("3 nodes"), std::string::npos);
  EXPECT_NE(message_of(std::vector<Vector3>(300, x)).find("in one point"), std::string::npos);
  std::vector<Vector3> line, plane;
  for (int i = 0; i < 400; ++i) {
    line.push_back(static_cast<double>(i) * Vector3(1.0, 2.0, 4.0));
    const int row = i / 20;
    plane.push_back(Vector3(i % 20, row, 0.7));
  }
  EXPECT_NE(message_of(line).find("on one line"), std::string::npos);
  EXPECT_NE(message_of(plane).find("in one plane"), std::string::npos);
  auto broken = shapes::cube();
  broken[3][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of(broken).find("node 3"), std::string::npos);
}

} // namespace

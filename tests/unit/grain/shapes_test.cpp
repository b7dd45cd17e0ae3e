// SPDX-License-Identifier: GPL-3.0-or-later
// The shapes of templates: volumes, moments and surfaces against closed forms and counted points.
#include "bpm/grain/build_template.h"
#include "bpm/grain/random.h"
#include "bpm/grain/shapes/convex_polyhedron.h"
#include "bpm/grain/shapes/ellipsoid.h"
#include "bpm/grain/shapes/shape.h"
#include "tests/unit/grain/complaint.h"

#include <Eigen/Dense>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numbers>

namespace boba {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using ShapeName = TemplateSpec::Shape;

std::unique_ptr<const SolidShape> solid(const TemplateSpec& spec) {
  validate(spec);
  return shape_kind(spec.shape).make(spec, 1.0);
}

TemplateSpec polyhedron(const std::string& name, double radius, double rounding = 0.0) {
  return {.shape = ShapeName::polyhedron, .radius = radius, .polyhedron = name, .rounding = rounding};
}

TemplateSpec superellipsoid(double e, double f) {
  return {.shape = ShapeName::superellipsoid, .size = {12, 8, 10}, .exponent = e, .exponent_z = f};
}

/// One of each kind that has a surface.
std::vector<TemplateSpec> all_shapes() {
  std::vector<TemplateSpec> specs = {{.shape = ShapeName::sphere, .radius = 5.0},
                                     {.shape = ShapeName::cylinder, .radius = 4.0, .height = 9.0},
                                     {.shape = ShapeName::box, .size = {6, 8, 10}},
                                     {.shape = ShapeName::ellipsoid, .size = {6, 9, 14}},
                                     superellipsoid(4.0, 2.5),
                                     superellipsoid(1.3, 6.0),
                                     {.shape = ShapeName::capsule, .radius = 3.0, .height = 14.0},
                                     {.shape = ShapeName::capsule, .radius = 4.0, .height = 9.0},
                                     polyhedron("cube", 7.0, 0.3)};
  for (const std::string& name : polyhedron_names()) {
    specs.push_back(polyhedron(name, 6.0));
    specs.push_back(polyhedron(name, 6.0, 0.25));
  }
  return specs;
}

std::string label(const TemplateSpec& spec) {
  return canonical_text(spec);
}

TEST(Shapes, HoldAsMuchAsTheirFormulaSays) {
  constexpr int n_points = 200000;
  for (const TemplateSpec& spec : all_shapes()) {
    const auto shape = solid(spec);
    Random random(3);
    int inside = 0;
    for (int n = 0; n < n_points; ++n) {
      inside += shape->reach(random.vector(1.0).cwiseProduct(shape->half_lengths())) <= 1.0 ? 1 : 0;
    }
    const double cuboid = 8.0 * shape->half_lengths().prod(), share = shape->volume() / cuboid;
    const double error = std::sqrt(share * (1.0 - share) / n_points);
    EXPECT_NEAR(inside / static_cast<double>(n_points), share, 4.0 * error + 1e-12) << label(spec);
  }
}

TEST(Shapes, ClosedFormsOfVolumes) {
  EXPECT_NEAR(solid({.shape = ShapeName::ellipsoid, .size = {6, 9, 14}})->volume(), pi / 6.0 * 6 * 9 * 14, 1e-10);
  EXPECT_NEAR(solid({.shape = ShapeName::capsule, .radius = 3.0, .height = 14.0})->volume(),
              pi * 9.0 * 8.0 + 4.0 / 3.0 * pi * 27.0, 1e-10);
  EXPECT_NEAR(solid(superellipsoid(2.0, 2.0))->volume(), pi / 6.0 * 12 * 8 * 10, 1e-9);
  EXPECT_NEAR(solid(superellipsoid(1.0, 1.0))->volume(), 12 * 8 * 10 / 6.0, 1e-9);        // octahedron
  EXPECT_NEAR(solid(superellipsoid(2.0, 1.0))->volume(), pi * 6 * 4 * 10 / 3.0, 1e-9);    // two cones
  EXPECT_NEAR(solid(superellipsoid(2.0, 50.0))->volume(), pi * 6 * 4 * 10, 0.04 * 754.0); // almost a cylinder
  // Per edge length^3 and circumradius per edge length: H. S. M. Coxeter, Regular Polytopes, table I and section 2.7.
  const double phi = std::numbers::phi, r = 6.0;
  const std::map<std::string, double> volumes = {
      {"tetrahedron", std::pow(r * std::sqrt(8.0 / 3.0), 3) / (6.0 * std::sqrt(2.0))},
      {"cube", std::pow(2.0 * r / std::sqrt(3.0), 3)},
      {"octahedron", std::pow(r * std::sqrt(2.0), 3) * std::sqrt(2.0) / 3.0},
      {"dodecahedron", std::pow(2.0 * r / (std::sqrt(3.0) * phi), 3) * (15.0 + 7.0 * std::sqrt(5.0)) / 4.0},
      {"icosahedron", std::pow(2.0 * r / std::sqrt(phi * phi + 1.0), 3) * 5.0 * (3.0 + std::sqrt(5.0)) / 12.0},
      {"rhombic dodecahedron", std::pow(r * std::sqrt(3.0) / 2.0, 3) * 16.0 * std::sqrt(3.0) / 9.0},
      {"truncated octahedron", std::pow(r / std::sqrt(2.5), 3) * 8.0 * std::sqrt(2.0)},
      {"cuboctahedron", std::pow(r, 3) * 5.0 * std::sqrt(2.0) / 3.0}};
  EXPECT_EQ(volumes.size(), polyhedron_names().size());
  for (const auto& [name, volume] : volumes) {
    EXPECT_NEAR(solid(polyhedron(name, r))->volume(), volume, 1e-9 * volume) << name;
  }
}

TEST(Shapes, FacesAndEdgesByEuler) {
  const std::map<std::string, std::array<std::size_t, 3>> counts = {{"tetrahedron", {4, 6, 4}},
                                                                    {"cube", {8, 12, 6}},
                                                                    {"octahedron", {6, 12, 8}},
                                                                    {"dodecahedron", {20, 30, 12}},
                                                                    {"icosahedron", {12, 30, 20}},
                                                                    {"rhombic dodecahedron", {14, 24, 12}},
                                                                    {"truncated octahedron", {24, 36, 14}},
                                                                    {"cuboctahedron", {12, 24, 14}}};
  for (const auto& [name, count] : counts) {
    const ConvexPolyhedron body(named_vertices(name));
    EXPECT_EQ((std::array{body.vertices().size(), body.edges().size(), body.faces().size()}), count) << name;
    EXPECT_NEAR(body.outer_radius(), 1.0, 1e-12) << name;
  }
}

TEST(Shapes, ReachScalesAndFollowsTheWall) {
  for (const TemplateSpec& spec : all_shapes()) {
    const auto shape = solid(spec);
    Random random(5);
    for (int n = 0; n < 200; ++n) {
      const Vector3d x = random.vector(2.0).cwiseProduct(shape->half_lengths());
      const double reach = shape->reach(x);
      EXPECT_NEAR(shape->reach(1.7 * x), 1.7 * reach, 1e-9 * reach) << label(spec);
      const Vector3d force = shape->wall_force(x);
      EXPECT_EQ(reach > 1.0 + 1e-9, force.norm() > 1e-9) << label(spec) << " at " << x.transpose();
      if (reach > 1.0) { // back towards the solid
        EXPECT_LT(shape->reach(x + 1e-3 * force), reach) << label(spec);
      }
    }
  }
}

TEST(Shapes, NearestPointOfAnEllipsoidIsOnItAndAlongTheNormal) {
  const Vector3d a(3.0, 4.5, 7.0);
  Random random(8);
  for (int n = 0; n < 200; ++n) {
    const Vector3d x = 3.0 * random.vector(1.0).cwiseProduct(a);
    if (x.cwiseQuotient(a).norm() <= 1.0) {
      continue;
    }
    const Vector3d p = nearest_on_ellipsoid(a, x), normal = p.cwiseQuotient(a.cwiseAbs2()).normalized();
    EXPECT_NEAR(p.cwiseQuotient(a).norm(), 1.0, 1e-12);
    EXPECT_NEAR((x - p).normalized().dot(normal), 1.0, 1e-12);
  }
}

TEST(Shapes, RoundedCubeIsABoxWithinABall) {
  // Half edge h of the cube; the core has 0.7 h, the ball 0.3 h. Its distance is known coordinate by coordinate.
  const double h = 5.0, core = 0.7 * h, ball = 0.3 * h;
  const auto shape = solid(polyhedron("cube", std::sqrt(3.0) * h, 0.3));
  EXPECT_NEAR((shape->half_lengths() - Vector3d::Constant(h)).norm(), 0.0, 1e-12);
  Random random(4);
  for (int n = 0; n < 500; ++n) {
    const Vector3d x = 10.0 * random.vector(1.0);
    const Vector3d beyond = x - x.cwiseMax(-core).cwiseMin(core);
    const double overlap = beyond.norm() - ball;
    const Vector3d force = overlap > 0.0 ? Vector3d(-overlap * beyond.normalized()) : Vector3d(Vector3d::Zero());
    EXPECT_NEAR((shape->wall_force(x) - force).norm(), 0.0, 1e-12);
    EXPECT_EQ(shape->reach(x) > 1.0, overlap > 0.0);
  }
}

/// Second moments <x x> of the solid, by closed forms.
TEST(Shapes, TemplatesHaveTheMomentsOfTheirShape) {
  struct Case {
    TemplateSpec spec;
    Vector3d moments; ///< over those of the shape with the size as given
  };
  const double c = 4.0, r = 3.0; // capsule: half axis and radius
  const double v_rod = 2.0 * c * r * r, v_ball = 4.0 / 3.0 * r * r * r, v = v_rod + v_ball;
  const double zz = (v_rod * c * c / 3.0 + v_ball * (c * c + 2.0 * c * 3.0 / 8.0 * r + r * r / 5.0)) / v;
  const double xx = (v_rod * r * r / 4.0 + v_ball * r * r / 5.0) / v;
  const double edge = 8.0 * std::sqrt(2.0); // of the octahedron: second moment a^2 / 20 along each axis
  const std::vector<Case> cases = {{{.shape = ShapeName::ellipsoid, .size = {8, 12, 18}}, Vector3d(16, 36, 81) / 5.0},
                                   {{.shape = ShapeName::capsule, .radius = r, .height = 14.0}, {xx, xx, zz}},
                                   {polyhedron("cube", 8.0), Vector3d::Constant(64.0 / 3.0 / 3.0)},
                                   {polyhedron("octahedron", 8.0), Vector3d::Constant(edge * edge / 20.0)}};
  for (const Case& test : cases) {
    const int n_nodes = 700;
    TemplateSpec spec = test.spec;
    spec.n_nodes = n_nodes;
    const GrainTemplate grain = build_template(spec);
    ASSERT_EQ(grain.n_nodes(), n_nodes);
    const double scale = std::cbrt(n_nodes / spec.density / nominal_volume(test.spec));
    Vector3d measured = Vector3d::Zero();
    for (const Vector3d& x : grain.position) {
      measured += x.cwiseAbs2() / n_nodes;
    }
    const Vector3d expected = scale * scale * test.moments;
    for (int axis = 0; axis < 3; ++axis) {
      // A half length off by a tenth of a node's diameter is what the random places of 700 nodes allow.
      EXPECT_NEAR(std::sqrt(measured[axis]), std::sqrt(expected[axis]), 0.1) << label(spec) << " axis " << axis;
    }
  }
}

TEST(Shapes, WalledGrainsFillTheirOutline) {
  for (TemplateSpec spec : all_shapes()) {
    if (!(spec.shape == ShapeName::polyhedron && spec.rounding > 0.0) && spec.shape != ShapeName::capsule &&
        spec.shape != ShapeName::ellipsoid && spec.shape != ShapeName::superellipsoid) {
      continue;
    }
    spec.surface = TemplateSpec::Surface::wall;
    spec.n_nodes = 200;
    const GrainTemplate grain = build_template(spec);
    ASSERT_EQ(grain.n_nodes(), 200);
    const double volume = 200 / (1.41 * spec.density / bulk_node_density);
    const auto outline = shape_kind(spec.shape).make(spec, std::cbrt(volume / nominal_volume(spec)));
    double farthest = 0.0;
    for (const Vector3d& x : grain.position) {
      farthest = std::max(farthest, outline->wall_force(x).norm());
    }
    EXPECT_LT(farthest, 0.35) << label(spec); // about the wall, which is soft; nodes are centred after it
  }
}

TEST(Shapes, SayWhatIsWrong) {
  TemplateSpec flat{.shape = ShapeName::polyhedron, .vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {9, 9, 0}}};
  EXPECT_NE(complaint(flat).find("one plane"), std::string::npos);
  flat.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}, {2, 2, 2}};
  EXPECT_NE(complaint(flat).find("vertices[4] is no corner"), std::string::npos);
  flat.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}};
  EXPECT_NE(complaint(flat).find("3 points"), std::string::npos);
  flat.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 0.5}};
  EXPECT_NE(complaint(flat).find("width"), std::string::npos);
  EXPECT_NE(complaint(polyhedron("cube", 6.0, 0.95)).find("rounding = 0.95"), std::string::npos);
  EXPECT_NE(complaint({.shape = ShapeName::polyhedron, .polyhedron = "cub"}).find("not one of tetrahedron"),
            std::string::npos);
  EXPECT_NE(complaint(superellipsoid(0.5, 2.0)).find("exponent = 0.5"), std::string::npos);
  EXPECT_NE(complaint({.shape = ShapeName::capsule, .radius = 4.0, .height = 7.0}).find("height = 7"),
            std::string::npos);
  EXPECT_NE(complaint({.shape = ShapeName::mesh}).find("has not been read"), std::string::npos);
  EXPECT_NE(complaint({.shape = ShapeName::ellipsoid, .size = {1, 20, 20}, .n_nodes = 30}).find("size[0]"),
            std::string::npos);
}

} // namespace
} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes as shapes: a torus and a sphere of triangles against their closed forms, all formats, and broken files.
#include "bpm/grain/build_template.h"
#include "bpm/grain/random.h"
#include "bpm/mesh/closed_mesh.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>

namespace boba {
namespace {

using Eigen::Vector3d;
using ShapeName = TemplateSpec::Shape;

/// n x m quadrilaterals round a torus, each in two triangles.
TriangleMesh torus(double ring, double tube, int n, int m) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double u = 2.0 * M_PI * i / n, v = 2.0 * M_PI * j / m, rho = ring + tube * std::cos(v);
      mesh.points.emplace_back(rho * std::cos(u), rho * std::sin(u), tube * std::sin(v));
      const int here = i * m + j, along = (i + 1) % n * m + j, across = i * m + (j + 1) % m,
                both = (i + 1) % n * m + (j + 1) % m;
      mesh.triangles.push_back({here, along, both});
      mesh.triangles.push_back({here, both, across});
    }
  }
  return mesh;
}

/// An octahedron whose triangles are cut in four `cuts` times, its points on the unit sphere.
TriangleMesh sphere(int cuts) {
  TriangleMesh mesh = {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                       {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.points.size()));
      if (is_new) {
        mesh.points.push_back((mesh.points[a] + mesh.points[b]).normalized());
      }
      return at->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  return mesh;
}

TEST(ClosedMesh, TorusIsInsideWhereItsFormulaSays) {
  const double ring = 6.0, tube = 2.0;
  const auto surface = closed_surface(torus(ring, tube, 180, 90));
  EXPECT_NEAR(surface->volume(), 2.0 * M_PI * M_PI * ring * tube * tube, 2e-3 * surface->volume());
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const Vector3d x = random.vector(1.0).cwiseProduct(Vector3d(9, 9, 3));
    const double exact = std::hypot(std::hypot(x.x(), x.y()) - ring, x.z()) - tube;
    EXPECT_NEAR(surface->signed_distance(x), exact, 0.01) << x.transpose();
    EXPECT_NEAR((surface->nearest(x) - x).norm(), std::abs(surface->signed_distance(x)), 1e-12);
  }
}

TEST(ClosedMesh, SphereOfTrianglesMakesTheGrainsOfASphere) {
  TemplateSpec spec{.shape = ShapeName::mesh, .mesh = closed_surface(sphere(4)), .n_nodes = 700};
  const GrainTemplate grain = build_template(spec);
  ASSERT_EQ(grain.n_nodes(), 700);
  double squares = 0.0;
  for (const Vector3d& x : grain.position) {
    squares += x.squaredNorm() / 700.0;
  }
  const double radius = std::cbrt(700.0 / spec.density * 3.0 / (4.0 * M_PI));
  EXPECT_NEAR(std::sqrt(squares), std::sqrt(0.6) * radius, 0.05);
  const GrainTemplate ideal = build_template({.n_nodes = 700});
  EXPECT_NEAR(static_cast<double>(grain.bonds.size()), static_cast<double>(ideal.bonds.size()),
              0.02 * static_cast<double>(ideal.bonds.size()));
  // Without a number of nodes: the scale is the radius.
  const TemplateSpec scaled{.shape = ShapeName::mesh, .mesh = spec.mesh, .scale = 5.0};
  EXPECT_NEAR(build_template(scaled).n_nodes(), scaled.density * 4.0 / 3.0 * M_PI * 125.0, 25.0);
}

TEST(ClosedMesh, ConcaveGrainsKeepTheirHole) {
  const TemplateSpec spec{.shape = ShapeName::mesh, .mesh = closed_surface(torus(6.0, 2.5, 60, 30)), .n_nodes = 700};
  const GrainTemplate grain = build_template(spec);
  double least = 1e9;
  for (const Vector3d& x : grain.position) {
    least = std::min(least, std::hypot(x.x(), x.y()));
  }
  const double scale = std::cbrt(700 / spec.density / nominal_volume(spec));
  EXPECT_NEAR(least, 3.5 * scale, 0.5);
}

std::string off(const TriangleMesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.points.size(), mesh.triangles.size());
  for (const Vector3d& p : mesh.points) {
    text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : mesh.triangles) {
    text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  }
  return text;
}

std::string stl(const TriangleMesh& mesh) {
  std::string text = "solid body\n";
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : t) {
      const Vector3d& p = mesh.points[corner];
      text += fmt::format("vertex {} {} {}\n", p.x(), p.y(), p.z());
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid body\n";
}

std::string obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Vector3d& p : mesh.points) {
    text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

std::string ply(const TriangleMesh& mesh) {
  std::string text = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
                                 "property double z\nelement face {}\nproperty list uchar int vertex_indices\n"
                                 "end_header\n",
                                 mesh.points.size(), mesh.triangles.size());
  for (const Vector3d& p : mesh.points) {
    text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : mesh.triangles) {
    text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  }
  return text;
}

class MeshFiles : public ::testing::Test {
protected:
  /// What is said of a file; "" where it makes a solid.
  std::string complaint(const std::string& name, const std::string& text) {
    try {
      closed_surface(read_triangle_mesh(folder_.file(name, text)));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_F(MeshFiles, AllFormatsHoldTheSameSolid) {
  const TriangleMesh mesh = sphere(2);
  const double volume = closed_surface(mesh)->volume();
  for (const auto& [name, text] : {std::pair{"a.off", off(mesh)}, std::pair{"a.stl", stl(mesh)},
                                   std::pair{"a.obj", obj(mesh)}, std::pair{"a.ply", ply(mesh)}}) {
    const TriangleMesh read = read_triangle_mesh(folder_.file(name, text));
    EXPECT_EQ(read.points.size(), mesh.points.size()) << name;
    EXPECT_EQ(read.triangles.size(), mesh.triangles.size()) << name;
    EXPECT_NEAR(closed_surface(read)->volume(), volume, 1e-4 * volume) << name;
  }
}

TEST_F(MeshFiles, BrokenOnesAreToldInOneSentence) {
  const TriangleMesh good = sphere(1);
  TriangleMesh open = good, flipped = good, inside_out = good, crossing = good, single = good;
  open.triangles.pop_back();
  std::swap(flipped.triangles[3][0], flipped.triangles[3][1]);
  for (auto& t : inside_out.triangles) {
    std::swap(t[0], t[1]);
  }
  for (const Vector3d& p : good.points) { // a second one that cuts the first
    crossing.points.push_back(p + Vector3d(0.9, 0.1, 0.05));
  }
  for (const auto& t : good.triangles) {
    const int shift = static_cast<int>(good.points.size());
    crossing.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  single.triangles.resize(1);
  const std::string digits(5000, '9');
  const std::vector<std::array<std::string, 3>> cases = {
      {"open.off", off(open), "not closed"},
      {"flipped.off", off(flipped), "not oriented"},
      {"out.off", off(inside_out), "inside out"},
      {"crossing.off", off(crossing), "cuts itself"},
      {"single.off", off(single), "1 triangles"},
      {"empty.off", "", "cannot be read"},
      {"empty.stl", "", "cannot be read"},
      {"text.stl", "hello", "cannot be read"},
      {"mesh.vtk", "", "ends in none of"},
      {"many.off", "OFF\n4000000000 4000000000 0\n", "announces"},
      {"many.ply", "ply\nformat ascii 1.0\nelement vertex 9000000000\nend_header\n", "announces"},
      {"binary.stl", std::string(80, 'x') + "\xff\xff\xff\x7f", "cannot be read"},
      {"corner.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 77\n", ""},
      {"far.off", "OFF\n4 4 0\n0 0 0\n1e300 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n", "coordinate"},
      {"nan.off", "OFF\n4 4 0\nnan 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n", ""},
      {"digits.off", "OFF\n" + digits + " 4 0\n", ""}};
  for (const auto& [name, text, words] : cases) {
    const std::string said = complaint(name, text);
    EXPECT_FALSE(said.empty()) << name;
    EXPECT_NE(said.find(words), std::string::npos) << name << ": " << said;
    EXPECT_LT(said.size(), 300u) << name;
  }
  EXPECT_EQ(complaint("good.off", off(good)), "");
}

TEST_F(MeshFiles, AMillionTrianglesAreRefused) {
  EXPECT_NE(complaint("many.obj", obj(torus(6.0, 2.0, 500, 250))).find("200000"), std::string::npos);
}

} // namespace
} // namespace boba

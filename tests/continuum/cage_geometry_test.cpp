// SPDX-License-Identifier: GPL-3.0-or-later
// Cages, their cells, the planes that hold a node, hull and laws in three dimensions; no finite elements.
#include "continuum/cage/cage_state.h"
#include "continuum/cage/cell.h"
#include "continuum/cage/hull.h"
#include "continuum/cage/lattice.h"
#include "continuum/cage/surface_node.h"
#include "continuum/elasticity/hyperelastic.h"

#include <Eigen/Dense>
#include <fstream>
#include <gtest/gtest.h>
#include <random>

namespace boba::continuum::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(Cage, CellsOfTheLatticesHaveTheirVolumes) {
  const double h = 0.7;
  const Cell sc = cell_of(lattice_planes("sc", h)), fcc = cell_of(lattice_planes("fcc", h)),
             bcc = cell_of(lattice_planes("bcc", h));
  EXPECT_EQ(sc.face_areas.size(), 6u);
  EXPECT_EQ(fcc.face_areas.size(), 12u);
  EXPECT_EQ(bcc.face_areas.size(), 14u);
  const double a = 4 * h / std::sqrt(3.0);
  EXPECT_NEAR(sc.volume / (8 * h * h * h), 1, 1e-12);
  EXPECT_NEAR(fcc.volume / (4 * std::sqrt(2.0) * h * h * h), 1, 1e-12);
  EXPECT_NEAR(bcc.volume / (a * a * a / 2), 1, 1e-12);
  for (const double area : fcc.face_areas) {
    EXPECT_NEAR(area / (std::sqrt(2.0) * h * h), 1, 1e-12);
  }
  // Truncated octahedron of edge a / (2 sqrt 2): hexagons and squares.
  EXPECT_NEAR(bcc.area() / (6 * (1 + 2 * std::sqrt(3.0)) * a * a / 8), 1, 1e-12);
}

TEST(Cage, PressureIsTheForceOverTheFacesArea) {
  for (const std::string lattice : {"sc", "fcc"}) {
    const auto planes = lattice_planes(lattice, 0.8);
    const Cell cell = cell_of(planes);
    CageState state;
    for (const Plane& plane : octant_planes(planes)) {
      state.patches.push_back({plane.normal, plane.distance, 0.3});
    }
    EXPECT_NEAR(state.pressure_on_faces(cell.volume), 0.3 / cell.face_areas[0], 1e-12) << lattice;
  }
  const auto planes = lattice_planes("bcc", 0.8);
  CageState state;
  for (const Plane& plane : octant_planes(planes)) {
    state.patches.push_back({plane.normal, plane.distance, plane.normal.maxCoeff() > 0.99 ? 0.1 : 0.4});
  }
  const double h1 = 0.8, h2 = 1.6 / std::sqrt(3.0), volume = cell_of(planes).volume;
  EXPECT_NEAR(state.pressure_on_faces(volume), (8 * 0.4 * h1 + 6 * 0.1 * h2) / (3 * volume), 1e-12);
}

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Cage, BadPlanesAreToldInASentence) {
  auto open = lattice_planes("sc", 1);
  open.pop_back();
  EXPECT_NE(message_of([&] { cell_of(open); }).find("the cage is open"), std::string::npos);
  EXPECT_NE(message_of([&] { check_mirrors(open); }).find("has no mirror image in x = 0"), std::string::npos);
  auto hidden = lattice_planes("sc", 1);
  hidden.push_back({Vector3d(1, 1, 1).normalized(), 1.8});
  EXPECT_NE(message_of([&] { cell_of(hidden); }).find("lies behind others"), std::string::npos);
  auto twice = lattice_planes("sc", 1);
  twice.push_back(twice.front());
  EXPECT_NE(message_of([&] { cell_of(twice); }).find("lies behind others"), std::string::npos);
  EXPECT_NE(message_of([] { lattice_planes("hcp", 1); }).find("lattice = hcp is not allowed"), std::string::npos);
}

TEST(Cage, PlanesAreReadFromAFileAndTouchTheSphere) {
  const std::string file = ::testing::TempDir() + "boba_planes.txt";
  std::ofstream(file) << "# a box\n2 0 0  3\n-1 0 0 3\n0 1 0 4\n0 -1 0 4\n\n0 0 1 6\n0 0 -1 6\n";
  const auto planes = read_planes(file, 0.5);
  ASSERT_EQ(planes.size(), 6u);
  EXPECT_NEAR(cell_of(planes).volume, 8 * 0.5 * (4.0 / 6) * 1.0, 1e-12);
  for (const auto& [line, what] : {std::pair{"1 0 0", "must be four numbers"},
                                   {"0 0 0 1", "length > 0"},
                                   {"1 0 0 -2", "distance = -2 is not allowed"},
                                   {"1 0 0 1 7", "must be four numbers"}}) {
    std::ofstream(file) << line << "\n";
    const std::string message = message_of([&] { read_planes(file, 1); });
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_NE(message.find("line 1"), std::string::npos) << message;
  }
}

TEST(Cage, HullOfAMirroredCornerIsABox) {
  const HullMeasures hull = hull_of_mirrored({{1, 2, 3}, {0.5, 0, 1}, {0, 2, 3}});
  EXPECT_NEAR(hull.volume, 48, 1e-12);
  EXPECT_NEAR(hull.surface, 88, 1e-12);
}

/// Two nodes, one on the mirror x = 0, coupled by a random stiffness, under forces that push them through the planes.
struct TwoNodes {
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd load;
  std::vector<SurfaceNode> nodes{2};

  explicit TwoNodes(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto draw = [&] { return normal(random); };
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(6, 6, draw);
    stiffness = root * root.transpose() + 2 * Eigen::MatrixXd::Identity(6, 6);
    load = 3 * Eigen::VectorXd::NullaryExpr(6, draw) + Eigen::VectorXd::Constant(6, 3);
    nodes[0].place = Vector3d(0.5, 0.6, 0.6);
    nodes[1].place = Vector3d(0, 0.8, 0.6);
    nodes[1].row = 3;
    nodes[1].mirrored[0] = true;
    stiffness.row(3).setZero();
    stiffness.col(3).setZero();
    stiffness(3, 3) = 1;
    load[3] = 0;
  }
  /// Displacement with the planes that hold each node: the turned system with its held unknowns.
  Eigen::VectorXd solved(const std::vector<Plane>& planes) const {
    Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(6, 6);
    std::vector<std::pair<Eigen::Index, double>> held;
    for (const SurfaceNode& node : nodes) {
      const NodeFrame frame = frame_of(node, planes);
      EXPECT_NEAR((frame.basis.transpose() * frame.basis - Matrix3d::Identity()).norm(), 0, 1e-12);
      turn.block<3, 3>(node.row, node.row) = frame.basis;
      const auto values = held_displacements(node, frame, planes);
      for (std::size_t k = 0; k < values.size(); ++k) {
        held.emplace_back(node.row + frame.column[k], values[k]);
      }
    }
    Eigen::MatrixXd k = turn.transpose() * stiffness * turn;
    Eigen::VectorXd b = turn.transpose() * load;
    for (const auto& [row, value] : held) {
      b -= k.col(row) * value;
      k.row(row).setZero();
      k.col(row).setZero();
      k(row, row) = 1;
      b[row] = value;
    }
    for (const auto& [row, value] : held) {
      b[row] = value;
    }
    return turn * k.ldlt().solve(b);
  }
};

/// The constrained minimum by trying all sets of held planes: the one without pull and overlap.
Eigen::VectorXd by_trying_all(const TwoNodes& body, const std::vector<Plane>& planes) {
  const auto n = int(planes.size());
  for (int set = 0; set < 1 << (2 * n); ++set) {
    Eigen::MatrixXd normals(6, 0);
    Eigen::VectorXd bound(0);
    for (int c = 0; c < 2 * n; ++c) {
      if (set >> c & 1) {
        Eigen::VectorXd column = Eigen::VectorXd::Zero(6);
        const SurfaceNode& node = body.nodes[std::size_t(c / n)];
        column.segment<3>(node.row) = planes[std::size_t(c % n)].normal;
        column[3] = 0;
        normals.conservativeResize(6, normals.cols() + 1);
        normals.col(normals.cols() - 1) = column;
        bound.conservativeResize(bound.size() + 1);
        bound[bound.size() - 1] =
            planes[std::size_t(c % n)].distance - planes[std::size_t(c % n)].normal.dot(node.place);
      }
    }
    const Eigen::Index m = normals.cols();
    if (m > 0 && normals.fullPivLu().rank() < m) {
      continue;
    }
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(6 + m, 6 + m);
    whole << body.stiffness, normals, normals.transpose(), Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd rhs(6 + m);
    rhs << body.load, bound;
    const Eigen::VectorXd x = whole.fullPivLu().solve(rhs);
    bool right = m == 0 || x.tail(m).minCoeff() >= -1e-10;
    for (const SurfaceNode& node : body.nodes) {
      for (const Plane& plane : planes) {
        right &= plane.normal.dot(node.place + x.segment<3>(node.row)) <= plane.distance + 1e-10;
      }
    }
    if (right) {
      return x.head(6);
    }
  }
  ADD_FAILURE() << "no set of planes is a solution";
  return Eigen::VectorXd::Zero(6);
}

TEST(Cage, ActiveSetFindsTheConstrainedMinimum) {
  int corners = 0;
  for (const std::string lattice : {"sc", "fcc", "bcc"}) {
    const auto planes = octant_planes(lattice_planes(lattice, 0.9));
    for (unsigned seed = 0; seed < 40; ++seed) {
      TwoNodes body(seed);
      Eigen::VectorXd u;
      Contradiction left{1};
      for (int step = 0; step < 60 && left.changes > 0; ++step) {
        u = body.solved(planes);
        const Eigen::VectorXd pressing = body.load - body.stiffness * u;
        left = {};
        for (SurfaceNode& node : body.nodes) {
          left += update_planes(node, planes, u.segment<3>(node.row), pressing.segment<3>(node.row), {0, 1e-11, 1e-11});
        }
        corners += left.changes == 0 && body.nodes[0].held.size() == 3;
      }
      EXPECT_EQ(left.changes, 0) << lattice << ", seed " << seed;
      EXPECT_LT((u - by_trying_all(body, planes)).norm(), 1e-8) << lattice << ", seed " << seed;
      // The forces of the planes add up to the force on the node.
      const SurfaceNode& node = body.nodes[0];
      Vector3d force = (body.load - body.stiffness * u).head<3>();
      const auto forces = plane_forces(node, frame_of(node, planes), force);
      for (std::size_t k = 0; k < forces.size(); ++k) {
        force -= forces[k] * planes[std::size_t(node.held[k])].normal;
      }
      EXPECT_LT(force.norm(), 1e-9);
    }
  }
  EXPECT_GT(corners, 0);
}

TEST(Cage, PlanesThatMeetANodeAlikeShareItsForce) {
  const auto planes = octant_planes(lattice_planes("fcc", 0.9));
  SurfaceNode node;
  node.place = Vector3d(1, 0, 0);
  node.mirrored = {false, true, true};
  const Vector3d u(0.9 * std::sqrt(2.0) - 1, 0, 0);
  update_planes(node, planes, Vector3d(0.5, 0, 0), Vector3d::Zero(), {});
  ASSERT_EQ(node.held.size(), 1u);
  const Eigen::VectorXd shares = shared_forces(node, planes, u, Vector3d(0.2, 0, 0));
  EXPECT_NEAR(shares.sum(), 0.2 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(shares.maxCoeff(), 0.1 * std::sqrt(2.0), 1e-12);
}

TEST(SolidLaw, StressIsTheSlopeOfTheEnergyAndTangentThatOfTheStress) {
  const NeoHookean neo_hookean({1.3, 0.3});
  const Foam foam({{0.4, 6, -0.4}, {0.3, -2, 0.2}}), with_zero({{0.5, 3, 0}});
  const HyperelasticLaw* laws[] = {&neo_hookean, &foam, &with_zero};
  Matrix3d f;
  f << 0.8, 0.1, -0.05, 0.02, 1.1, 0.07, -0.03, 0.04, 0.9;
  for (const HyperelasticLaw* law : laws) {
    EXPECT_NEAR(law->solid(Matrix3d::Identity()).energy, 0, 1e-15);
    EXPECT_NEAR(law->solid(Matrix3d::Identity()).stress.norm(), 0, 1e-15);
    const SolidResponse at = law->solid(f);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double step = 1e-5;
        Matrix3d up = f, down = f;
        up(i, j) += step;
        down(i, j) -= step;
        const SolidResponse a = law->solid(up), b = law->solid(down);
        EXPECT_NEAR((a.energy - b.energy) / (2 * step), at.stress(i, j), 1e-8);
        const Matrix3d slope = (a.stress - b.stress) / (2 * step);
        for (int k = 0; k < 3; ++k) {
          for (int l = 0; l < 3; ++l) {
            EXPECT_NEAR(slope(k, l), at.tangent(3 * k + l, 3 * i + j), 1e-7);
          }
        }
      }
    }
  }
}

} // namespace
} // namespace boba::continuum::testing

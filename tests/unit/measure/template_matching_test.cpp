// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/bond_order.h"
#include "bpm/measure/template_matching.h"
#include "tests/support/crystals.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <stdexcept>

namespace {

using namespace boba;
using namespace boba::measure;
using crystals::Crystal;

/// An infinite lattice: cell vectors as columns, sites in d.
struct Structure {
  Lattice lattice;
  Matrix3 cell;
  std::vector<Vector3> sites;
};

Matrix3 columns(const Vector3& a, const Vector3& b, const Vector3& c) {
  return (Matrix3() << a, b, c).finished();
}

const Structure fcc = {Lattice::fcc, columns({0, 1, 1}, {1, 0, 1}, {1, 1, 0}) / std::sqrt(2.0), {Vector3::Zero()}};
const Structure bcc = {Lattice::bcc, columns({-1, 1, 1}, {1, -1, 1}, {1, 1, -1}) / std::sqrt(3.0), {Vector3::Zero()}};
const Structure sc = {Lattice::sc, Matrix3::Identity(), {Vector3::Zero()}};
const Matrix3 hexagonal = columns({1, 0, 0}, {-0.5, std::sqrt(3.0) / 2.0, 0}, {0, 0, std::sqrt(8.0 / 3.0)});
const Structure hcp = {Lattice::hcp, hexagonal, {Vector3::Zero(), hexagonal* Vector3(2. / 3., 1. / 3., 0.5)}};

/// Neighbours of the first site, mapped by `f`, nearest first.
std::vector<Neighbour> neighbours_of(const Structure& structure, const Matrix3& f) {
  std::vector<Neighbour> found;
  for (int k = 0; k < 343; ++k) {
    const Vector3 cell = Eigen::Vector3i(k % 7 - 3, k / 7 % 7 - 3, k / 49 - 3).cast<double>();
    for (const Vector3& site : structure.sites) {
      const Vector3 x = f * (structure.cell * cell + site);
      if (x.norm() > 1e-9) {
        found.push_back({1, x, 1.0});
      }
    }
  }
  std::sort(found.begin(), found.end(),
            [](const Neighbour& a, const Neighbour& b) { return a.vector.norm() < b.vector.norm(); });
  found.resize(14);
  return found;
}

/// Directions with whole components up to 2 in size, one of each pair of opposite ones.
std::vector<Vector3> directions() {
  std::vector<Vector3> found;
  for (int k = 0; k < 125; ++k) {
    const Eigen::Vector3i v(k % 5 - 2, k / 5 % 5 - 2, k / 25 - 2);
    const bool primitive = std::gcd(std::gcd(v[0], v[1]), v[2]) == 1;
    if (primitive && (v[2] > 0 || (v[2] == 0 && (v[1] > 0 || (v[1] == 0 && v[0] > 0))))) {
      found.push_back(v.cast<double>());
    }
  }
  return found;
}

/// Slip systems with small indices: plane normal and direction in it, unit vectors. Of cubic lattices (hkl)<uvw> with
/// indices up to 2: {111}<11-2>, {111}<1-10>, {001}<100>, {001}<110>, {110}<1-10>, {110}<001>, {112}<111>, {012}<100>
/// and all others; of hcp the planes and directions of its own cell.
std::vector<std::array<Vector3, 2>> slip_systems(const Structure& structure) {
  const Matrix3 cell = structure.lattice == Lattice::hcp ? structure.cell : Matrix3::Identity();
  std::vector<std::array<Vector3, 2>> systems;
  for (const Vector3& plane : directions()) {
    for (const Vector3& along : directions()) {
      if (plane.dot(along) == 0.0) {
        systems.push_back({(cell.inverse().transpose() * plane).normalized(), (cell * along).normalized()});
      }
    }
  }
  return systems;
}

class StrainedLattice : public testing::TestWithParam<Structure> {};

TEST_P(StrainedLattice, IsToldRightOrUnknownAlongEverySlipSystem) {
  const Structure& structure = GetParam();
  const Matrix3 turn = shapes::some_rotation();
  const auto systems = slip_systems(structure);
  EXPECT_GT(systems.size(), 200U);
  int wrong = 0, missed = 0;
  double largest_error = 0.0;
  for (const auto& [normal, along] : systems) {
    for (int step = -10; step <= 10; ++step) {
      const double shear = 0.04 * step;
      const Matrix3 f = Matrix3::Identity() + shear * along * normal.transpose();
      const TemplateMatch match = match_templates(neighbours_of(structure, turn * f));
      wrong += match.lattice != Lattice::unknown && match.lattice != structure.lattice;
      if (std::abs(shear) < 0.15) {
        missed += match.lattice != structure.lattice;
        // A simple shear stretches by exp(+-asinh(shear / 2)).
        largest_error = std::max(largest_error, std::abs(match.shear - 2.0 * std::asinh(std::abs(shear) / 2.0)));
      }
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(missed, 0);
  EXPECT_LT(largest_error, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Lattices, StrainedLattice, testing::Values(fcc, hcp, bcc, sc),
                         [](const auto& shape) { return std::string(name_of(shape.param.lattice)); });

TEST(Templates, PathFromFccToBccHasBothEndsAndNoMiddle) {
  // Bain: bcc is fcc with one cube axis shortened by 2^(1/3) and the others longer by 2^(1/6).
  const double whole = std::log(2.0) / 6.0;
  for (const double part : {0.0, 0.3, 0.5, 0.7, 1.0}) {
    const Vector3 stretch(std::exp(part * whole), std::exp(part * whole), std::exp(-2.0 * part * whole));
    const TemplateMatch match = match_templates(neighbours_of(fcc, shapes::some_rotation() * stretch.asDiagonal()));
    const double from_end = std::min(part, 1.0 - part);
    EXPECT_NEAR(match.shear, std::sqrt(12.0) * whole * from_end, 1e-9);
    EXPECT_EQ(match.lattice, from_end > 0.4 ? Lattice::unknown : part < 0.5 ? Lattice::fcc : Lattice::bcc) << part;
    EXPECT_EQ(match.rmsd < 1e-7, from_end == 0.0);
  }
}

void expect_all(const Crystal& crystal, Lattice lattice) {
  for (const TemplateMatch& match : match_templates(crystal.box, crystal.centres)) {
    EXPECT_EQ(match.lattice, lattice);
    EXPECT_NEAR(match.rmsd, 0.0, 1e-7);
    EXPECT_NEAR(match.shear, 0.0, 1e-7);
  }
}

Crystal simple_cubic(int n) {
  return crystals::repeat(Vector3::Ones(), {{0, 0, 0}}, n, n, n);
}

TEST(Templates, PerfectCrystalsInPeriodicCells) {
  expect_all(crystals::fcc(2), Lattice::fcc);
  expect_all(crystals::fcc(1), Lattice::fcc); // four grains: a grain's own copies are its second neighbours
  expect_all(crystals::tilted_fcc(3), Lattice::fcc);
  expect_all(crystals::hcp(3), Lattice::hcp);
  expect_all(crystals::bcc(3), Lattice::bcc);
  expect_all(simple_cubic(3), Lattice::sc);
}

TEST(Templates, SimpleCubicHasSolidBondsButIsNoCrystal) {
  const Crystal crystal = simple_cubic(4);
  const auto orders = bond_order(solid_angle_neighbours(crystal.box, crystal.centres));
  EXPECT_GE(orders.front().n_solid_bonds, 7); // why the rule by bond order takes it for one
  const auto counts = count_lattices(match_templates(crystal.box, crystal.centres));
  EXPECT_EQ(counts[static_cast<std::size_t>(Lattice::sc)], 64);
}

TEST(Templates, IcosahedronIsNamed) {
  std::vector<Neighbour> neighbours;
  for (const Vector3& x : shapes::moved(crystals::icosahedron(), shapes::some_rotation(), Vector3::Zero())) {
    neighbours.push_back({1, x, 1.0});
  }
  EXPECT_EQ(match_templates(neighbours).lattice, Lattice::icosahedral);
}

TEST(Templates, GrainAmongItsOwnCopiesIsUnknown) {
  // One grain in the primitive cell of fcc, two in the cubic cell of bcc: only copies, or copies among the neighbours.
  for (const Crystal& crystal : {crystals::tilted_fcc(1), crystals::bcc(1), simple_cubic(1)}) {
    for (const TemplateMatch& match : match_templates(crystal.box, crystal.centres)) {
      EXPECT_EQ(match.lattice, Lattice::unknown);
    }
    for (const BondOrder& order : bond_order(solid_angle_neighbours(crystal.box, crystal.centres))) {
      EXPECT_EQ(order.crystal, CrystalClass::unknown);
      EXPECT_LE(order.n_solid_bonds, 8);
    }
  }
  const Crystal one = crystals::tilted_fcc(1);
  EXPECT_EQ(bond_order(solid_angle_neighbours(one.box, one.centres)).front().n_solid_bonds, 0);
}

TEST(Templates, ShakenCrystalsKeepTheirLattice) {
  constexpr double sigma = 0.05; // of the neighbour distance, in each direction
  const auto expect = [](const Crystal& crystal, Lattice lattice) {
    const auto counts = count_lattices(match_templates(crystal.box, crystal.centres));
    const auto n = static_cast<double>(crystal.centres.size());
    EXPECT_GT(counts[static_cast<std::size_t>(lattice)] / n, 0.95);
    EXPECT_EQ(counts[static_cast<std::size_t>(lattice)] + counts[0], static_cast<int>(crystal.centres.size()));
  };
  expect(crystals::shaken(crystals::fcc(6), sigma, 1), Lattice::fcc);
  expect(crystals::shaken(crystals::hcp(6), sigma, 2), Lattice::hcp);
  expect(crystals::shaken(crystals::bcc(7), sigma, 3), Lattice::bcc);
}

/// Soft spheres at random, moved downhill until nearly no overlap is left: a dense disordered packing.
Crystal amorphous(int n, double packing_fraction, unsigned seed) {
  Crystal crystal = crystals::gas(n, packing_fraction * 6.0 / std::numbers::pi, seed);
  for (int step = 0; step < 300; ++step) {
    std::vector<Vector3> force(crystal.centres.size(), Vector3::Zero());
    for (std::size_t i = 0; i < crystal.centres.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Vector3 between = crystal.box.minimum_image(crystal.centres[i] - crystal.centres[j]);
        const double r = between.norm();
        if (r < 1.0) {
          force[i] += (1.0 - r) / r * between;
          force[j] -= (1.0 - r) / r * between;
        }
      }
    }
    for (std::size_t i = 0; i < crystal.centres.size(); ++i) {
      crystal.centres[i] += 0.3 * force[i];
    }
  }
  return crystal;
}

TEST(Templates, GasAndDensePackingAreNoCrystals) {
  const auto crystal_share = [](const Crystal& crystal) {
    const auto counts = count_lattices(match_templates(crystal.box, crystal.centres));
    return (counts[1] + counts[2] + counts[3]) / static_cast<double>(crystal.centres.size());
  };
  EXPECT_LT(crystal_share(crystals::gas(1000, 1.0, 4)), 0.005);
  EXPECT_LT(crystal_share(amorphous(500, 0.64, 5)), 0.02);
  EXPECT_LT(crystal_share(amorphous(500, 0.55, 6)), 0.02);
}

TEST(Templates, DeviationIsTheSmallestOfAllAssignments) {
  // Six neighbours have 720 assignments, each fitted by Eigen's umeyama.
  std::mt19937_64 generator(7);
  std::normal_distribution<double> move(0.0, 0.12);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Neighbour> neighbours;
    for (int k = 0; k < 6; ++k) {
      const Vector3 site = (k % 2 ? -1.0 : 1.0) * Vector3::Unit(k / 2);
      neighbours.push_back(
          {1, 3.0 * (shapes::some_rotation() * site + Vector3(move(generator), move(generator), move(generator))),
           1.0});
    }
    Eigen::Matrix<double, 3, 7> data = Eigen::Matrix<double, 3, 7>::Zero(), sites = data;
    for (int k = 0; k < 6; ++k) {
      data.col(k) = neighbours[static_cast<std::size_t>(k)].vector;
    }
    std::array<int, 6> order = {0, 1, 2, 3, 4, 5};
    double least = 1e300;
    do {
      for (int k = 0; k < 6; ++k) {
        sites.col(k) = (order[static_cast<std::size_t>(k)] % 2 ? -1.0 : 1.0) *
                       Vector3::Unit(order[static_cast<std::size_t>(k)] / 2);
      }
      const Eigen::Matrix4d map = Eigen::umeyama(data, sites, true);
      const auto rest = (map.topLeftCorner<3, 3>() * data).colwise() + map.topRightCorner<3, 1>() - sites;
      least = std::min(least, std::sqrt(rest.squaredNorm() / 7.0));
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_NEAR(match_templates(neighbours).rmsd, least, 1e-9);
  }
}

TEST(Templates, BadInputIsNamed) {
  const Crystal crystal = crystals::fcc(2);
  EXPECT_THROW(match_templates(crystal.box, crystal.centres, {.max_rmsd = 0.0}), std::invalid_argument);
  EXPECT_THROW(match_templates(crystal.box, {}), std::invalid_argument);
  EXPECT_EQ(match_templates(std::vector<Neighbour>{}).lattice, Lattice::unknown);
}

} // namespace

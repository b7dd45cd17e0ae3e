// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/simulation.h"
#include "bpm/grain/random.h"
#include "calibration/network/connected_network.h"
#include "calibration/network/network_operator.h"
#include "calibration/network/network_stiffness.h"
#include "tests/calibration/test_boxes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <memory>

namespace boba::calibration {
namespace {

std::vector<double> random_field(int n, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> u(n);
  for (double& value : u) {
    value = random.uniform(-1.0, 1.0);
  }
  return u;
}

/// The engine with one periodic template, deformed by `strain` and displaced by `u`.
Snapshot engine_state(const GrainTemplate& box, double alpha, const Matrix3& strain, const std::vector<double>& u,
                      double scale, Totals* totals = nullptr) {
  const Matrix3 deformation = Matrix3::Identity() + scale * strain;
  Matrix3 h = deformation * Matrix3(box.period->asDiagonal());
  const Box plain(-0.5 * *box.period, *box.period);
  Packing packing = make_packing(plain, {std::make_shared<GrainTemplate>(box)}, {Placement{.grain = {.alpha = alpha}}});
  packing.box.set_h(h);
  const Vector3 origin = packing.box.origin();
  for (int n = 0; n < box.n_nodes(); ++n) {
    packing.position[n] =
        origin + deformation * (packing.position[n] - origin) + scale * Eigen::Map<const Vector3>(u.data() + 3 * n);
  }
  Simulation simulation(std::move(packing), Material{}, SimulationOptions{});
  simulation.evaluate();
  if (totals != nullptr) {
    *totals = simulation.totals();
  }
  return simulation.snapshot({.velocity = false, .force = true});
}

TEST(LinearNetwork, IsTheDerivativeOfTheEnginesForces) {
  const GrainTemplate box = test_box(500);
  const LinearNetwork network(box);
  const std::vector<double> u = random_field(3 * box.n_nodes(), 7);
  std::vector<double> resisting(u.size());
  const double h = 1e-5;
  for (const double alpha : {-0.8, 0.0, 2.0, 12.0}) {
    network.multiply(u.data(), alpha, resisting.data());
    const Snapshot plus = engine_state(box, alpha, Matrix3::Zero(), u, h);
    const Snapshot minus = engine_state(box, alpha, Matrix3::Zero(), u, -h);
    double largest = 0.0, error = 0.0;
    for (int n = 0; n < box.n_nodes(); ++n) {
      const Vector3 slope = (plus.force[n] - minus.force[n]) / (2.0 * h);
      const Vector3 mine = -Eigen::Map<const Vector3>(resisting.data() + 3 * n);
      largest = std::max(largest, slope.norm());
      error = std::max(error, (slope - mine).norm());
    }
    EXPECT_GT(largest, 1.0);
    EXPECT_LT(error, 1e-6 * largest) << "alpha = " << alpha;
  }
}

TEST(LinearNetwork, AffineStiffnessIsTheDerivativeOfTheEnginesStress) {
  const GrainTemplate box = test_box(500);
  const LinearNetwork network(box);
  const std::vector<double> still(3 * box.n_nodes(), 0.0);
  const double h = 1e-5;
  for (const double alpha : {0.0, 5.0}) {
    const Stiffness c = affine_stiffness(network, alpha);
    for (const int p : {0, 5}) { // a stretch along x and a shear xy, as upper triangular cell strains
      Matrix3 strain = Matrix3::Zero();
      strain(0, p == 0 ? 0 : 1) = 1.0;
      Totals plus, minus;
      engine_state(box, alpha, strain, still, h, &plus);
      engine_state(box, alpha, strain, still, -h, &minus);
      constexpr std::array<int, 6> to_voigt{0, 1, 2, 5, 4, 3}; // xx yy zz xy xz yz -> Voigt
      for (int q = 0; q < 6; ++q) {
        EXPECT_NEAR((plus.stress[q] - minus.stress[q]) / (2.0 * h), c(to_voigt[q], p), 1e-6 * c.norm()) << q << p;
      }
    }
  }
}

TEST(LinearNetwork, AffineModuliHaveTheirClosedForms) {
  const GrainTemplate box = test_box(1372);
  const LinearNetwork network(box);
  double s1 = 0.0, s2 = 0.0;
  for (const LinearBond& bond : network.bonds()) {
    s1 += bond.r0;
    s2 += bond.r0 * bond.r0;
  }
  const double volume = box.period->prod();
  for (const double alpha : {-0.8, 0.0, 2.0, 12.0}) {
    const ElasticConstants affine = isotropic_part(affine_stiffness(network, alpha));
    EXPECT_NEAR(affine.bulk, s2 / (9.0 * volume), 1e-12 * affine.bulk) << "alpha must not move K";
    EXPECT_NEAR(affine.shear, (s2 + alpha * s1) / (15.0 * volume),
                0.03 * (s2 + std::abs(alpha) * s1) / (15.0 * volume));
  }
}

/// G of the affine field straight from the force law: every node's volume change is summed from its own list of bonds.
double affine_shear_by_nodes(const LinearNetwork& network, double alpha) {
  std::vector<std::vector<int>> bonds_of(network.n_nodes());
  for (std::size_t b = 0; b < network.bonds().size(); ++b) {
    bonds_of[network.bonds()[b].i].push_back(static_cast<int>(b));
    bonds_of[network.bonds()[b].j].push_back(static_cast<int>(b));
  }
  // 10 G = C_ijij - C_iijj / 3 and C_iijj = S2 / V for affine fields; C_ijij sums T over the nine dyads e_i e_j.
  double ijij = 0.0, iijj = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto stretch = [&](int b) {
        return network.bonds()[b].r0 * network.bonds()[b].e[i] * network.bonds()[b].e[j];
      };
      const auto volumes = [&](int node) {
        std::array<double, 2> sum{0.0, 0.0}; // V0 and its change
        for (const int b : bonds_of[node]) {
          const double r0 = network.bonds()[b].r0;
          sum[0] += r0 * r0 * r0;
          sum[1] += 3.0 * r0 * r0 * stretch(b);
        }
        return sum;
      };
      for (std::size_t b = 0; b < network.bonds().size(); ++b) {
        const LinearBond& bond = network.bonds()[b];
        const auto vi = volumes(bond.i), vj = volumes(bond.j);
        const double s = stretch(static_cast<int>(b));
        const double swelling = (vi[1] + vj[1]) / (3.0 * (vi[0] + vj[0]));
        ijij += s * (s + alpha * (s / bond.r0 - swelling)) / network.volume();
      }
    }
  }
  for (const LinearBond& bond : network.bonds()) {
    iijj += bond.r0 * bond.r0 / network.volume();
  }
  return (ijij - iijj / 3.0) / 10.0;
}

TEST(LinearNetwork, ExactAffineShearModulusIsMatched) {
  const LinearNetwork network(test_box(500));
  for (const double alpha : {-0.8, 2.0, 12.0}) {
    const double exact = affine_shear_by_nodes(network, alpha);
    EXPECT_NEAR(isotropic_part(affine_stiffness(network, alpha)).shear, exact, 1e-10 * exact);
  }
}

TEST(LinearNetwork, AssembledBlocksAreTheSameOperator) {
  const GrainTemplate box = test_box(500);
  const LinearNetwork network(box);
  NetworkOperator op(network);
  const int n = 3 * box.n_nodes();
  const std::vector<double> u = random_field(n, 3);
  std::vector<double> expected(n), blocks(n);
  for (const double alpha : {0.0, -0.8, 12.0}) {
    op.set_alpha(alpha);
    network.multiply(u.data(), alpha, expected.data());
    const Matrix matrix = op.assembled(alpha);
    Vec in = nullptr, out = nullptr;
    VecCreateSeqWithArray(PETSC_COMM_SELF, 3, n, u.data(), &in);
    VecCreateSeqWithArray(PETSC_COMM_SELF, 3, n, blocks.data(), &out);
    const Vector in_owner(in), out_owner(out);
    MatMult(matrix, in, out);
    for (int i = 0; i < n; ++i) {
      ASSERT_NEAR(blocks[i], expected[i], 1e-12 * (1.0 + std::abs(alpha)) * 10.0);
    }
    PetscBool is_null = PETSC_FALSE;
    MatNullSpaceTest(op.null_space(), matrix, &is_null);
    EXPECT_TRUE(is_null);
  }
}

TEST(NetworkStiffness, AFaceCentredCrystalHasItsClosedForm) {
  // Nearest-neighbour springs, every site a centre of symmetry, so nothing relaxes: C11 = (k / V) sum r0^2 n_x^4 =
  // sqrt(2) k/d and C12 = C44 = C11 / 2. All r0 = 1: the many-body term adds alpha (traceless part of the strain) to
  // every bond.
  const LinearNetwork network(fcc_box(4));
  for (const double alpha : {0.0, 3.0}) {
    const Stiffness c = relaxed_stiffness(network, {alpha}).front().stiffness;
    const double c11 = std::sqrt(2.0), c12 = 0.5 * c11;
    const double trace_part = alpha * (c11 + 2.0 * c12) / 3.0; // the volume term: alpha tr(strain)/3 per bond
    EXPECT_NEAR(c(0, 0), c11 * (1.0 + alpha) - trace_part, 1e-9);
    EXPECT_NEAR(c(0, 1), c12 * (1.0 + alpha) - trace_part, 1e-9);
    EXPECT_NEAR(c(3, 3), c12 * (1.0 + alpha), 1e-9);
  }
}

TEST(NetworkStiffness, RelaxationOnlySoftensTheSpringNetwork) {
  const LinearNetwork network(test_box(1372));
  const ElasticConstants relaxed = isotropic_part(relaxed_stiffness(network, {0.0}).front().stiffness);
  const ElasticConstants affine = isotropic_part(affine_stiffness(network, 0.0));
  EXPECT_LT(relaxed.bulk, affine.bulk);
  EXPECT_LT(relaxed.shear, affine.shear);
}

TEST(NetworkStiffness, DoesNotDependOnToleranceOperatorOrOrderOfAlphas) {
  const LinearNetwork network(test_box(1372));
  const auto tight = relaxed_stiffness(network, {12.0}, {.relative_tolerance = 1e-10}).front().stiffness;
  EXPECT_LT((relaxed_stiffness(network, {-0.8, 2.0, 12.0}).back().stiffness - tight).norm(), 1e-6 * tight.norm());
  EXPECT_LT((relaxed_stiffness(network, {12.0}, {.assembled = true}).front().stiffness - tight).norm(),
            1e-6 * tight.norm());
}

TEST(NetworkStiffness, ASolveThatStopsEarlyIsNoNumber) {
  const LinearNetwork network(test_box(500));
  try {
    relaxed_stiffness(network, {2.0}, {.max_iterations = 2});
    FAIL() << "a number came out";
  } catch (const std::invalid_argument&) {
    FAIL() << "that is not the user's fault";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("last residuals"), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace boba::calibration

// SPDX-License-Identifier: GPL-3.0-or-later
// Loadings of a periodic network at a strain of 1e-4 against its static stiffness tensor, which is computed here from
// the linearised law of the bonds alone, with a solver of its own.
#include "bpm/dynamics/simulation.h"
#include "bpm/scene/poisson_table.h"
#include "bpm/scene/scene.h"
#include "bpm/scene/scene_packing.h"
#include "bpm/scene/scene_stages.h"
#include "bpm/stages/deform.h"

#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <cmath>
#include <complex>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace boba {
namespace {

using Voigt = Eigen::Matrix<double, 6, 6>;
using Sparse = Eigen::SparseMatrix<double>;

/// The stress xx yy zz xy xz yz (k/d) per unit of each strain (xy for a simple shear) of a periodic network at rest.
///
/// Bond b is stretched by s_b = e . (u_i - u_j) + r0 e . eps e; its tension is
/// t_b = s_b + alpha (s_b / r0 - (q_i + q_j) / (V_i + V_j)) with q_i = sum r0^2 s, V_i = sum r0^3 over the bonds of i
/// (the law of docs/notation.md, linearised). Nodes move until no force is left, one of them being held.
class StaticStiffness {
public:
  StaticStiffness(const GrainTemplate& grain, double alpha) : grain_(grain) {
    const Eigen::Index n = 3 * grain.n_nodes(), n_bonds = std::ssize(grain.bonds);
    stretch_.resize(n_bonds, n);
    Sparse sums(grain.n_nodes(), n_bonds), pairs(n_bonds, grain.n_nodes());
    std::vector<Eigen::Triplet<double>> b, q, w;
    Eigen::VectorXd volume = Eigen::VectorXd::Zero(grain.n_nodes());
    for (const Bond& bond : grain.bonds) {
      volume[bond.i] += std::pow(bond.r0, 3);
      volume[bond.j] += std::pow(bond.r0, 3);
    }
    Eigen::VectorXd own(n_bonds);
    for (Eigen::Index k = 0; k < n_bonds; ++k) {
      const Bond& bond = grain.bonds[k];
      const Vector3 e = direction(bond);
      for (int c = 0; c < 3; ++c) {
        b.emplace_back(k, 3 * bond.i + c, e[c]);
        b.emplace_back(k, 3 * bond.j + c, -e[c]);
      }
      own[k] = 1.0 + alpha / bond.r0;
      for (const int node : {bond.i, bond.j}) {
        q.emplace_back(node, k, bond.r0 * bond.r0);
        w.emplace_back(k, node, -alpha / (volume[bond.i] + volume[bond.j]));
      }
    }
    stretch_.setFromTriplets(b.begin(), b.end());
    sums.setFromTriplets(q.begin(), q.end());
    pairs.setFromTriplets(w.begin(), w.end());
    tension_ = pairs * sums;
    tension_.diagonal() += own;
    const Eigen::MatrixXd stiffness = Eigen::MatrixXd(stretch_.transpose() * tension_ * stretch_);
    // Without the first node, which is held.
    const Eigen::PartialPivLU<Eigen::MatrixXd> solver(stiffness.bottomRightCorner(n - 3, n - 3));
    for (int c = 0; c < 6; ++c) {
      Eigen::VectorXd s = affine_stretch(c);
      const Eigen::VectorXd force = -(stretch_.transpose() * (tension_ * s));
      Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
      u.tail(n - 3) = solver.solve(force.tail(n - 3));
      s += stretch_ * u;
      tensor_.col(c) = stress(tension_ * s);
    }
  }

  const Voigt& tensor() const { return tensor_; }

  /// Stress over strain of component c when it oscillates at the angular frequency omega (1/tau), with
  /// k = m = gamma = 1: (A + i omega C - omega^2) u = -B^T T s, C = B^T B. The cell's own motion is not damped.
  std::complex<double> modulus(int c, double omega) const {
    using Complex = std::complex<double>;
    const Eigen::MatrixXd b = stretch_, a = Eigen::MatrixXd(stretch_.transpose() * tension_ * stretch_);
    const Eigen::MatrixXcd m = a.cast<Complex>() + Complex(0.0, omega) * (b.transpose() * b).cast<Complex>() -
                               omega * omega * Eigen::MatrixXcd::Identity(a.rows(), a.cols());
    const Eigen::VectorXd s = affine_stretch(c);
    const Eigen::VectorXd right = -(stretch_.transpose() * (tension_ * s));
    const Eigen::VectorXcd u = m.partialPivLu().solve(right.cast<Complex>());
    const Eigen::VectorXd in_phase = stretch_ * u.real(), out_of_phase = stretch_ * u.imag();
    // The tension of the dashpots is i omega times the stretch of the nodes.
    return {stress(tension_ * (s + in_phase) - omega * out_of_phase)[c],
            stress(tension_ * out_of_phase + omega * in_phase)[c]};
  }

private:
  Vector3 direction(const Bond& bond) const {
    Vector3 d = grain_.position[bond.i] - grain_.position[bond.j];
    for (int axis = 0; axis < 3; ++axis) {
      d[axis] -= (*grain_.period)[axis] * std::round(d[axis] / (*grain_.period)[axis]);
    }
    return d.normalized();
  }
  Eigen::VectorXd affine_stretch(int c) const {
    Eigen::VectorXd s(std::ssize(grain_.bonds));
    for (Eigen::Index k = 0; k < s.size(); ++k) {
      const Vector3 e = direction(grain_.bonds[k]);
      s[k] = grain_.bonds[k].r0 * e[component_place[c][0]] * e[component_place[c][1]];
    }
    return s;
  }
  Eigen::Matrix<double, 6, 1> stress(const Eigen::VectorXd& tension) const {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (Eigen::Index k = 0; k < tension.size(); ++k) {
      const Vector3 e = direction(grain_.bonds[k]);
      for (int c = 0; c < 6; ++c) {
        sum[c] += tension[k] * grain_.bonds[k].r0 * e[component_place[c][0]] * e[component_place[c][1]];
      }
    }
    return sum / grain_.period->prod();
  }

  const GrainTemplate& grain_;
  Sparse stretch_, tension_;
  Voigt tensor_;
};

/// The answer of the tensor when the strains of `driven` are given and the stresses of `free` are zero.
struct Answer {
  Eigen::Matrix<double, 6, 1> strain = Eigen::Matrix<double, 6, 1>::Zero(), stress;
};

Answer answer(const Voigt& c, const std::vector<std::pair<int, double>>& driven, const std::vector<int>& free) {
  Answer a;
  for (const auto& [component, strain] : driven) {
    a.strain[component] = strain;
  }
  if (!free.empty()) {
    const auto n = std::ssize(free);
    Eigen::MatrixXd m(n, n);
    Eigen::VectorXd right(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      right[i] = -c.row(free[i]).dot(a.strain);
      for (Eigen::Index j = 0; j < n; ++j) {
        m(i, j) = c(free[i], free[j]);
      }
    }
    const Eigen::VectorXd lateral = m.partialPivLu().solve(right);
    for (Eigen::Index i = 0; i < n; ++i) {
      a.strain[free[i]] = lateral[i];
    }
  }
  a.stress = c * a.strain;
  return a;
}

/// A stage that loads the network, then one in which the motion dies. \param rest keys of that one
Scene scene_of(const std::string& stage, double alpha, const std::string& rest = "xx_rate = 0.0",
               const std::vector<std::string>& overrides = {}) {
  return read_stored_scene(fmt::format(R"([run]
threads = 1
[[template]]
name = "network"
shape = "periodic_box"
size = [2.0, 2.0, 2.0]
nodes = 200
[[species]]
count = 1
alpha = {}
[[stage]]
type = "specimen"
[[stage]]
{}
[[stage]]
type = "deform"
time = 200.0
{}
)",
                                       alpha, stage, rest),
                           "scene.toml", overrides);
}

struct Case {
  std::string name, keys;                     ///< the stage that strains
  std::string rest;                           ///< keys of the deform that follows, while the rest of the motion dies
  std::vector<std::pair<int, double>> driven; ///< for a strain of 1
  std::vector<int> free;
};

class PeriodicModuli : public testing::TestWithParam<double> {};

TEST_P(PeriodicModuli, EqualTheStaticTensorForBothSigns) {
  const double alpha = GetParam();
  const std::string axial = "axis = \"z\"\nrate = 1e-6\nstrain = ", servo = "gain = 0.05\n" + axial;
  const std::string held = "zz = \"fixed\"\nxx_stress = 0.0\nyy_stress = 0.0\n";
  const std::vector<Case> cases = {
      {"uniaxial", servo, "gain = 0.05\n" + held, {{2, 1.0}}, {0, 1}},
      {"oedometer", axial, "xx_rate = 0.0\n", {{2, 1.0}}, {}},
      {"pure_shear",
       "axis = \"x\"\nother_axis = \"z\"\nrate = 1e-6\nstrain = ",
       "xx_rate = 0.0\n",
       {{0, 1.0}, {2, -1.0}},
       {}},
      {"deform",
       "time = 100\ngain = 0.05\nxx = \"fixed\"\nyy_stress = 0.0\nzz_strain = ",
       "gain = 0.05\nzz = \"fixed\"\nyy_stress = 0.0\n",
       {{2, 1.0}},
       {1}},
      {"deform", "time = 100\nyz_strain = ", "xx_rate = 0.0\n", {{5, 1.0}}, {}},
      {"deform", "time = 100\nxz_strain = ", "xx_rate = 0.0\n", {{4, 1.0}}, {}},
      {"deform", "time = 100\nxy_strain = ", "xx_rate = 0.0\n", {{3, 1.0}}, {}},
  };
  const Scene first = scene_of("type = \"hold\"\ntime = 1.0", alpha);
  const Packing packing = make_start(first, PoissonTable::installed(), [](const std::string&) {});
  const Voigt tensor = StaticStiffness(*packing.templates.front(), alpha).tensor();
  for (const Case& test : cases) {
    for (const double strain : {1e-4, -1e-4}) {
      const Scene scene = scene_of(fmt::format("type = \"{}\"\n{}{}", test.name, test.keys, strain), alpha, test.rest);
      std::vector<PreparedStage> stages = prepare_stages(scene, stage_context(scene, packing, {}));
      Simulation simulation(packing, scene.material, scene.options);
      for (const PreparedStage& stage : stages) {
        simulation.run(stage.index, *stage.driver, {});
      }
      auto driven = test.driven;
      for (auto& [component, value] : driven) {
        value *= strain;
      }
      const Answer expected = answer(tensor, driven, test.free);
      const double scale = expected.stress.cwiseAbs().maxCoeff();
      for (int c = 0; c < 6; ++c) {
        EXPECT_NEAR(simulation.totals().stress[c], expected.stress[c], 2e-3 * scale)
            << test.name << " " << test.keys << strain << " alpha " << alpha << " sigma_" << cell_components[c];
      }
      for (int c = 0; c < 3; ++c) {
        const double now = simulation.box().lengths()[c] / packing.box.lengths()[c] - 1.0;
        EXPECT_NEAR(now, expected.strain[c], 2e-3 * std::abs(strain)) << test.name << strain << cell_components[c];
      }
    }
  }
}

/// Runs the scene's second stage alone and hands its driver out.
std::unique_ptr<StageDriver> run_first(const Scene& scene, const Packing& packing) {
  std::vector<PreparedStage> stages = prepare_stages(scene, stage_context(scene, packing, {}));
  Simulation simulation(packing, scene.material, scene.options);
  simulation.run(stages.front().index, *stages.front().driver, {});
  return std::move(stages.front().driver);
}

TEST_P(PeriodicModuli, OfQuasistaticStepsEqualTheStaticTensor) {
  const double alpha = GetParam();
  const Packing packing =
      make_start(scene_of("type = \"hold\"\ntime = 1.0", alpha), PoissonTable::installed(), [](const std::string&) {});
  const Voigt tensor = StaticStiffness(*packing.templates.front(), alpha).tensor();
  for (int c = 0; c < 6; ++c) {
    for (const double strain : {2e-4, -2e-4}) {
      const Scene scene = scene_of(fmt::format("type = \"quasistatic\"\ncomponent = \"{}\"\nstrain = "
                                               "{}\nsteps = 2\nforce_tolerance = 1e-9",
                                               cell_components[c], strain),
                                   alpha);
      const auto driver = run_first(scene, packing);
      const StageTable& table = *driver->table();
      ASSERT_EQ(table.rows.size(), 3U);
      for (const std::size_t row : {1, 2}) {
        EXPECT_NEAR(table.rows[row].values.at(8), tensor(c, c), 2e-3 * tensor(c, c)) << cell_components[c] << strain;
        EXPECT_NEAR(table.rows[row].values.at(0), 0.5 * static_cast<double>(row) * strain, 1e-15);
        for (int other = 0; other < 6; ++other) {
          EXPECT_NEAR(table.rows[row].values.at(1 + other), tensor(other, c) * table.rows[row].values[0],
                      2e-3 * tensor(c, c) * std::abs(strain))
              << cell_components[c] << " " << cell_components[other];
        }
        EXPECT_LT(table.rows[row].values.at(9), 1e-9);
      }
    }
  }
}

/// Storage and loss modulus of small oscillations are those of the linear network with its inertia and dashpots.
TEST_P(PeriodicModuli, OfCyclesEqualTheLinearNetwork) {
  const double alpha = GetParam();
  const Packing packing =
      make_start(scene_of("type = \"hold\"\ntime = 1.0", alpha), PoissonTable::installed(), [](const std::string&) {});
  const StaticStiffness network(*packing.templates.front(), alpha);
  for (const char* component : {"xy", "yz", "zz"}) {
    const int c = std::string(component) == "zz" ? 2 : std::string(component) == "xy" ? 3 : 5;
    for (const double period : {30.0, 10.0}) {
      const Scene scene =
          scene_of(fmt::format("type = \"deform\"\n{}_amplitude = 1e-4\nperiod = {}\ncycles = 8", component, period),
                   alpha, "xx_rate = 0.0", {"run.dt=0.02"});
      const auto driver = run_first(scene, packing);
      const StageTable& table = *driver->table();
      ASSERT_EQ(table.rows.size(), 8U);
      const std::complex<double> expected = network.modulus(c, 2.0 * M_PI / period);
      const std::vector<double>& last = table.rows.back().values;
      EXPECT_NEAR(last.at(1), expected.real(), 0.01 * std::abs(expected)) << component << " " << period;
      EXPECT_NEAR(last.at(2), expected.imag(), 0.01 * std::abs(expected)) << component << " " << period;
      // A cycle takes pi G'' A^2 per volume.
      EXPECT_NEAR(last.at(3), M_PI * last.at(2) * 1e-8, 2e-3 * M_PI * std::abs(expected) * 1e-8);
      EXPECT_LT(last.at(7), 1e-9); // one grain: no motion beside that of the whole
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Alpha, PeriodicModuli, testing::Values(0.0, 2.0));

} // namespace
} // namespace boba

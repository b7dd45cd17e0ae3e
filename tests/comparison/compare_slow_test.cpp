// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/simulation.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/press.h"
#include "calibration/network/connected_network.h"
#include "calibration/network/elastic_constants.h"
#include "calibration/network/network_stiffness.h"
#include "calibration/specimen/bulk_cut.h"
#include "calibration/specimen/nonlinear_network.h"
#include "tests/calibration/test_boxes.h"
#include "tests/comparison/comparison_case.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <memory>
#include <vector>

namespace boba::calibration {
namespace {

/// Mean force at approach / R = 0.1 over that of the continuum with the layer, of the spheres of one resolution.
struct Level {
  int n_nodes = 0, samples = 0;
  double inverse_radius = 0.0; ///< d / R of the solid
  double ratio = 0.0, error = 0.0;
  double to_rigid = 0.0; ///< the same over the rigid plate's
};

Level level_of(double alpha, int n_nodes, int samples) {
  ComparisonSettings settings = comparison_case(alpha, {0.05, 0.1}, "resolution");
  settings.bulk = test_box(4000);
  settings.n_nodes = n_nodes;
  settings.samples = samples;
  settings.models = {"linear_layer", "finite", "finite_layer", "neo_layer"};
  const auto document = compare_sphere(settings);
  std::filesystem::remove_all(settings.folder);
  if (n_nodes == 5137) {
    expect_force_of_the_layer(document, alpha, 0.05);
    expect_force_of_the_layer(document, alpha, 0.1);
  }
  const auto& force = row_of(document, "walls", 0.1, "force");
  const double mean = force.at("particles"), layer = force.at("continuum").at("finite_layer");
  // Bodies of one resolution scatter by 5 % at 5137 nodes and elsewhere like the inverse root of the number of nodes in
  // contact.
  const double scatter = 0.05 * std::cbrt(5137.0 / n_nodes);
  const Level level{.n_nodes = n_nodes,
                    .samples = samples,
                    .inverse_radius = 1.0 / document.at("cases")[0].at("surface").at("body_radius").get<double>(),
                    .ratio = mean / layer,
                    .error = samples > 3 ? force.at("particles_error").get<double>() / layer
                                         : scatter / std::sqrt(double(samples)),
                    .to_rigid = mean / force.at("continuum").at("finite").get<double>()};
  const auto& bulge = row_of(document, "walls", 0.1, "bulge_number");
  fmt::print("alpha = {}, {} nodes, {} bodies: F over the layer's {:.3f} +- {:.3f}, over the rigid plate's {:.3f}; "
             "u_eq E R / F {:.4f} +- {:.4f}, linear continuum {:.4f}\n",
             alpha, n_nodes, samples, level.ratio, level.error, level.to_rigid, bulge.at("particles").get<double>(),
             samples > 1 ? bulge.at("particles_error").get<double>() : 0.0,
             bulge.at("continuum").at("linear_layer").get<double>());
  std::fflush(stdout);
  return level;
}

class Resolution : public ::testing::TestWithParam<double> {};

/// The layer is as thick in d for every R, so the continuum with the layer tends to the rigid plate: the limit of the
/// particles' force over the layer's is the limit of their force over the rigid plate's, without the slow (d/R)^0.65
/// by which each of the two comes up. A weighted straight line in d / R. Tolerance: 5 % and the line's standard error.
TEST_P(Resolution, ExtrapolatedTheForceIsTheRigidPlates) {
  const double alpha = GetParam();
  const std::vector<Level> levels = {level_of(alpha, 1000, 16), level_of(alpha, 5137, 12), level_of(alpha, 20000, 2)};
  double w = 0, wx = 0, wxx = 0, wy = 0, wxy = 0;
  for (const Level& level : levels) {
    const double weight = std::pow(level.error, -2), x = level.inverse_radius;
    w += weight, wx += weight * x, wxx += weight * x * x, wy += weight * level.ratio, wxy += weight * x * level.ratio;
  }
  const double determinant = w * wxx - wx * wx, limit = (wy * wxx - wxy * wx) / determinant,
               error = std::sqrt(wxx / determinant);
  expect_near(
      fmt::format("alpha = {}: force over the rigid plate's for d / R = 0 (standard error {:.3f})", alpha, error),
      limit, 1.0, 0.05 + error);
  EXPECT_LT(levels[0].to_rigid, levels[1].to_rigid);
  EXPECT_LT(levels[1].to_rigid, levels[2].to_rigid);
}

INSTANTIATE_TEST_SUITE_P(Alpha, Resolution, ::testing::Values(-0.8, 0.0, 2.0, 5.0, 12.0),
                         [](const auto& test) { return fmt::format("{}", test.index); });

/// Node i and its image touch at the plane between them, as at a wall, as long as no node slips beside its image: at
/// 0.05 none has, at 0.1 the force may be several percent lower (docs/comparison.md).
TEST(Presses, AMirrorImageIsAWallUntilNodesSlip) {
  ComparisonSettings settings = comparison_case(0.0, {0.05, 0.1}, "presses");
  settings.n_nodes = 1000;
  settings.samples = 1;
  settings.presses = {Press::walls, Press::mirror};
  settings.models = {"linear_layer"};
  const auto document = compare_sphere(settings);
  std::filesystem::remove_all(settings.folder);
  const auto force = [&](const char* press, double load) {
    return row_of(document, press, load, "force")["particles"].get<double>();
  };
  expect_near("force of two mirrored grains against the wall's at 0.05", force("mirror", 0.05), force("walls", 0.05),
              1e-3 * force("walls", 0.05));
  expect_near("the same at 0.1", force("mirror", 0.1), force("walls", 0.1), 0.1 * force("walls", 0.1));
}

/// The engine's walls close on a grain that is free to turn, and rest; the static solver goes to the same gap.
TEST(Presses, TheEngineFindsTheStaticForce) {
  TemplateSpec spec{.shape = TemplateSpec::Shape::sphere};
  spec.n_nodes = 1000;
  const GrainTemplate grain = cut_from_bulk(test_box(2048), spec, 1);
  const Vector3 half = Vector3::Constant(20.0);
  Packing packing = make_packing(Box(-half, 2.0 * half, Vector3::Zero(), {false, false, false}),
                                 {std::make_shared<GrainTemplate>(grain)}, {Placement{.grain = {.alpha = 2.0}}});
  Simulation simulation(std::move(packing), Material{}, SimulationOptions{});
  simulation.run(0, PressDriver({.ends = PressStage::Ends::walls, .velocity = 1e-3, .strain = 0.15}), {});
  simulation.run(1, HoldDriver({.time = 600.0, .barostat = {}}), {});
  const auto ends = simulation.end_forces();
  const double force = 0.5 * (std::abs(ends[0]) + std::abs(ends[1])), gap = simulation.end_gap();
  const SurfaceRule rule{.radius = 6.0};
  const double still = press_sphere(grain, 2.0, rule, {rule.radius - 0.5 * gap}).front().force;
  expect_near(fmt::format("force of the engine at a gap of {:.3f} d against the static one", gap), force, still,
              0.03 * still);
}

using Field = std::vector<Vector3>;

double dot(const Field& a, const Field& b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    sum += a[n].dot(b[n]);
  }
  return sum;
}

/// a + factor * b
Field sum_of(Field a, double factor, const Field& b) {
  for (std::size_t n = 0; n < a.size(); ++n) {
    a[n] += factor * b[n];
  }
  return a;
}

/// Stiffness against a wave of forces along the bulk's axis: density f / (q^2 u) at rest, longitudinal or transverse.
double wave_modulus(const GrainTemplate& bulk, const NonlinearNetwork& network, double q, int along, bool sine) {
  Field force(bulk.n_nodes(), Vector3::Zero());
  Vector3 mean = Vector3::Zero();
  for (int n = 0; n < bulk.n_nodes(); ++n) {
    const double phase = q * bulk.position[n].x();
    force[n][along] = sine ? std::sin(phase) : std::cos(phase);
    mean += force[n] / bulk.n_nodes();
  }
  for (Vector3& f : force) {
    f -= mean;
  }
  // BiCGStab (van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631): the many-body term is not symmetric.
  Field u(force.size(), Vector3::Zero()), r = force, p = force;
  double rho = dot(force, r);
  for (int n = 0; n < 3000 && dot(r, r) > 1e-10 * dot(force, force); ++n) {
    const Field v = network.force_derivative(p); // minus the stiffness
    const double a = -rho / dot(force, v);
    const Field s = sum_of(r, a, v), t = network.force_derivative(s);
    const double w = -dot(t, s) / dot(t, t);
    u = sum_of(sum_of(u, a, p), w, s);
    r = sum_of(s, w, t);
    const double next = dot(force, r), beta = next / rho * a / w;
    p = sum_of(r, beta, sum_of(p, w, v));
    rho = next;
  }
  return bulk_density(bulk).nodes * dot(force, force) / (q * q * dot(u, force));
}

/// The many-body force knows the volumes of both its nodes, so it acts over a bond or two, and the longitudinal modulus
/// depends on the wavelength: what a contact of a few d feels differs from the bulk, upwards for auxetic networks and
/// downwards otherwise, while the shear modulus falls alike for all alpha. The long wave is the elastic solid's.
TEST(Network, ItsModuliDependOnTheWavelength) {
  const GrainTemplate bulk = test_box(4000);
  const LinearNetwork linear(bulk);
  for (const double alpha : {-0.8, 0.0, 2.0, 5.0, 12.0}) {
    const ElasticConstants solid = isotropic_part(relaxed_stiffness(linear, {alpha}).front().stiffness);
    const NonlinearNetwork network(bulk, alpha);
    std::vector<double> ratio;
    for (const int wave : {1, 2}) {
      for (const int along : {0, 1}) {
        const double q = 2.0 * M_PI * wave / bulk.period->x();
        const double modulus =
            0.5 * (wave_modulus(bulk, network, q, along, true) + wave_modulus(bulk, network, q, along, false));
        ratio.push_back(modulus / (along == 0 ? solid.bulk + 4.0 / 3.0 * solid.shear : solid.shear));
      }
    }
    fmt::print(
        "alpha = {}: longitudinal modulus over the solid's {:.3f}, {:.3f}; shear {:.3f}, {:.3f} at wavelengths of "
        "{:.1f} and {:.1f} d\n",
        alpha, ratio[0], ratio[2], ratio[1], ratio[3], bulk.period->x(), 0.5 * bulk.period->x());
    std::fflush(stdout);
    EXPECT_NEAR(ratio[0], 1.0, 0.04);
    EXPECT_NEAR(ratio[1], 1.0, 0.04);
    EXPECT_EQ(ratio[2] > 1.0, alpha > 1.0);
    EXPECT_LT(ratio[3], 1.0);
  }
}

} // namespace
} // namespace boba::calibration

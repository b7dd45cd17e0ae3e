// SPDX-License-Identifier: GPL-3.0-or-later
// The lane kernels and the contact search against plain loops over all pairs in long double.
#include "bpm/forces/force_field.h"
#include "tests/support/plain_forces.h"
#include "tests/support/small_packings.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

struct Evaluated {
  std::vector<Vector3> force;
  Matrix3 virial = Matrix3::Zero();
  double virial_trace = 0.0;
  std::int64_t n_touching = 0;
};

Evaluated evaluate(const Packing& packing, Virial virial, const Material& material = {},
                   const Matrix3& residual_rate = Matrix3::Zero(), Precision precision = Precision::full) {
  const LaneLayout layout(packing, precision);
  LaneState state(packing, layout);
  ForceField forces(packing, layout, material, 0.3);
  forces.evaluate(state, packing.box, {.virial = virial, .keep_forces = true, .residual_rate = residual_rate});
  Evaluated evaluated;
  for (int g = 0; g < packing.n_grains(); ++g) {
    for (int node = 0; node < layout.n_nodes(g); ++node) {
      evaluated.force.push_back(state.force(g, node));
    }
    const Tensor6& t = forces.grain_sums()[g].virial;
    Matrix3 m;
    m << t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2];
    evaluated.virial += m;
    evaluated.virial_trace += forces.grain_sums()[g].virial_trace;
  }
  evaluated.n_touching = forces.contact_totals().n_touching;
  return evaluated;
}

void expect_agreement(const Packing& packing, const Material& material = {},
                      const Matrix3& residual_rate = Matrix3::Zero(), int n_images = 2) {
  const PlainForces plain = plain_forces(packing, material, n_images, residual_rate);
  const Evaluated ours = evaluate(packing, Virial::full, material, residual_rate);
  double largest = 0.0;
  for (const Vector3& f : plain.force) {
    largest = std::max(largest, f.norm());
  }
  for (std::size_t i = 0; i < plain.force.size(); ++i) {
    ASSERT_LT((ours.force[i] - plain.force[i]).norm(), 2e-14 * largest) << "node " << i;
  }
  EXPECT_LT((ours.virial - plain.virial).norm(), 1e-12 * plain.virial.norm());
  EXPECT_NEAR(ours.virial_trace, plain.virial.trace(), 1e-12 * plain.virial.norm());
  EXPECT_EQ(ours.n_touching, plain.n_contacts);
  EXPECT_GT(plain.n_contacts, 0);
}

const Box cube({0.3, -1.0, 2.0}, {12.0, 12.0, 12.0});
const Box tilted({0.3, -1.0, 2.0}, {12.0, 11.0, 13.0}, {5.0, -4.0, 4.5});

TEST(ForceField, AllAlphasInFullAndRaggedBlocks) {
  for (const double alpha : {-0.8, 0.0, 2.0, 12.0}) {
    for (const int n_grains : {1, 2, 7, 8, 9, 17}) {
      SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", " << n_grains << " grains");
      const double length = 5.3 * std::cbrt(n_grains);
      expect_agreement(small_packing({.box = Box({0, 0, 0}, {length, length, length}),
                                      .n_grains = n_grains,
                                      .alpha = alpha,
                                      .least_distance = 4.2}),
                       {}, Matrix3::Zero(), n_grains > 2 ? 1 : 2);
    }
  }
}

// A bond's force in floats: r, up to 1.5 d long, is off by five units in the 24th bit (three from the sum of squares,
// two from the root), r / r0 and the cube root by as much, each times k + |alpha|; the product and the sum add to that:
// eight units. A node has up to 16 bonds.
TEST(ForceField, MixedPrecisionIsAsGoodAsAFloat) {
  for (const double alpha : {-0.8, 0.0, 2.0, 12.0}) {
    for (const int n_grains : {1, 2, 7, 8, 9, 16, 17}) {
      SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", " << n_grains << " grains");
      const double length = 5.3 * std::cbrt(n_grains);
      const Packing packing = small_packing({.box = Box({0, 0, 0}, {length, length, length}),
                                             .n_grains = n_grains,
                                             .alpha = alpha,
                                             .least_distance = 4.2});
      const PlainForces plain = plain_forces(packing, {}, n_grains > 2 ? 1 : 2);
      const Evaluated ours = evaluate(packing, Virial::full, {}, Matrix3::Zero(), Precision::mixed);
      const double bound = 16 * 8 * std::ldexp(1.0 + std::abs(alpha), -24);
      double sum = 0.0;
      for (std::size_t i = 0; i < plain.force.size(); ++i) {
        ASSERT_LT((ours.force[i] - plain.force[i]).norm(), bound) << "node " << i;
        sum += (ours.force[i] - plain.force[i]).squaredNorm();
      }
      // Errors of single bonds have no common sign.
      EXPECT_LT(std::sqrt(sum / static_cast<double>(plain.force.size())), 0.1 * bound);
      EXPECT_LT((ours.virial - plain.virial).norm(), bound * std::sqrt(static_cast<double>(plain.force.size())));
      EXPECT_EQ(ours.n_touching, plain.n_contacts);
    }
  }
}

TEST(ForceField, TiltedCell) {
  expect_agreement(small_packing({.box = tilted, .n_grains = 9}));
}

TEST(ForceField, ImagesWithVelocity) {
  Matrix3 rate = Matrix3::Zero();
  rate(0, 1) = 0.3;
  expect_agreement(small_packing({.box = tilted, .n_grains = 9}), {}, rate);
}

TEST(ForceField, OtherConstants) {
  expect_agreement(small_packing({.box = cube}), {.k = 2.5, .gamma = 0.3, .k3 = 20.0, .node_mass = 3.0});
  expect_agreement(small_packing({.box = cube}), {.gamma = 0.0});
}

// Nodes of different grains, and of images of the same one, touch at contact_diameter, those inside a grain at d.
TEST(ForceField, ContactDiameterBetweenGrains) {
  for (const double contact_diameter : {1.0, 1.2, 1.5}) {
    expect_agreement(small_packing({.box = tilted, .n_grains = 9}), {.contact_diameter = contact_diameter});
    expect_agreement(small_packing({.box = Box({0, 0, 0}, {4.4, 4.4, 4.4}, {1.5, 0.5, -1.0}), .n_grains = 1}),
                     {.contact_diameter = contact_diameter}, Matrix3::Zero(), 3);
  }
}

TEST(ForceField, ContactDiameterOfAWall) {
  const Packing packing = small_packing({.box = Box({0, 0, 0}, {30, 30, 30}), .n_grains = 1, .speed = 0.0});
  const LaneLayout layout(packing);
  const auto wall_force = [&](const Material& material, double below) {
    double lowest = 1e9;
    for (const Vector3& x : packing.position) {
      lowest = std::min(lowest, x.z());
    }
    LaneState state(packing, layout);
    ForceField forces(packing, layout, material, 0.3);
    forces.walls().set({{.point = {0.0, 0.0, lowest - below}}});
    forces.evaluate(state, packing.box, {});
    return forces.walls()[0].force;
  };
  EXPECT_EQ(wall_force({}, 0.55), 0.0);
  EXPECT_EQ(wall_force({.contact_diameter = 1.2}, 0.61), 0.0);
  // One node 0.59 d from the plane: its mirror image is 1.18 d away, an overlap of 0.02 d.
  EXPECT_NEAR(wall_force({.k3 = 0.0, .contact_diameter = 1.2}, 0.59), 0.02, 1e-12);
}

TEST(ForceField, CellSmallerThanAGrain) {
  // One ball of radius 2.5 in a cell of 4.5: it touches its own images on all sides, some of them twice removed.
  expect_agreement(small_packing({.box = Box({0, 0, 0}, {4.4, 4.4, 4.4}, {1.5, 0.5, -1.0}), .n_grains = 1}), {},
                   Matrix3::Zero(), 3);
}

TEST(ForceField, GrainsFarFromTheCell) {
  Packing packing = small_packing({.box = tilted, .n_grains = 5});
  const std::vector<std::int64_t> first = packing.first_nodes();
  for (int g = 0; g < packing.n_grains(); ++g) { // the same packing, each grain in another image
    const Vector3 shift = packing.box.h() * Vector3(7 * g, -3 * g, 2 - g);
    for (std::int64_t node = first[g]; node < first[g + 1]; ++node) {
      packing.position[node] += shift;
    }
  }
  const Evaluated far = evaluate(packing, Virial::full);
  const Evaluated near = evaluate(small_packing({.box = tilted, .n_grains = 5}), Virial::full);
  for (std::size_t i = 0; i < near.force.size(); ++i) {
    EXPECT_LT((far.force[i] - near.force[i]).norm(), 1e-11);
  }
}

TEST(ForceField, OpenDirections) {
  expect_agreement(small_packing({.box = Box({0, 0, 0}, {12, 12, 12}, {0, 0, 0}, {true, false, false})}));
}

TEST(ForceField, DifferentTemplatesAndAlphasTogether) {
  Packing packing = small_packing({.box = cube, .n_grains = 9});
  packing.templates.push_back(small_ball(2.0, 77));
  std::vector<Placement> placements;
  const std::vector<std::int64_t> first = packing.first_nodes();
  for (int g = 0; g < packing.n_grains(); ++g) {
    Placement placement;
    placement.grain = packing.grains[g];
    placement.grain.template_index = g % 4 == 1;
    placement.grain.alpha = g % 3 == 0 ? 0.0 : 1.5 * g;
    for (std::int64_t node = first[g]; node < first[g + 1]; ++node) {
      placement.centre += packing.position[node] / static_cast<double>(first[g + 1] - first[g]);
    }
    placements.push_back(placement);
  }
  Packing mixed = make_packing(cube, packing.templates, placements);
  for (std::size_t i = 0; i < mixed.velocity.size(); ++i) {
    mixed.velocity[i] = {0.01 * std::sin(static_cast<double>(i)), 0.02 * std::cos(3.0 * static_cast<double>(i)), 0.01};
  }
  expect_agreement(mixed);
}

// The sums must not change what is computed: forces (and the trace that the barostat reads) to the last bit.
TEST(ForceField, ForcesDoNotDependOnWhatIsSummed) {
  const Packing packing = small_packing({.box = tilted, .n_grains = 9});
  const Evaluated none = evaluate(packing, Virial::none);
  const Evaluated trace = evaluate(packing, Virial::trace);
  const Evaluated full = evaluate(packing, Virial::full);
  for (std::size_t i = 0; i < none.force.size(); ++i) {
    ASSERT_EQ(none.force[i], trace.force[i]);
    ASSERT_EQ(none.force[i], full.force[i]);
  }
  EXPECT_EQ(trace.virial_trace, full.virial_trace);
}

// Grains share registers; what one computes must not change when another is torn (volume ratios far from 1 take another
// way).
TEST(ForceField, ForcesDoNotDependOnOthersInTheBlock) {
  const Packing packing = small_packing({.box = Box({0, 0, 0}, {60, 60, 60}), .n_grains = 8, .least_distance = 9.0});
  const std::size_t n = packing.position.size() / 8, torn = 3;
  Packing other = packing;
  for (std::size_t i = torn * n; i < torn * n + n; i += 5) {
    other.position[i] += Vector3(0.9, -0.7, 0.8);
  }
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    const Evaluated whole = evaluate(packing, Virial::trace, {}, Matrix3::Zero(), precision);
    const Evaluated with_torn = evaluate(other, Virial::trace, {}, Matrix3::Zero(), precision);
    for (std::size_t i = 0; i < packing.position.size(); ++i) {
      if (i / n != torn) {
        ASSERT_EQ(whole.force[i], with_torn.force[i]) << "node " << i;
      }
    }
  }
}

TEST(ForceField, NewtonsThirdLaw) {
  const Evaluated ours = evaluate(small_packing({.box = tilted, .n_grains = 9}), Virial::none);
  Vector3 sum = Vector3::Zero();
  for (const Vector3& f : ours.force) {
    sum += f;
  }
  EXPECT_LT(sum.norm(), 1e-11);
}

// A grain that is only moved and turned, at rest or in rigid motion, feels nothing.
TEST(ForceField, RigidMotionGivesNoForce) {
  Packing packing = small_packing({.box = Box({0, 0, 0}, {40, 40, 40}),
                                   .n_grains = 3,
                                   .alpha = 12.0,
                                   .jitter = 0.0,
                                   .speed = 0.0,
                                   .least_distance = 8.0});
  const Vector3 spin(0.02, -0.05, 0.03), drift(0.3, 0.1, -0.2);
  for (std::size_t i = 0; i < packing.position.size(); ++i) {
    packing.velocity[i] = drift + spin.cross(packing.position[i]);
  }
  for (const Vector3& f : evaluate(packing, Virial::none).force) {
    EXPECT_LT(f.norm(), 1e-12); // rounding of coordinates up to 40 d, times k + alpha = 13, over some 15 bonds
  }
}

} // namespace
} // namespace boba::test

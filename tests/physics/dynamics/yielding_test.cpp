// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds that yield: one bond against the closed form, grains that keep their new shape, and runs that do not depend on
// threads or restarts.
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/laws/yielding.h"
#include "tests/physics/dynamics/nine_grains.h"

#include <algorithm>
#include <cmath>

namespace boba::test {
namespace {

YieldingBondLaw law_with(double e_p, double hardening = 0.0, double gamma = 0.0) {
  return {{{.k = 1.0, .gamma = gamma}}, e_p, hardening};
}

/// Moves a bond of rest length 1 from its present length to `to` in n equal steps.
struct DrivenBond {
  YieldingBondLaw law;
  double r = 1.0, memory[3] = {1e30, 1.0, 0.0}, work = 0.0;

  double force_at(double length, double speed = 0.0) { return law.pairwise_force(length, 1.0, 1.0, speed, memory); }
  double drive(double to, int n) {
    const double from = r;
    double before = force_at(r);
    for (int i = 1; i <= n; ++i) {
      r = from + (to - from) * i / n;
      const double f = force_at(r);
      work += 0.5 * (before + f) * (from - to) / n;
      before = f;
    }
    return before;
  }
};

// Elastic - perfectly plastic: r_eq = r / (1 + e_p) while it yields in tension, r / (1 - e_p) in compression. No step
// size enters.
TEST(Yielding, OneBondThroughACycle) {
  for (const int n : {1, 7, 1000}) {
    const double e_p = 0.05;
    DrivenBond bond{law_with(e_p)};
    EXPECT_NEAR(bond.drive(1.04, n), -0.04, 1e-15);           // elastic
    EXPECT_NEAR(bond.drive(1.0, n), 0.0, 1e-15);              // and back
    EXPECT_NEAR(bond.drive(1.3, n), 1.3 / 1.05 - 1.3, 1e-14); // plastic flow
    const double r_eq = 1.3 / 1.05;
    EXPECT_NEAR(bond.drive(r_eq, n), 0.0, 1e-14); // elastic unloading
    EXPECT_NEAR(bond.drive(1.2, n), r_eq - 1.2, 1e-14);
    EXPECT_NEAR(bond.drive(0.8, n), 0.8 / 0.95 - 0.8, 1e-14);   // reverse flow
    EXPECT_NEAR(bond.drive(0.87, n), 0.8 / 0.95 - 0.87, 1e-14); // elastic again
  }
}

TEST(Yielding, DampingStaysWithTheBond) {
  DrivenBond bond{law_with(0.05, 0.0, 1.0)};
  EXPECT_NEAR(bond.force_at(1.3, 0.2), 1.3 / 1.05 - 1.3 - 0.2, 1e-14);
}

// Continuous loading with linear hardening: d p = d r_eq / r_eq, so that r = r_eq (1 + e_p + H ln r_eq). The steps of
// the law are implicit: their error falls with the step.
TEST(Yielding, HardeningFollowsTheDifferentialEquation) {
  const double e_p = 0.03, hardening = 0.4, target = 1.25;
  double low = 1.0, high = target; // r_eq by bisection
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * (1.0 + e_p + hardening * std::log(middle)) < target ? low : high) = middle;
  }
  double before = 0.0;
  for (const int n : {100, 1000, 10000}) {
    DrivenBond bond{law_with(e_p, hardening)};
    const double error = std::abs(bond.drive(target, n) - (low - target));
    EXPECT_NEAR(bond.memory[2], std::log(low), 0.2 / n);
    EXPECT_LT(error, 0.1 / n);
    if (before > 0.0) {
      EXPECT_NEAR(before / error, 10.0, 2.0); // first order
    }
    before = error;
  }
}

// Perfectly plastic flow from r_a to r_b: the work is that of the force k (r - r / (1 + e_p)), less what is elastic.
TEST(Yielding, WorkOfACycleIsThatOfTheClosedForm) {
  const double e_p = 0.05, share = 1.0 - 1.0 / 1.05;
  DrivenBond bond{law_with(e_p)};
  bond.drive(1.05, 1000);
  bond.drive(1.4, 20000);
  const double r_eq = 1.4 / 1.05;
  bond.drive(r_eq, 1000);
  const double elastic_in = 0.5 * 0.05 * 0.05, flow = 0.5 * share * (1.4 * 1.4 - 1.05 * 1.05);
  const double elastic_out = 0.5 * (1.4 - r_eq) * (1.4 - r_eq);
  EXPECT_NEAR(bond.work, elastic_in + flow - elastic_out, 1e-12);
}

Packing yielding_grains(double alpha = 2.0, Breaking breaking = {}) {
  Packing packing = nine_grains();
  for (std::size_t g = 0; g < packing.grains.size(); ++g) {
    packing.grains[g].yielding = g == 3 ? Yielding{} : Yielding{.strain = 0.05, .hardening = g % 2 == 0 ? 0.0 : 0.5};
    packing.grains[g].breaking = g == 5 ? Breaking{} : breaking;
    packing.grains[g].alpha = g % 4 == 3 ? 0.0 : alpha;
  }
  return packing;
}

// All bonds of a grain stretched alike: they flow to r_eq = s r0 / (1 + e_p), and V0 follows with the next evaluation.
// Then r / r_eq = 1 + e_p = q^(1/3) for every bond: no many-body force is left, only k (r_eq - r).
TEST(Yielding, ManyBodyForcesCompareWithTheNewLengths) {
  const double s = 1.2, e_p = 0.05;
  std::vector<std::vector<Vector3>> forces;
  for (const double alpha : {1e-300, 12.0}) {
    Packing packing = small_packing(
        {.box = Box({0, 0, 0}, {60, 60, 60}), .n_grains = 2, .jitter = 0.0, .speed = 0.0, .least_distance = 20.0});
    const std::vector<std::int64_t> first = packing.first_nodes();
    for (int g = 0; g < 2; ++g) {
      packing.grains[g].yielding = {.strain = e_p};
      packing.grains[g].alpha = alpha;
      const Vector3 corner = packing.position[first[g]];
      for (std::int64_t i = first[g]; i < first[g + 1]; ++i) {
        packing.position[i] = corner + s * (packing.position[i] - corner);
      }
    }
    Stepper stepper(packing, {}, {});
    stepper.evaluate_only();
    stepper.evaluate_only();
    forces.push_back(take_snapshot(stepper.moving(), {.force = true}).force);
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < forces[0].size(); ++i) {
    largest = std::max(largest, forces[0][i].norm());
    EXPECT_LT((forces[0][i] - forces[1][i]).norm(), 1e-12);
  }
  EXPECT_GT(largest, 0.01);
}

void shear(Stepper& stepper, int n_steps) {
  for (int step = 0; step < n_steps; ++step) {
    stepper.advance(step + 1 < n_steps ? Virial::trace : Virial::full);
    stepper.move_cell({.shear = 0.02, .dilation = 0.05 * (stepper.pressure() - 0.1)});
  }
}

TEST(Yielding, DoesNotDependOnThreadsOrRestarts) {
  const Breaking breaking = {.strain = 0.3};
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    Stepper one(yielding_grains(2.0, breaking), {}, {.threads = 1, .precision = precision});
    Stepper two(yielding_grains(2.0, breaking), {}, {.threads = 2, .precision = precision});
    Stepper continued(yielding_grains(2.0, breaking), {}, {.precision = precision});
    one.start();
    two.start();
    shear(one, 120);
    continue_from(one, continued);
    shear(one, 120);
    shear(two, 120);
    shear(two, 120);
    shear(continued, 120);
    const Snapshot end = take_snapshot(one.moving(), all_parts);
    expect_same_bits(end, take_snapshot(two.moving(), all_parts));
    expect_same_bits(end, take_snapshot(continued.moving(), all_parts));
  }
}

// Compressed and released, yielding grains do not come back as elastic ones do.
TEST(Yielding, GrainsKeepTheirShape) {
  const auto largest_change = [](Packing packing) {
    const Packing begin = packing;
    Stepper stepper(std::move(packing), {}, {});
    stepper.start();
    for (int step = 0; step < 2500;
         ++step) { // the cell shrinks to a third of its volume and opens again by more, slowly
      stepper.advance(Virial::trace);
      stepper.move_cell({.dilation = step < 600 ? -6e-3 : 2.5e-3});
    }
    for (int step = 0; step < 1500; ++step) {
      stepper.advance(step < 1499 ? Virial::trace : Virial::full);
    }
    const Snapshot end = take_snapshot(stepper.moving(), all_parts);
    double largest = 0.0;
    for (const Bond& bond : begin.template_of(0).bonds) {
      largest = std::max(largest, std::abs((end.position[bond.i] - end.position[bond.j]).norm() / bond.r0 - 1.0));
    }
    return largest;
  };
  Packing elastic = nine_grains(), yielding = nine_grains();
  for (Grain& grain : yielding.grains) {
    grain.yielding = {.strain = 0.02};
  }
  const double of_elastic = largest_change(elastic), of_yielding = largest_change(yielding);
  EXPECT_LT(of_elastic, 0.02);
  EXPECT_GT(of_yielding, 0.05);
}

} // namespace
} // namespace boba::test

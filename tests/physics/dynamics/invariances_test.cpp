// SPDX-License-Identifier: GPL-3.0-or-later
// What must not matter to the forces, on random packings: where the origin is, how things are numbered, which of the
// equivalent cells is taken, which units.
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "tests/support/small_packings.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace boba::test {
namespace {

double number(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 1000001) * 1e-6;
}
Vector3 vector(double half) {
  const double x = number(-half, half), y = number(-half, half), z = number(-half, half);
  return {x, y, z};
}

/// A tilted cell of four to nine grains with random alpha, overlaps and velocities.
Packing any_packing(bool periodic = true) {
  SmallPackingSpec spec;
  const Vector3 tilts = vector(5.0);
  spec.box = Box(vector(3.0), Vector3(12, 12, 12) + vector(0.9), periodic ? tilts : Vector3(0, 0, 0),
                 {periodic, periodic, periodic});
  spec.n_grains = *rc::gen::inRange(4, 10);
  spec.alpha = *rc::gen::element(-0.8, 0.0, 2.0, 12.0);
  spec.least_distance = 4.0;
  spec.radius = 2.2;
  spec.seed = static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000000));
  return small_packing(spec);
}

struct Forces {
  std::vector<Vector3> force;
  std::array<double, 6> stress;
  double largest = 0.0;
};

Forces forces_of(const Packing& packing, const Material& material = {}) {
  Stepper stepper(packing, material, {});
  stepper.evaluate_only();
  Forces result{take_snapshot(stepper.moving(), {.force = true}).force, totals_of(stepper.moving()).stress, 0.0};
  for (const Vector3& f : result.force) {
    result.largest = std::max(result.largest, f.norm());
  }
  return result;
}

/// The same numbers up to rounding: sums of some tens of pairs, positions of some tens of d.
void same(const Forces& a, const Forces& b, double scale = 1.0) {
  constexpr double rounding = 1e-12;
  RC_ASSERT(a.largest > 0.0);
  for (std::size_t i = 0; i < a.force.size(); ++i) {
    RC_ASSERT((scale * a.force[i] - b.force[i]).norm() < rounding * scale * a.largest);
  }
  const double size =
      *std::max_element(a.stress.begin(), a.stress.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  for (std::size_t c = 0; c < 6; ++c) {
    RC_ASSERT(std::abs(scale * a.stress[c] - b.stress[c]) < 1e-10 * std::abs(scale * size));
  }
}

RC_GTEST_PROP(Invariance, Translation, ()) {
  Packing packing = any_packing();
  const Forces before = forces_of(packing);
  const Vector3 shift = vector(30.0);
  for (Vector3& x : packing.position) {
    x += shift;
  }
  same(before, forces_of(packing));
}

RC_GTEST_PROP(Invariance, UniformMotion, ()) {
  Packing packing = any_packing();
  Forces before = forces_of(packing);
  const Vector3 motion = vector(0.5);
  for (Vector3& v : packing.velocity) {
    v += motion;
  }
  Forces after = forces_of(packing);
  after.stress = before.stress; // its kinetic part sees the motion
  same(before, after);
}

RC_GTEST_PROP(Invariance, RotationOfAnOpenPacking, ()) {
  Packing packing = any_packing(false);
  Forces before = forces_of(packing);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(1.0, number(-2, 2), number(-2, 2), number(-2, 2)).normalized();
  for (std::size_t i = 0; i < packing.position.size(); ++i) {
    packing.position[i] = turn * packing.position[i];
    packing.velocity[i] = turn * packing.velocity[i];
    before.force[i] = turn * before.force[i];
  }
  Forces after = forces_of(packing);
  RC_ASSERT(std::abs(before.stress[0] + before.stress[1] + before.stress[2] - after.stress[0] - after.stress[1] -
                     after.stress[2]) < 1e-10 * (std::abs(before.stress[0]) + std::abs(before.stress[1]) + 1e-6));
  after.stress = before.stress;
  same(before, after);
}

RC_GTEST_PROP(Invariance, EquivalentCellsAndImages, ()) {
  Packing packing = any_packing();
  const Forces before = forces_of(packing);
  const auto whole = [] { return static_cast<double>(*rc::gen::inRange(-2, 3)); };
  const Matrix3 old = packing.box.h();
  Matrix3 h = old;
  const double ba = whole(), ca = whole(), cb = whole();
  h.col(1) += ba * old.col(0);
  h.col(2) += ca * old.col(0) + cb * old.col(1);
  packing.box.set_h(h);
  for (int g = 0; g < packing.n_grains(); ++g) {
    const Vector3 image = old * Vector3(whole(), whole(), whole());
    for (std::int64_t i = packing.first_nodes()[g]; i < packing.first_nodes()[g + 1]; ++i) {
      packing.position[i] += image;
    }
  }
  same(before, forces_of(packing));
}

RC_GTEST_PROP(Invariance, OrderOfGrains, ()) {
  const Packing packing = any_packing();
  Forces before = forces_of(packing);
  std::vector<int> order(packing.n_grains());
  std::iota(order.begin(), order.end(), 0);
  for (int g = packing.n_grains() - 1; g > 0; --g) {
    std::swap(order[g], order[*rc::gen::inRange(0, g + 1)]);
  }
  const std::vector<std::int64_t> first = packing.first_nodes();
  const std::int64_t n = packing.template_of(0).n_nodes(); // all grains share one template
  Packing other = packing;
  Forces expected = before;
  for (int g = 0; g < packing.n_grains(); ++g) {
    for (std::int64_t i = 0; i < n; ++i) {
      other.position[g * n + i] = packing.position[first[order[g]] + i];
      other.velocity[g * n + i] = packing.velocity[first[order[g]] + i];
      expected.force[g * n + i] = before.force[first[order[g]] + i];
    }
  }
  same(expected, forces_of(other));
}

RC_GTEST_PROP(Invariance, OrderOfNodes, ()) {
  const Packing packing = any_packing();
  const Forces before = forces_of(packing);
  const GrainTemplate& old = packing.template_of(0);
  std::vector<int> place(old.n_nodes()); // place[i]: new number of node i
  std::iota(place.begin(), place.end(), 0);
  for (int i = old.n_nodes() - 1; i > 0; --i) {
    std::swap(place[i], place[*rc::gen::inRange(0, i + 1)]);
  }
  auto renumbered = std::make_shared<GrainTemplate>(old);
  for (int i = 0; i < old.n_nodes(); ++i) {
    renumbered->position[place[i]] = old.position[i];
  }
  for (Bond& bond : renumbered->bonds) {
    bond = {std::min(place[bond.i], place[bond.j]), std::max(place[bond.i], place[bond.j]), bond.r0};
  }
  std::sort(renumbered->bonds.begin(), renumbered->bonds.end(),
            [](const Bond& a, const Bond& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  Packing other = packing;
  other.templates = {renumbered};
  Forces expected = before;
  const int n = old.n_nodes();
  for (int g = 0; g < packing.n_grains(); ++g) {
    for (int i = 0; i < n; ++i) {
      other.position[g * n + place[i]] = packing.position[g * n + i];
      other.velocity[g * n + place[i]] = packing.velocity[g * n + i];
      expected.force[g * n + place[i]] = before.force[g * n + i];
    }
  }
  same(expected, forces_of(other));
}

RC_GTEST_PROP(Invariance, UnitOfForce, ()) {
  Packing packing = any_packing();
  for (Vector3& v : packing.velocity) {
    v.setZero(); // the kinetic stress has another unit
  }
  const double unit = number(0.1, 20.0);
  const Forces before = forces_of(packing);
  for (Grain& grain : packing.grains) {
    grain.alpha *= unit;
  }
  const Material standard;
  same(before, forces_of(packing, {.k = unit * standard.k, .gamma = standard.gamma, .k3 = unit * standard.k3}), unit);
}

} // namespace
} // namespace boba::test

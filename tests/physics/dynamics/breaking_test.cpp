// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds that break, against what LAMMPS (bond style bpm/spring, break and smooth) computed;
// tests/data/breaking/README.md.
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/io/line_reader.h"
#include "tests/physics/dynamics/nine_grains.h"
#include "tests/support/lammps_fixture.h"
#include "tests/support/plain_forces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace boba::test {
namespace {

std::filesystem::path breaking_data(const std::string& name) {
  return force_data("../breaking/" + name);
}

/// Column c_nb of a dump by id: how many bonds of a node are whole.
std::map<std::int64_t, int> whole_bonds_in(const std::filesystem::path& path) {
  LineReader in(path);
  std::map<std::int64_t, int> whole;
  std::size_t column = 0;
  while (in.next()) {
    if (in.line().starts_with("ITEM: ATOMS")) {
      column = std::find(in.fields().begin(), in.fields().end(), "c_nb") - in.fields().begin() - 2;
    } else if (column > 0) {
      whole[in.integer(0, "id")] = static_cast<int>(in.integer(column, "c_nb"));
    }
  }
  return whole;
}

/// The same of a packing that moves, in the packing's order.
std::vector<int> whole_bonds_of(const Stepper& stepper) {
  std::vector<int> all;
  for (int g = 0; g < stepper.packing().n_grains(); ++g) {
    const std::vector<int> of_grain = stepper.forces().survey(stepper.moving().state).whole_bonds(g);
    all.insert(all.end(), of_grain.begin(), of_grain.end());
  }
  return all;
}

struct Case {
  bool smooth;
  double alpha;
};

class LammpsBreaking : public testing::TestWithParam<Case> {
protected:
  std::string dump(int step) const {
    return "ortho.ec0.35.smooth_" + std::string(GetParam().smooth ? "yes" : "no") + ".a" +
           std::to_string(static_cast<int>(GetParam().alpha)) + ".step" + std::to_string(step) + ".dump.gz";
  }
  LammpsPacking packing() const {
    LammpsPacking read = fixture_packing("ortho", "ortho.a2.step0.dump.gz", GetParam().alpha);
    for (Grain& grain : read.packing.grains) {
      grain.breaking = {.strain = 0.35, .smooth = GetParam().smooth};
    }
    return read;
  }
};

// The fixtures' forces at late steps belong to the half-step velocities, as the engine's own do. With many-body forces
// the runs part after the first step: there the plain loops of AfterBreakingAsPlainLoopsSay are the oracle.
TEST_P(LammpsBreaking, SameForcesAndTheSameBondsBreak) {
  const LammpsPacking read = packing();
  Stepper stepper(read.packing, {}, {});
  stepper.start();
  for (int step = 0; step <= (GetParam().alpha == 0.0 ? 100 : 0); ++step) {
    if (step > 0) {
      stepper.advance(Virial::full);
    }
    if (step != 0 && step != 10 && step != 100) {
      continue;
    }
    const std::filesystem::path file = breaking_data(dump(step));
    const LammpsFrame frame = read_lammps_dump(file);
    const std::map<std::int64_t, int> theirs = whole_bonds_in(file);
    const std::vector<int> ours = whole_bonds_of(stepper);
    int n_broken = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      ASSERT_EQ(ours[i], theirs.at(read.packing.id[i])) << "bonds of the node with id " << read.packing.id[i];
      n_broken += ours[i];
    }
    EXPECT_LT(n_broken, 2 * 3302); // some broke
    if (step <= 10) {
      const Snapshot snapshot = take_snapshot(stepper.moving(), {.velocity = true, .force = true});
      EXPECT_LT(largest_difference(read, snapshot.force, frame, frame.force), 1e-11 * largest_norm(frame.force))
          << "step " << step;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fixtures, LammpsBreaking,
                         testing::Values(Case{false, 0.0}, Case{false, 2.0}, Case{true, 0.0}, Case{true, 2.0}));

/// Nine grains that are pulled apart and sheared: many of their bonds break. Two of the grains do not break.
Packing breakable(Breaking breaking = {.strain = 0.12, .weibull_modulus = 6.0, .seed = 3}) {
  Packing packing = nine_grains();
  for (std::size_t g = 0; g < packing.grains.size(); ++g) {
    packing.grains[g].breaking = g == 2 || g == 5 ? Breaking{} : breaking;
    packing.grains[g].alpha = g % 4 == 3 ? 0.0 : 2.0;
  }
  return packing;
}

void shear(Stepper& stepper, int n_steps) {
  for (int step = 0; step < n_steps; ++step) {
    stepper.advance(step + 1 < n_steps ? Virial::trace : Virial::full);
    stepper.move_cell({.shear = 0.02, .dilation = 0.05 * (stepper.pressure() - 0.1)});
  }
}

int n_whole(const Stepper& stepper) {
  const std::vector<int> whole = whole_bonds_of(stepper);
  return std::accumulate(whole.begin(), whole.end(), 0) / 2;
}

// Forces once bonds have broken: V and V0 without them, and their nodes touch. Against plain loops in long double.
TEST(Breaking, AfterBreakingAsPlainLoopsSay) {
  for (const double alpha : {0.0, 2.0, 12.0}) {
    for (const int n_grains : {1, 9}) {
      Packing packing = small_packing({.box = tilted, .n_grains = n_grains, .alpha = alpha, .jitter = 0.1});
      for (Grain& grain : packing.grains) {
        grain.breaking = {.strain = 0.1};
      }
      const PlainForces plain = plain_forces(packing, {});
      Stepper stepper(packing, {}, {});
      const int n = n_whole(stepper);
      stepper.evaluate_only();
      EXPECT_LT(n_whole(stepper), n - 5);
      stepper.evaluate_only();
      const Snapshot snapshot = take_snapshot(stepper.moving(), {.force = true});
      const double largest = largest_norm(plain.force);
      for (std::size_t i = 0; i < plain.force.size(); ++i) {
        ASSERT_LT((snapshot.force[i] - plain.force[i]).norm(), 1e-13 * largest) << "node " << i << ", alpha " << alpha;
      }
      EXPECT_EQ(stepper.forces().contact_totals().n_touching, plain.n_contacts);
      const Totals totals = totals_of(stepper.moving());
      double kinetic = 0.0;
      for (const Vector3& v : packing.velocity) {
        kinetic += v.squaredNorm();
      }
      EXPECT_NEAR(3.0 * totals.pressure * tilted.volume(), plain.virial.trace() + kinetic, 1e-11 * plain.virial.norm());
    }
  }
}

TEST(Breaking, DoesNotDependOnThreads) {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    std::unique_ptr<Stepper> one;
    for (const int threads : {1, 2, 3}) {
      auto stepper = std::make_unique<Stepper>(breakable(), Material{},
                                               SimulationOptions{.threads = threads, .precision = precision});
      stepper->start();
      shear(*stepper, 300);
      if (!one) {
        one = std::move(stepper);
        continue;
      }
      expect_same_bits(take_snapshot(one->moving(), all_parts), take_snapshot(stepper->moving(), all_parts));
      EXPECT_EQ(whole_bonds_of(*one), whole_bonds_of(*stepper));
    }
    Stepper fresh(breakable(), {}, {});
    EXPECT_LT(n_whole(*one), n_whole(fresh) - 20);
  }
}

// Three large grains are one block, which threads share.
TEST(Breaking, DoesNotDependOnThreadsThatShareABlock) {
  const Box box(Vector3::Zero(), {26.0, 25.0, 27.0}, {9.0, -7.0, 8.0});
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    std::vector<Snapshot> ends;
    std::vector<std::vector<int>> whole;
    for (const int threads : {1, 2, 5}) {
      Packing packing = small_packing({.box = box, .n_grains = 3, .radius = 6.5, .speed = 0.3, .least_distance = 11.0});
      for (Grain& grain : packing.grains) {
        grain.breaking = {.strain = 0.1};
      }
      Stepper stepper(std::move(packing), {}, {.threads = threads, .precision = precision});
      const int before = n_whole(stepper);
      stepper.start();
      for (int step = 0; step < 30; ++step) {
        stepper.advance(step % 3 == 2 ? Virial::full : Virial::trace);
      }
      ends.push_back(take_snapshot(stepper.moving(), all_parts));
      whole.push_back(whole_bonds_of(stepper));
      EXPECT_LT(n_whole(stepper), before - 50);
    }
    for (std::size_t k = 1; k < ends.size(); ++k) {
      expect_same_bits(ends[0], ends[k]);
      EXPECT_EQ(whole[0], whole[k]);
    }
  }
}

// A list that lives long and one that is made at every step find the same contacts, also of nodes that were bonded.
TEST(Breaking, ContactsOfBrokenBondsAreNotMissed) {
  Stepper lasting(breakable(), {}, {}), fresh(breakable(), {}, {});
  for (Stepper* stepper : {&lasting, &fresh}) {
    stepper->start();
    for (int step = 0; step < 400; ++step) {
      if (stepper == &fresh) {
        stepper->forces().forget_contacts();
      }
      stepper->advance(step + 1 < 400 ? Virial::trace : Virial::full);
      stepper->move_cell({.shear = 0.02, .dilation = 0.05 * (stepper->pressure() - 0.2)});
    }
  }
  expect_same_bits(take_snapshot(lasting.moving(), all_parts), take_snapshot(fresh.moving(), all_parts));
}

TEST(Breaking, ContinuesBitForBit) {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    Stepper whole(breakable(), {}, {.precision = precision});
    whole.start();
    shear(whole, 120);
    Stepper second(breakable(), {}, {.precision = precision});
    continue_from(whole, second);
    EXPECT_EQ(whole_bonds_of(whole), whole_bonds_of(second));
    const int before = n_whole(whole);
    shear(whole, 120);
    shear(second, 120);
    EXPECT_LT(n_whole(whole), before); // some break after the restart too
    expect_same_bits(take_snapshot(whole.moving(), all_parts), take_snapshot(second.moving(), all_parts));
  }
}

/// Two nodes with one bond of length 1, in a packing of their own.
Packing one_bond(const Breaking& breaking, double alpha, double length, double speed) {
  auto pair = std::make_shared<GrainTemplate>();
  pair->position = {{-0.5, 0.0, 0.0}, {0.5, 0.0, 0.0}};
  pair->bonds = {{0, 1, 1.0}};
  pair->reference_volume = 1.0;
  Packing packing = make_packing(Box(Vector3::Zero(), Vector3::Constant(20.0)), {pair},
                                 {{.grain = {.alpha = alpha, .breaking = breaking}, .centre = {10.0, 10.0, 10.0}}});
  packing.position[0].x() = 10.0 - 0.5 * length;
  packing.position[1].x() = 10.0 + 0.5 * length;
  packing.velocity[0].x() = -0.5 * speed;
  packing.velocity[1].x() = 0.5 * speed;
  return packing;
}

/// Force that pushes the two nodes apart.
double force_of(const Packing& packing, const Material& material = {.k3 = 0.0}) {
  Stepper stepper(packing, material, {});
  stepper.evaluate_only();
  return take_snapshot(stepper.moving(), {.force = true}).force[1].x();
}

TEST(Breaking, OneBondByHand) {
  const Breaking either = {.strain = 0.2}, tension = {.strain = 0.2, .in_tension_only = true};
  EXPECT_NEAR(force_of(one_bond(either, 0.0, 1.19, 0.1)), -0.19 - 0.1, 1e-14);
  EXPECT_EQ(force_of(one_bond(either, 0.0, 1.21, 0.1)), 0.0);
  EXPECT_EQ(force_of(one_bond(either, 3.0, 0.79, 0.0)), 0.0); // its nodes touch from the next evaluation on
  EXPECT_NEAR(force_of(one_bond(tension, 3.0, 0.7, 0.0)), 0.3, 1e-14);
  EXPECT_EQ(force_of(one_bond(tension, 3.0, 1.21, 0.0)), 0.0);
  // With smoothing at half of e_c: w = 1 - 2^-8; in tension alone w = 1 for a compressed bond.
  const Breaking smooth = {.strain = 0.2, .smooth = true},
                 smooth_tension = {.strain = 0.2, .in_tension_only = true, .smooth = true};
  EXPECT_NEAR(force_of(one_bond(smooth, 3.0, 1.1, 0.3)), (-0.1 - 0.3) * (1.0 - 1.0 / 256.0), 1e-14);
  EXPECT_NEAR(force_of(one_bond(smooth, 0.0, 0.9, 0.0)), 0.1 * (1.0 - 1.0 / 256.0), 1e-14);
  EXPECT_NEAR(force_of(one_bond(smooth_tension, 0.0, 0.7, 0.0)), 0.3, 1e-14);
}

// k/2 of the relative motion: two nodes that part at speed v reach the strain v / sqrt(2) without damping.
TEST(Breaking, NodesOfABrokenBondTouch) {
  const Material undamped = {.gamma = 0.0};
  Stepper whole(one_bond({.strain = 0.2}, 0.0, 1.0, 0.27), undamped, {.dt = 0.01});
  Stepper breaks(one_bond({.strain = 0.2}, 0.0, 1.0, 0.30), undamped, {.dt = 0.01});
  for (Stepper* stepper : {&whole, &breaks}) {
    stepper->start();
    for (int step = 0; step < 300; ++step) {
      stepper->advance(Virial::full);
    }
  }
  EXPECT_EQ(n_whole(whole), 1);
  EXPECT_EQ(n_whole(breaks), 0);
  // What is left of the speed at the strain 0.2: v^2 - 2 * 0.2^2, twice k/2 over the reduced mass.
  const Snapshot end = take_snapshot(breaks.moving(), all_parts);
  EXPECT_NEAR((end.velocity[1] - end.velocity[0]).x(), std::sqrt(0.09 - 0.08), 0.01);
  Packing meet = one_bond({.strain = 0.05}, 0.0, 0.9, -0.1); // breaks under compression; then its nodes are a contact
  Stepper contact(meet, {.gamma = 0.0, .k3 = 50.0}, {.dt = 0.01});
  contact.start();
  EXPECT_EQ(contact.forces().contact_totals().n_touching, 0);
  contact.advance(Virial::full);
  EXPECT_EQ(contact.forces().contact_totals().n_touching, 1);
  const Snapshot state = take_snapshot(contact.moving(), all_parts);
  const double overlap = 1.0 - (state.position[1] - state.position[0]).x();
  EXPECT_NEAR(state.force[1].x(), overlap + 50.0 * overlap * overlap * overlap, 1e-12);
}

// Weibull: the share of bonds weaker than e is 1 - exp(-(e / e_0)^m). All bonds at one strain: that share breaks.
TEST(Breaking, StrengthsScatterAsWeibullSays) {
  const double modulus = 4.0, e0 = 0.1, strain = 0.09;
  Packing packing = small_packing({.box = Box(Vector3::Zero(), Vector3::Constant(200.0)),
                                   .n_grains = 16,
                                   .radius = 5.0,
                                   .jitter = 0.0,
                                   .speed = 0.0,
                                   .least_distance = 20.0});
  const std::vector<std::int64_t> first = packing.first_nodes();
  for (int g = 0; g < packing.n_grains(); ++g) {
    packing.grains[g].breaking = {.strain = e0, .weibull_modulus = modulus, .seed = 7};
    const Vector3 corner = packing.position[first[g]];
    for (std::int64_t i = first[g]; i < first[g + 1]; ++i) {
      packing.position[i] = corner + (1.0 + strain) * (packing.position[i] - corner);
    }
  }
  Stepper stepper(packing, {}, {});
  const double n = n_whole(stepper);
  stepper.evaluate_only();
  const double share = 1.0 - n_whole(stepper) / n, expected = 1.0 - std::exp(-std::pow(strain / e0, modulus));
  EXPECT_GT(n, 10000);
  EXPECT_NEAR(share, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / n));
  const std::vector<int> whole = whole_bonds_of(stepper); // not the same bonds in every grain
  const std::ptrdiff_t n_nodes = first[1];
  EXPECT_FALSE(std::equal(whole.begin(), whole.begin() + n_nodes, whole.begin() + n_nodes));
}

TEST(Breaking, ForceIsMinusTheGradientOfTheEnergy) {
  const Material undamped = {.gamma = 0.0, .k3 = 0.0};
  for (const bool smooth : {false, true}) {
    for (const double length : {0.9, 1.05, 1.15, 1.19}) {
      const Breaking breaking = {.strain = 0.2, .smooth = smooth};
      const auto energy = [&](double r) {
        Stepper stepper(one_bond(breaking, 0.0, r, 0.0), undamped, {});
        return stepper.bond_energy();
      };
      const double h = 1e-5;
      EXPECT_NEAR(force_of(one_bond(breaking, 0.0, length, 0.0), undamped),
                  -(energy(length + h) - energy(length - h)) / (2.0 * h), 1e-8);
    }
  }
}

} // namespace
} // namespace boba::test

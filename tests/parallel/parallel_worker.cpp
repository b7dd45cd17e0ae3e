// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a small packing on the ranks it is started on and writes every bit of the outcome to a file.
// Usage: parallel_worker CASE FILE [STATE]
#include "bpm/dynamics/grain_migration.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/measure/scattering.h"
#include "bpm/parallel/dealt_items.h"
#include "bpm/parallel/message_passing.h"
#include "bpm/stages/compress.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/press.h"
#include "bpm/stages/shear.h"
#include "tests/support/small_packings.h"

#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <random>
#include <string>

namespace boba::test {
namespace {

/// Twenty grains, three of them without many-body forces, in a cell that some of them reach across twice.
Packing twenty_grains() {
  Packing packing = small_packing({.box = Box({0.3, -1.0, 2.0}, {17.0, 16.0, 15.0}, {5.0, -4.0, 4.5}), .n_grains = 20});
  for (const int g : {2, 7, 11}) {
    packing.grains[g].alpha = 0.0;
  }
  return packing;
}

class Bits {
public:
  void add(const char* name, double value) { text_ += fmt::format("{} {:a}\n", name, value); }
  void add(const char* name, const Vector3& v) { text_ += fmt::format("{} {:a} {:a} {:a}\n", name, v[0], v[1], v[2]); }
  void add(const Totals& totals) {
    for (const double s : totals.stress) {
      add("stress", s);
    }
    add("pressure", totals.pressure);
    add("kinetic", totals.kinetic_energy);
    add("elastic", totals.elastic_energy);
    add("overlap", totals.largest_overlap);
  }
  void add(const Snapshot& snapshot) {
    for (int column = 0; column < 3; ++column) {
      add("cell", Vector3(snapshot.box.h().col(column)));
    }
    for (std::size_t i = 0; i < snapshot.position.size(); ++i) {
      add("x", snapshot.position[i]);
      add("v", snapshot.velocity[i]);
      add("f", snapshot.force[i]);
    }
    for (std::size_t g = 0; g < snapshot.grain_centre.size(); ++g) {
      add("centre", snapshot.grain_centre[g]);
      for (const double s : snapshot.grain_stress[g]) {
        add("grain", s);
      }
    }
  }
  void write(const std::string& file) const {
    std::FILE* out = std::fopen(file.c_str(), "w");
    std::fwrite(text_.data(), 1, text_.size(), out);
    std::fclose(out);
  }

private:
  std::string text_;
};

constexpr Simulation::Parts all_parts = {.velocity = true, .force = true};

/// Notes the sums of every tenth step.
class Notes : public Observer {
public:
  explicit Notes(Bits& bits) : bits_(bits) {}
  bool wants(const StepForecast& forecast) override { return forecast.step % 10 == 0; }
  void observe(const Simulation& simulation, const StageProgress&) override {
    bits_.add(simulation.totals());
    bits_.add("force", simulation.end_forces()[0]);
    bits_.add("force", simulation.end_forces()[1]);
  }

private:
  Bits& bits_;
};

struct Case {
  Packing packing;
  SimulationOptions options;
  std::vector<std::shared_ptr<StageDriver>> stages;
};

Case case_of(const std::string& name, const Ranks& ranks) {
  Case c{twenty_grains(), {.threads = ranks.size() == 2 ? 2 : 1, .ranks = &ranks}, {}};
  c.options.rebalance_seconds = 0.01; // often: who owns what must not matter
  ShearStage shear = {.rate = 2e-2, .strain = 0.8, .barostat = Barostat{.pressure = 0.05, .gain = 0.05}};
  if (name == "mixed") {
    c.options.precision = Precision::mixed;
  } else if (name == "velocities") {
    shear.remap = Remap::velocities;
  } else if (name == "compress") {
    c.stages = {std::make_shared<CompressDriver>(CompressStage{
        .barostat = {.pressure = 0.2}, .rate = 4e-3, .pressure_tolerance = 0.1, .kinetic_tolerance = 0.5})};
    return c;
  } else if (name == "walls" || name == "clamps") {
    const Box open({-20, -20, -20}, {40, 40, 40}, Vector3::Zero(), {false, false, false});
    c.packing = small_packing({.box = open, .n_grains = 5, .least_distance = 4.5});
    for (std::size_t g = 0, node = 0; g < 5; ++g) { // a column of grains that touch
      const int n = c.packing.template_of(static_cast<int>(g)).n_nodes();
      Vector3 mean = Vector3::Zero();
      for (int i = 0; i < n; ++i) {
        mean += c.packing.position[node + i] / n;
      }
      for (int i = 0; i < n; ++i, ++node) {
        c.packing.position[node] += Vector3(0.3 * static_cast<double>(g), 0, 4.9 * static_cast<double>(g)) - mean;
      }
    }
    const bool walls = name == "walls";
    c.stages = {std::make_shared<PressDriver>(PressStage{
        .ends = walls ? PressStage::Ends::walls : PressStage::Ends::clamps, .velocity = 2e-2, .strain = 0.05})};
    return c;
  }
  c.stages = {std::make_shared<ShearDriver>(shear)};
  return c;
}

/// A whole run through the engine's public face.
void run_case(const std::string& name, const Ranks& ranks, Bits& bits) {
  Case c = case_of(name, ranks);
  Simulation simulation(std::move(c.packing), {}, c.options);
  Notes notes(bits);
  std::vector<Observer*> observers = {&notes};
  for (std::size_t stage = 0; stage < c.stages.size(); ++stage) {
    simulation.run(static_cast<int>(stage), *c.stages[stage], observers);
  }
  bits.add("step", static_cast<double>(simulation.step()));
  bits.add(simulation.snapshot(all_parts));
  // Not part of the outcome, but the run must have been what it says it is.
  if (ranks.is_distributed() && simulation.timings().halo_bytes == 0 && name != "clamps" && ranks.is_root()) {
    throw std::runtime_error("rank 0 has received no node of another");
  }
}

/// Mixed precision, stopped after each of 130 steps in a row and continued by a new simulation; the end must be that of
/// a run in one go.
void run_with_stops(const Ranks& ranks, Bits& bits) {
  const auto simulation = [&](Case& c) { return Simulation(std::move(c.packing), {}, c.options); };
  SavedState saved;
  constexpr std::int64_t first = 25, last = 155;
  for (std::int64_t stop = first; stop <= last; ++stop) {
    Case c = case_of("mixed", ranks);
    Simulation part = simulation(c);
    if (stop > first) {
      part.restore(saved);
    }
    part.run(0, *c.stages[0], {}, [&] { return part.step() == stop; });
    saved = part.save();
  }
  Case in_one_go = case_of("mixed", ranks), in_parts = case_of("mixed", ranks);
  Simulation whole = simulation(in_one_go), rest = simulation(in_parts);
  whole.run(0, *in_one_go.stages[0], {});
  rest.restore(saved);
  rest.run(0, *in_parts.stages[0], {});
  const Snapshot a = whole.snapshot(all_parts), b = rest.snapshot(all_parts);
  if (ranks.is_root() && (a.position != b.position || a.velocity != b.velocity || a.force != b.force)) {
    throw std::runtime_error("a run stopped at every step ends elsewhere");
  }
  bits.add("step", static_cast<double>(rest.step()));
  bits.add(b);
}

/// The same with bonds that break, but for some grains.
Packing twenty_breakable_grains() {
  Packing packing = twenty_grains();
  for (std::size_t g = 0; g < packing.grains.size(); ++g) {
    packing.grains[g].breaking = {.strain = g % 5 == 0 ? 0.0 : 0.12, .weibull_modulus = 6.0};
  }
  return packing;
}

/// Every few steps the grains get other owners, at random.
void run_migrating(Packing packing, const Ranks& ranks, Bits& bits) {
  Stepper stepper(std::move(packing), {}, {.ranks = &ranks});
  stepper.start();
  std::mt19937 random(5);
  for (int step = 0; step < 300; ++step) {
    if (step % 7 == 3 && ranks.is_distributed()) {
      std::vector<int> owner(stepper.packing().n_grains());
      for (int& rank : owner) {
        rank = static_cast<int>(random() % ranks.size());
      }
      move_grains(stepper.moving(), owner);
    }
    stepper.advance(step % 10 == 9 ? Virial::full : Virial::trace);
    stepper.move_cell({.shear = 3e-2, .dilation = 0.05 * (stepper.pressure() - 0.05)});
  }
  bits.add("strain", stepper.strain());
  for (int g = 0; g < stepper.packing().n_grains(); ++g) {
    double whole = 0.0;
    for (const int n : stepper.layout().holds(g) ? stepper.forces().survey(stepper.moving().state).whole_bonds(g)
                                                 : std::vector<int>{}) {
      whole += 0.5 * n;
    }
    whole = ranks.largest(whole);
    bits.add("whole bonds", whole);
    if (stepper.packing().grains[g].breaking.is_possible() &&
        whole == static_cast<double>(stepper.packing().template_of(g).bonds.size())) {
      throw std::runtime_error(fmt::format("no bond of grain {} has broken", g));
    }
  }
  bits.add(totals_of(stepper.moving()));
  bits.add(take_snapshot(stepper.moving(), all_parts));
}

/// An item's number, a vector and a list whose length differs from item to item, some of them empty.
struct DealtItem {
  double number = -1.0;
  Vector3 vector = Vector3::Zero();
  std::vector<Vector3> list;

  static DealtItem made(std::int64_t i) {
    const double x = std::sqrt(static_cast<double>(i));
    return {x, Vector3(x, -x, 2.0 * x), std::vector<Vector3>(i % 4, Vector3(0.5 * x, x, static_cast<double>(i)))};
  }
};

/// Items that are dealt out come back to every rank, in their order, however many there are.
void run_dealt(const Ranks& ranks, Bits& bits) {
  for (const int n : {0, 1, 2, 5, 40}) {
    const DealtItems items(ranks, n);
    std::vector<DealtItem> found(n);
    for (std::int64_t k = 0; k < items.n_own(); ++k) {
      found[items.own(k)] = DealtItem::made(items.own(k));
    }
    if (ranks.sum(items.n_own()) != n || ranks.largest(static_cast<double>(items.n_own())) > n / ranks.size() + 1) {
      throw std::runtime_error(fmt::format("{} items are not dealt out evenly", n));
    }
    items.share(found, &DealtItem::number);
    items.share(found, &DealtItem::vector);
    items.share(found, &DealtItem::list);
    for (int i = 0; i < n; ++i) {
      const DealtItem expected = DealtItem::made(i);
      if (found[i].number != expected.number || found[i].vector != expected.vector || found[i].list != expected.list) {
        throw std::runtime_error(fmt::format("item {} of {} is another's on rank {}", i, n, ranks.rank()));
      }
      bits.add("item", found[i].number);
      bits.add("item", found[i].vector);
    }
    std::vector<char> flags(n);
    for (std::int64_t k = 0; k < items.n_own(); ++k) {
      flags[items.own(k)] = items.own(k) % 3 == 0 ? 1 : 0;
    }
    ranks.any(flags);
    for (int i = 0; i < n; ++i) {
      bits.add("flag", flags[i]);
    }
  }
}

/// S(q) by both ways: every rank has what rank 0 has.
void run_scattering(const Ranks& ranks, Bits& bits) {
  const Packing packing = twenty_grains();
  const std::vector<std::int64_t> first_node = packing.first_nodes();
  const measure::GrainNodes grains(packing.position, first_node);
  const measure::ReciprocalLattice lattice(packing.box, 3.0);
  for (const auto& amplitudes : {measure::transformed_amplitudes(packing.box, grains, lattice, ranks),
                                 measure::summed_amplitudes(packing.box, grains, lattice, ranks)}) {
    for (const std::vector<double>& values : {amplitudes.intensity, amplitudes.form_factor}) {
      std::vector<double> of_root = values;
      ranks.broadcast(of_root);
      if (of_root != values) {
        throw std::runtime_error(fmt::format("rank {} has other amplitudes than rank 0", ranks.rank()));
      }
      for (const double value : values) {
        bits.add("amplitude", value);
      }
    }
  }
}

/// A node that flies off: all ranks hear of it.
void run_blow_up(const Ranks& ranks) {
  Packing packing = twenty_grains();
  packing.velocity[packing.first_nodes()[13] + 5] = Vector3(60.0, 0, 0);
  Simulation simulation(std::move(packing), {}, {.ranks = &ranks});
  simulation.run(0, HoldDriver({.time = 10.0}), {});
}

int work(int argc, char** argv, const Ranks& ranks) {
  const std::string name = argv[1];
  Bits bits;
  if (name == "migrating") {
    run_migrating(twenty_grains(), ranks, bits);
  } else if (name == "breaking") {
    run_migrating(twenty_breakable_grains(), ranks, bits);
  } else if (name == "stops") {
    run_with_stops(ranks, bits);
  } else if (name == "blow_up") {
    run_blow_up(ranks);
  } else if (name == "dealt") {
    run_dealt(ranks, bits);
  } else if (name == "scattering") {
    run_scattering(ranks, bits);
  } else {
    run_case(name, ranks, bits);
  }
  if (ranks.is_root() && argc > 2) {
    bits.write(argv[2]);
  }
  return 0;
}

} // namespace
} // namespace boba::test

int main(int argc, char** argv) {
  const boba::MessagePassing mpi;
  try {
    return boba::test::work(argc, argv, mpi.ranks());
  } catch (const boba::RankError& error) {
    if (mpi.ranks().is_root()) {
      fmt::print(stderr, "rank {}: {}\n", error.rank, error.what());
    }
    return 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    mpi.abort(1);
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Rounding: how an error grows against a more precise twin, and what ten million steps at rest do.
#include "bench/stability/cases.h"
#include "bench/stability/twin.h"
#include "bpm/dynamics/take_snapshot.h"

#include <cmath>

namespace boba::bench {

namespace {

const char* name_of(Precision precision) {
  return precision == Precision::full ? "double" : "mixed";
}

double distance(const Snapshot& snapshot, const Twin& twin) {
  double sum = 0.0;
  for (std::size_t i = 0; i < snapshot.position.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const auto d = static_cast<double>(static_cast<Twin::Real>(snapshot.position[i][c]) - twin.position()[i][c]);
      sum += d * d;
    }
  }
  return std::sqrt(sum / static_cast<double>(snapshot.position.size()));
}

/// A dense packing that is shaken: damped it comes to rest, undamped (alpha = 0, so that energy is kept) it stays
/// chaotic.
void error_growth(const Folder& folder) {
  OutputFile file = csv(folder, "rounding_growth", "alpha_kd,gamma,precision,time_tau,distance_d");
  struct Case {
    double alpha, gamma, speed;
  };
  for (const Case& c : {Case{0.0, 0.0, 0.02}, Case{2.0, 1.0, 0.2}, Case{12.0, 1.0, 0.2}}) {
    Packing packing = compressed({.n_nodes = 40, .alpha = c.alpha});
    shake(packing, c.speed);
    const Material material{.gamma = c.gamma};
    const double dt = 0.05;
    Stepper full(packing, material, {.dt = dt}), mixed(packing, material, {.dt = dt, .precision = Precision::mixed});
    Twin twin(packing, material, dt);
    full.start();
    mixed.start();
    twin.start();
    for (int step = 1; step <= 8000; ++step) {
      full.advance(Virial::none);
      mixed.advance(Virial::none);
      twin.advance();
      if (step % 100 == 0 || step < 10) {
        file.print("{},{},double,{},{:.3e}\n", c.alpha, c.gamma, full.time(),
                   distance(take_snapshot(full.moving(), {}), twin));
        file.print("{},{},mixed,{},{:.3e}\n", c.alpha, c.gamma, full.time(),
                   distance(take_snapshot(mixed.moving(), {}), twin));
      }
    }
    file.flush();
  }
  file.close();
}

/// An undamped grain at rest in long double: if it heats up too, the law does it and not the arithmetic.
void left_alone(const Folder& folder) {
  OutputFile file = csv(folder, "rounding_left_alone", "nodes,alpha_kd,time_tau,kinetic_kd2");
  for (const double alpha : {0.0, 2.0, 12.0}) {
    const auto grain = ball(100);
    const Packing packing = lone_grain(grain, alpha, 0.0);
    const double dt = 0.05;
    Twin twin(packing, Material{.gamma = 0.0}, dt);
    twin.start();
    for (int step = 1; step <= 60000; ++step) {
      twin.advance();
      const auto kinetic = static_cast<double>(twin.kinetic_energy());
      if (step % 400 == 0) {
        file.print("{},{},{},{:.6e}\n", grain->n_nodes(), alpha, dt * step, kinetic);
      }
      if (!(kinetic < 1e3)) {
        break;
      }
    }
    file.flush();
  }
  file.close();
}

} // namespace

void rounding(const Folder& folder) {
  error_growth(folder);
  left_alone(folder);
}

namespace {

/// A packing in its cell after its compression: does it drift or heat?
void rest_in(const Folder& folder, const std::string& name, Precision precision) {
  OutputFile file = csv(folder, name, "alpha_kd,precision,steps,P_k_d,kinetic_kd2,moved_d,centres_moved_d");
  const double alpha = 2.0;
  const Packing packing = compressed({.n_nodes = 40, .alpha = alpha, .tolerance = 1e-6});
  Stepper stepper(packing, {}, {.dt = 0.1, .precision = precision});
  stepper.start();
  Snapshot first;
  for (std::int64_t step = 1; step <= 10000000; ++step) {
    const bool look = step % 100000 == 0 || step == 1000 || step == 10000 || step == 30000;
    stepper.advance(look ? Virial::full : Virial::none);
    if (!look) {
      continue;
    }
    const Snapshot now = take_snapshot(stepper.moving(), {});
    first = step == 10000 ? now : first; // by then the last motion of the compression has died away
    double moved = 0.0, centres = 0.0;
    for (std::size_t i = 0; i < first.position.size(); ++i) {
      moved = std::max(moved, (now.position[i] - first.position[i]).norm());
    }
    for (std::size_t g = 0; g < first.grain_centre.size(); ++g) {
      centres = std::max(centres, (now.grain_centre[g] - first.grain_centre[g]).norm());
    }
    file.print("{},{},{},{:.15g},{:.6e},{:.3e},{:.3e}\n", alpha, name_of(precision), step, stepper.pressure(),
               stepper.kinetic_energy(), moved, centres);
    file.flush();
  }
  file.close();
}

} // namespace

void rest(const Folder& folder) {
  rest_in(folder, "rest", Precision::full);
}

void rest_mixed(const Folder& folder) {
  rest_in(folder, "rest_mixed", Precision::mixed);
}

} // namespace boba::bench

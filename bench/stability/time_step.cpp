// SPDX-License-Identifier: GPL-3.0-or-later
// The largest stable time step: of the linearised operator, and by experiment.
#include "bench/stability/cases.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/dynamics/stable_step.h"
#include "bpm/dynamics/take_snapshot.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

namespace boba::bench {

namespace {

constexpr double quiet_speed = 1e-9; ///< d/tau: what grows stays small for long

/// Growth of the velocities a step, from the kinetic energy over the second half of a run; infinity when it blew up.
double growth_a_step(Packing packing, const Material& material, double dt, int n_steps) {
  shake(packing, quiet_speed);
  Stepper stepper(std::move(packing), material, {.dt = dt});
  stepper.start();
  double middle = 0.0;
  try {
    for (int step = 1; step <= n_steps; ++step) {
      stepper.advance(Virial::trace);
      const double kinetic = stepper.kinetic_energy();
      if (!std::isfinite(kinetic) || kinetic > 1e-4) {
        return std::pow(kinetic / (quiet_speed * quiet_speed), 0.5 / step);
      }
      middle = step == n_steps / 2 ? kinetic : middle;
    }
  } catch (const BlowUp&) {
    return INFINITY;
  }
  const auto last_half = n_steps - n_steps / 2;
  return std::pow(stepper.kinetic_energy() / middle, 0.5 / last_half);
}

/// Bisects for the step at which velocities begin to grow by `limit` a step, to 0.2 %.
double largest_step(const Packing& packing, const Material& material, double limit, double guess) {
  const int n_steps = 1000;
  double low = 0.5 * guess, high = 1.5 * guess;
  while (high / low > 1.002) {
    const double middle = std::sqrt(low * high);
    (growth_a_step(packing, material, middle, n_steps) > limit ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

/// Without damping the many-body term makes grains grow slowly at any step; a step beyond the limit shows at once.
double growth_limit(double gamma) {
  return gamma > 0.0 ? 1.002 : 1.05;
}

void lone_grains(const Folder& folder) {
  OutputFile file = csv(folder, "time_step_grain", "nodes,alpha_kd,gamma,linear_tau,experiment_tau");
  for (const int n : {60, 300, 5137}) {
    for (const double alpha : alphas) {
      for (const double gamma : {1.0, 0.0}) {
        const Material material{.gamma = gamma};
        const double linear = stable_step(*ball(n), material, alpha);
        const double found =
            n < 1000 ? largest_step(lone_grain(ball(n), alpha, 0.0), material, growth_limit(gamma), linear) : NAN;
        file.print("{},{},{},{:.6f},{:.6f}\n", n, alpha, gamma, linear, found);
      }
    }
  }
  file.close();
}

/// Forces on all nodes of a packing.
std::vector<Vector3> forces_on(const Packing& packing, const Material& material) {
  Stepper stepper(packing, material, {});
  stepper.evaluate_only();
  return take_snapshot(stepper.moving(), {.force = true}).force;
}

/// The same power iteration as `stable_step`, with the engine's forces differentiated about a packing's present state:
/// bonds under stress and contacts are in it.
double step_of_packing(const Packing& packing, const Material& material) {
  Packing probe = packing;
  shake(probe, 1.0);
  std::vector<Vector3> u = probe.velocity;
  const double h = 1e-6;
  double dt = 0.1;
  const auto change = [&](bool of_velocity) {
    std::vector<Vector3> sum(u.size(), Vector3::Zero());
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t i = 0; i < u.size(); ++i) {
        probe.position[i] = packing.position[i] + (of_velocity ? 0.0 : sign * h) * u[i];
        probe.velocity[i] = (of_velocity ? sign * h : 0.0) * u[i];
      }
      const std::vector<Vector3> f = forces_on(probe, material);
      for (std::size_t i = 0; i < u.size(); ++i) {
        sum[i] -= sign * f[i] / (2.0 * h);
      }
    }
    return sum;
  };
  const auto dot = [&u](const std::vector<Vector3>& other) {
    double sum = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      sum += u[i].dot(other[i]);
    }
    return sum;
  };
  for (int iteration = 0; iteration < 120; ++iteration) {
    const double length = std::sqrt(dot(u));
    for (Vector3& v : u) {
      v /= length;
    }
    const std::vector<Vector3> stiff = change(false);
    const std::vector<Vector3> damped =
        material.gamma > 0.0 ? change(true) : std::vector<Vector3>(u.size(), Vector3::Zero());
    const double w2 = dot(stiff), c = dot(damped);
    dt = 4.0 / (c + std::sqrt(c * c + 4.0 * w2));
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = dt * dt * stiff[i] + 2.0 * dt * damped[i] - 1.8 * u[i];
    }
  }
  return dt;
}

double largest_overlap(const Packing& packing) {
  Stepper stepper(packing, {}, {});
  stepper.evaluate_only();
  return totals_of(stepper.moving()).largest_overlap;
}

/// Runs a damped packing in its cell until what grows from a whisper can be told from what is left of its motion.
Packing settled(const Packing& packing) {
  Stepper stepper(packing, {}, {.dt = 0.04});
  stepper.start();
  for (int step = 1; step <= 400000; ++step) {
    stepper.advance(step % 100 == 0 ? Virial::trace : Virial::none);
    if (step % 100 == 0 && stepper.kinetic_energy() < 1e-22) {
      return packing_of(packing, take_snapshot(stepper.moving(), {}));
    }
  }
  throw std::runtime_error("a packing does not come to rest");
}

void pressed(OutputFile& file, double alpha, double pressure) {
  const Packing packing = settled(compressed({.n_nodes = 60, .alpha = alpha, .pressure = pressure}));
  for (const double gamma : {1.0, 0.0}) {
    const Material material{.gamma = gamma};
    const double linear = step_of_packing(packing, material);
    file.print("{},{},{:.4f},{},{:.6f},{:.6f},{:.6f}\n", alpha, pressure, largest_overlap(packing), gamma,
               stable_step(*packing.templates[0], material, alpha), linear,
               largest_step(packing, material, growth_limit(gamma), linear));
    file.flush();
  }
}

/// Two nodes at an overlap, held there: the closed form, and with one of them bonded in a grain the bound by the sum.
void pairs(const Folder& folder) {
  OutputFile file = csv(folder, "time_step_contact", "overlap_d,gamma,pair_tau");
  for (int k = 0; k <= 25; ++k) {
    const double overlap = 0.02 * k;
    for (const double gamma : {1.0, 0.0}) {
      const Material material{.gamma = gamma};
      const double w2 = 2.0 * (material.k + 3.0 * material.k3 * overlap * overlap);
      const double c = 2.0 * gamma * (1.0 - std::pow(1.0 - overlap, 8));
      file.print("{:.2f},{},{:.6f}\n", overlap, gamma, 4.0 / (c + std::sqrt(c * c + 4.0 * w2)));
    }
  }
  file.close();
}

/// Steps until a run beyond the limit is stopped, from the agitation of a gently and a fast sheared packing.
void beyond(const Folder& folder) {
  OutputFile file = csv(folder, "time_step_beyond", "alpha_kd,over_limit,speed_d_tau,steps_to_detection");
  for (const double alpha : alphas) {
    const double limit = stable_step(*ball(300), {}, alpha);
    for (const double factor : {1.02, 1.05, 1.1, 1.2, 1.5, 2.0}) {
      for (const double speed : {1e-4, 1e-2}) {
        Stepper stepper(lone_grain(ball(300), alpha, speed), {}, {.dt = factor * limit});
        stepper.start();
        int steps = 0;
        try {
          for (; steps < 2000; ++steps) {
            stepper.advance(Virial::none);
          }
        } catch (const BlowUp&) {
        }
        file.print("{},{},{},{}\n", alpha, factor, speed, steps);
      }
    }
  }
  file.close();
}

} // namespace

void time_step(const Folder& folder) {
  pairs(folder);
  beyond(folder);
  lone_grains(folder);
}

void contacts(const Folder& folder) {
  OutputFile file =
      csv(folder, "time_step_packing", "alpha_kd,P_normalised,overlap_d,gamma,bonds_tau,linear_tau,experiment_tau");
  for (const double alpha : {20.0, 12.0, 2.0, 0.0, -0.8}) {
    for (const double pressure : {0.01, 0.03, 0.1, 0.3, 1.0, 2.0}) {
      try {
        pressed(file, alpha, pressure);
      } catch (const std::runtime_error& error) { // stiffer than its contacts: no such packing
        fmt::print(stderr, "alpha = {}, P~ = {}: {}\n", alpha, pressure, error.what());
      }
    }
  }
  file.close();
}

} // namespace boba::bench

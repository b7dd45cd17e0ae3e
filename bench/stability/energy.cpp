// SPDX-License-Identifier: GPL-3.0-or-later
// Ledgers over closed strain cycles, and undamped grains left alone: does the law pump or lose energy?
#include "bench/stability/cases.h"
#include "bench/stability/ledger.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/dynamics/take_snapshot.h"

#include <cmath>
#include <functional>
#include <numbers>

namespace boba::bench {

namespace {

/// Deformation gradient of a cell at a phase; 0 and 1 are the same.
using Path = std::function<Matrix3(double)>;

struct Cycle {
  Path path;
  double period = 500.0; ///< tau
  int n_samples = 1000;  ///< of the ledger; the cell's velocity gradient is constant between two
};

/// Moves the cell along a part of the path and books what happens.
class Deformation {
public:
  Deformation(Packing packing, const Material& material, double dt)
      : stepper_(packing, material, {.dt = dt}), packing_(std::move(packing)), ledger_(packing_, material) {
    stepper_.start();
  }

  Account follow(const Cycle& cycle, double from, double to) {
    Account account;
    const double sample_time = cycle.period / cycle.n_samples;
    const int steps = std::max(1, static_cast<int>(std::round(sample_time / stepper_.options().dt)));
    const auto n = static_cast<int>(std::round((to - from) * cycle.n_samples));
    const auto gradient_of = [&](int k) -> Matrix3 { // ln of a path near the identity, over the sample's time
      const Matrix3 step =
          cycle.path(from + (to - from) * (k + 1) / n) * cycle.path(from + (to - from) * k / n).inverse();
      const Matrix3 e = step - Matrix3::Identity();
      return (e - 0.5 * e * e + e * e * e / 3.0) / (steps * stepper_.options().dt);
    };
    Matrix3 before = gradient_of(0);
    Powers last = sample(before);
    account.begin = last;
    for (int k = 0; k < n; ++k) {
      const Matrix3 gradient = gradient_of(k);
      for (int step = 0; step < steps; ++step) {
        stepper_.deform_cell(gradient, gradient);
        stepper_.advance(step + 1 == steps ? Virial::full : Virial::trace);
      }
      const Matrix3 next = k + 1 < n ? gradient_of(k + 1) : gradient;
      const Powers now = sample(0.5 * (gradient + next)); // the affine motion's rate at the sample itself
      add(account, last, now, steps * stepper_.options().dt);
      last = now;
    }
    account.end = last;
    return account;
  }

  double pressure() const { return stepper_.pressure(); }

private:
  Powers sample(const Matrix3& gradient) {
    if (stepper_.step() == 0) {
      Snapshot at_rest = take_snapshot(stepper_.moving(), {});
      at_rest.velocity.assign(at_rest.position.size(), Vector3::Zero());
      return ledger_.at(at_rest, gradient);
    }
    return ledger_.at(take_snapshot(stepper_.moving(), {.velocity = true}), gradient);
  }

  static void add(Account& account, const Powers& a, const Powers& b, double time) {
    account.box += 0.5 * time * (a.box + b.box);
    account.many_body += 0.5 * time * (a.many_body + b.many_body);
    account.damping += 0.5 * time * (a.damping + b.damping);
    account.damping_box += 0.5 * time * (a.damping_box + b.damping_box);
  }

  Stepper stepper_;
  Packing packing_;
  Ledger ledger_;
};

const std::string columns = "box_kd2,many_body_kd2,damping_kd2,damping_box_kd2,stored_kd2,residue_kd2,elastic_kd2";

std::string row(const Account& a) {
  return fmt::format("{:.6e},{:.6e},{:.6e},{:.6e},{:.6e},{:.6e},{:.6e}", a.box, a.many_body, a.damping, a.damping_box,
                     a.stored(), a.residue(), a.end.bonds + a.end.contacts);
}

/// A loop that encloses an area in the plane of two strains: a force law with an energy does no work on it.
Path loop(double amplitude, double sense) {
  return [=](double phase) -> Matrix3 {
    const double angle = 2.0 * std::numbers::pi * phase;
    return Vector3(1.0 + amplitude * std::cos(angle), 1.0 + sense * amplitude * std::sin(angle), 1.0).asDiagonal();
  };
}

/// To where the loop begins.
Path ramp(double amplitude) {
  return [=](double phase) -> Matrix3 { return Vector3(1.0 + amplitude * phase, 1.0, 1.0).asDiagonal(); };
}

void bulk_loops(const Folder& folder) {
  OutputFile file = csv(folder, "energy_loops", "nodes,alpha_kd,gamma,amplitude,sense,period_tau," + columns);
  const auto cube = periodic_cube(6.0);
  const auto run = [&](double alpha, double gamma, double amplitude, double sense, double period) {
    const auto prefix = [&] {
      return fmt::format("{},{},{},{},{},{}", cube->n_nodes(), alpha, gamma, amplitude, sense, period);
    };
    try {
      Deformation deformation(bulk(cube, alpha), Material{.gamma = gamma}, 0.1);
      deformation.follow({ramp(amplitude), 0.25 * period, 250}, 0.0, 1.0);
      deformation.follow({loop(amplitude, sense), period, 1000}, 0.0, 1.0);
      file.print("{},{}\n", prefix(), row(deformation.follow({loop(amplitude, sense), period, 1000}, 0.0, 1.0)));
    } catch (const BlowUp&) {
      file.print("{},nan,nan,nan,nan,nan,nan,nan\n", prefix());
    }
    file.flush();
  };
  for (const double alpha : alphas) {
    for (const double amplitude : {0.01, 0.03, 0.1}) {
      run(alpha, 1.0, amplitude, 1.0, 500.0);
      run(alpha, 1.0, amplitude, -1.0, 500.0);
    }
    run(alpha, 1.0, 0.03, 1.0, 1000.0); // the same more slowly: what stays is not the damping's
    run(alpha, 0.0, 0.03, 1.0, 500.0);
  }
  file.close();
}

/// The same loop for larger and larger pieces of bulk: does the work per energy vanish where the network looks
/// isotropic?
void bulk_sizes(const Folder& folder) {
  OutputFile file = csv(folder, "energy_sizes", "edge_d,nodes,alpha_kd,sense," + columns);
  for (const double edge : {5.0, 6.0, 8.0, 11.0, 14.0}) {
    const auto cube = periodic_cube(edge);
    for (const double alpha : {2.0, 12.0}) {
      for (const double sense : {1.0, -1.0}) {
        Deformation deformation(bulk(cube, alpha), Material{}, 0.1);
        deformation.follow({ramp(0.03), 60.0, 100}, 0.0, 1.0);
        file.print("{},{},{},{},{}\n", edge, cube->n_nodes(), alpha, sense,
                   row(deformation.follow({loop(0.03, sense), 200.0, 400}, 0.0, 1.0)));
        file.flush();
      }
    }
  }
  file.close();
}

/// Cyclic shear of a packing at P~ = 0.1 with fixed volume, as an experiment would do it.
void packing_cycles(const Folder& folder) {
  OutputFile file = csv(folder, "energy_packing", "grains,nodes,alpha_kd,gamma,amplitude,cycle," + columns);
  for (const double alpha : {-0.8, 0.0, 2.0, 12.0}) {
    for (const double gamma : {1.0, 0.0}) {
      for (const double amplitude : {0.01, 0.05}) {
        const PackingSpec spec{.n_nodes = 60, .alpha = alpha};
        try {
          Deformation deformation(compressed(spec), Material{.gamma = gamma}, 0.05);
          const Path shear = [=](double phase) -> Matrix3 {
            Matrix3 f = Matrix3::Identity();
            f(0, 1) = amplitude * std::sin(2.0 * std::numbers::pi * phase);
            return f;
          };
          for (int cycle = 1; cycle <= 3; ++cycle) {
            const Account account = deformation.follow({shear, 400.0, 2000}, 0.0, 1.0);
            file.print("{},{},{},{},{},{},{}\n", spec.n_grains, spec.n_nodes, alpha, gamma, amplitude, cycle,
                       row(account));
          }
        } catch (const BlowUp&) {
          file.print("{},{},{},{},{},0,nan,nan,nan,nan,nan,nan,nan\n", spec.n_grains, spec.n_nodes, alpha, gamma,
                     amplitude);
        }
        file.flush();
      }
    }
  }
  file.close();
}

/// A grain at rest, without damping: what becomes of the rounding errors.
void left_alone(const Folder& folder) {
  OutputFile file = csv(folder, "energy_left_alone", "nodes,alpha_kd,precision,time_tau,kinetic_kd2,elastic_kd2");
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    for (const double alpha : alphas) {
      const auto grain = ball(100);
      Stepper stepper(lone_grain(grain, alpha, 0.0), Material{.gamma = 0.0}, {.dt = 0.05, .precision = precision});
      const char* name = precision == Precision::full ? "double" : "mixed";
      stepper.start();
      try {
        for (int step = 1; step <= 120000; ++step) {
          const bool look = step % 400 == 0;
          stepper.advance(look ? Virial::full : Virial::none);
          if (look) {
            file.print("{},{},{},{},{:.6e},{:.6e}\n", grain->n_nodes(), alpha, name, stepper.time(),
                       stepper.kinetic_energy(), stepper.bond_energy());
          }
        }
      } catch (const BlowUp&) {
        file.print("{},{},{},{},inf,inf\n", grain->n_nodes(), alpha, name, stepper.time());
      }
      file.flush();
    }
  }
  file.close();
}

} // namespace

void energy(const Folder& folder) {
  left_alone(folder);
  bulk_loops(folder);
}

void cycles(const Folder& folder) {
  packing_cycles(folder);
  bulk_sizes(folder);
}

} // namespace boba::bench

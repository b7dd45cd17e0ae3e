// SPDX-License-Identifier: GPL-3.0-or-later
// Momentum and angular momentum of a free, turning, vibrating grain over a million steps.
#include "bench/stability/cases.h"
#include "bpm/dynamics/take_snapshot.h"

#include <cmath>

namespace boba::bench {

namespace {

struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
  double kinetic = 0.0;
};

Momenta momenta(const Snapshot& snapshot) {
  Momenta sum;
  for (std::size_t i = 0; i < snapshot.position.size(); ++i) {
    sum.linear += snapshot.velocity[i];
    sum.angular += snapshot.position[i].cross(snapshot.velocity[i]);
    sum.kinetic += 0.5 * snapshot.velocity[i].squaredNorm();
  }
  return sum;
}

} // namespace

void conservation(const Folder& folder) {
  OutputFile file =
      csv(folder, "conservation", "nodes,alpha_kd,gamma,precision,steps,momentum_error,angular_error,kinetic_kd2");
  struct Case {
    double alpha, gamma;
    Precision precision;
  };
  for (const Case& c :
       {Case{0.0, 0.0, Precision::full}, Case{0.0, 1.0, Precision::full}, Case{2.0, 1.0, Precision::full},
        Case{12.0, 1.0, Precision::full}, Case{2.0, 1.0, Precision::mixed}}) {
    const auto grain = ball(100);
    Packing packing = lone_grain(grain, c.alpha, 0.05);
    const Vector3 spin(0.003, -0.002, 0.004);
    Vector3 drift = Vector3::Zero();
    for (const Vector3& v : packing.velocity) {
      drift += v / static_cast<double>(packing.velocity.size());
    }
    for (std::size_t i = 0; i < packing.velocity.size(); ++i) { // turning, and moving so little that it stays in sight
      packing.velocity[i] += spin.cross(packing.position[i]) - drift + Vector3(1e-5, 2e-5, -1e-5);
    }
    Stepper stepper(packing, Material{.gamma = c.gamma}, {.dt = 0.1, .precision = c.precision});
    stepper.start();
    // Full-step momenta: those of the half step turn with the forces.
    const Momenta begin = momenta(take_snapshot(stepper.moving(), {.velocity = true}));
    for (int step = 1; step <= 1000000; ++step) {
      const bool look = step % 20000 == 0 || (step < 20000 && step % 1000 == 0);
      stepper.advance(look ? Virial::full : Virial::none);
      if (look) {
        const Momenta now = momenta(take_snapshot(stepper.moving(), {.velocity = true}));
        file.print("{},{},{},{},{},{:.3e},{:.3e},{:.6e}\n", grain->n_nodes(), c.alpha, c.gamma,
                   c.precision == Precision::full ? "double" : "mixed", step,
                   (now.linear - begin.linear).norm() / begin.linear.norm(),
                   (now.angular - begin.angular).norm() / begin.angular.norm(), now.kinetic);
      }
    }
    file.flush();
  }
  file.close();
}

} // namespace boba::bench

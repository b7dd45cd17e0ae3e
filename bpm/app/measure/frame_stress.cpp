// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/frame_stress.h"

#include "bpm/forces/force_field.h"
#include "bpm/parallel/placement.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

constexpr double contact_skin = 0.05; ///< d; a frame's list is used a few times for the same positions
constexpr int max_iterations = 30;
constexpr double relative_change = 1e-12; ///< of the stress, at which the half-step velocities have settled

} // namespace

struct FrameStress::Impl {
  Impl(Packing packing_in, const Material& material_in, double dt_in, const Ranks& ranks)
      : packing(std::move(packing_in)), material(material_in), dt(dt_in), first_node(packing.first_nodes()),
        distribution(distribute(packing, ranks, Precision::full)),
        layout(packing, Precision::full, own_grains(packing, distribution)), state(packing, layout),
        forces(packing, layout, material, contact_skin, distribution) {}

  void place(const Snapshot& snapshot) {
    for (const int g : layout.grains()) {
      for (int node = 0; node < layout.n_nodes(g); ++node) {
        const std::int64_t i = first_node[g] + node;
        state.set_position(g, node, snapshot.position[i]);
        state.set_velocity(g, node, snapshot.velocity.empty() ? Vector3(Vector3::Zero()) : snapshot.velocity[i]);
      }
    }
    forces.forget_contacts();
  }

  /// v = v(n) - dt/(2m) f, with the forces evaluated last.
  void step_back(const Snapshot& snapshot) {
    const double back = 0.5 * dt / material.node_mass;
    for (const int g : layout.grains()) {
      for (int node = 0; node < layout.n_nodes(g); ++node) {
        state.set_velocity(g, node, snapshot.velocity[first_node[g] + node] - back * state.force(g, node));
      }
    }
  }

  /// Forces and sums at the present velocities; returns the largest component of the sum over the grains.
  double evaluate(const Snapshot& snapshot, double half_kick) {
    Matrix3 gradient = Matrix3::Zero();
    gradient(0, 1) = snapshot.streaming_rate;
    forces.evaluate(state, snapshot.box,
                    {.half_kick = half_kick,
                     .virial = Virial::full,
                     .keep_forces = true,
                     .residual_rate = gradient * snapshot.box.h()});
    forces.share_sums(Virial::full);
    grain.assign(layout.n_grains(), {});
    double size = 0.0;
    Tensor6 total{};
    for (int g = 0; g < layout.n_grains(); ++g) {
      const GrainSums& sums = forces.grain_sums()[g];
      for (int c = 0; c < 6; ++c) {
        grain[g][c] = -(sums.virial[c] + sums.kinetic[c]);
        total[c] += grain[g][c];
        size = std::max(size, std::abs(total[c]));
      }
    }
    change = 0.0;
    for (int c = 0; c < 6; ++c) {
      change = std::max(change, std::abs(total[c] - last_total[c]));
    }
    last_total = total;
    return size;
  }

  Packing packing;
  Material material;
  double dt;
  std::vector<std::int64_t> first_node; ///< per grain, in a snapshot
  Distribution distribution;
  LaneLayout layout; ///< of this rank's grains
  LaneState state;
  ForceField forces;
  std::vector<Tensor6> grain;
  Tensor6 last_total{};
  double change = 0.0;
};

FrameStress::FrameStress(Packing packing, const Material& material, double dt, const Ranks& ranks)
    : impl_(std::make_unique<Impl>(std::move(packing), material, dt, ranks)) {}
FrameStress::~FrameStress() = default;

std::vector<std::array<double, 6>> FrameStress::evaluate(const Snapshot& snapshot) {
  Impl& in = *impl_;
  if (snapshot.position.size() != in.packing.position.size()) {
    throw std::invalid_argument(fmt::format("stress of a frame: {} nodes, but the packing has {}",
                                            snapshot.position.size(), in.packing.position.size()));
  }
  in.place(snapshot);
  double size = in.evaluate(snapshot, 0.0);
  // Forces of the first step saw the velocities as they are; those of later steps the velocities half a step before.
  if (!snapshot.velocity.empty() && in.dt > 0.0 && snapshot.step > 0) {
    in.change = size;
    for (int k = 0; k < max_iterations && in.change > relative_change * size; ++k) {
      in.step_back(snapshot);
      size = in.evaluate(snapshot, 0.5 * in.dt);
    }
  }
  return in.grain;
}

} // namespace boba

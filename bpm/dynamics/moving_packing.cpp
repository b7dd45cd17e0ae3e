// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/moving_packing.h"

#include "bpm/parallel/placement.h"

namespace boba {

MovingPacking::MovingPacking(Packing packing_in, const Material& material_in, const SimulationOptions& options_in)
    : packing(std::move(packing_in)), material(material_in), options(options_in),
      distribution(distribute(packing, *options.ranks, options.precision)),
      layout(packing, options.precision, own_grains(packing, distribution)), state(packing, layout),
      forces(packing, layout, material, options.skin, distribution), cell(packing.box), ends(forces.walls()) {
  cell.add_strain(packing.strain);
  ends.set_faces(packing.box, packing.walls);
  if (!ranks().is_root()) { // rank 0 alone writes
    for (std::vector<Vector3>* big : {&packing.position, &packing.velocity}) {
      std::vector<Vector3>().swap(*big);
    }
    std::vector<std::int64_t>().swap(packing.id);
  }
}

Timings timings_of(const MovingPacking& moving) {
  const ForceField::Seconds& seconds = moving.forces.seconds();
  const ContactHalo::Traffic traffic = moving.forces.traffic();
  Timings timings;
  timings.bonds = seconds.bonds;
  timings.contacts = seconds.contacts;
  timings.search = seconds.search;
  timings.integration = moving.integration_seconds;
  timings.steps = moving.step;
  timings.list_builds = moving.forces.n_list_builds();
  timings.halo = seconds.halo;
  timings.reductions = moving.reduction_seconds;
  timings.halo_messages = traffic.messages;
  timings.halo_bytes = traffic.bytes;
  timings.halo_builds = traffic.rebuilds;
  timings.migrated_grains = moving.migrated_grains;
  return timings;
}

std::size_t bytes_of(const MovingPacking& moving) {
  const Packing& packing = moving.packing;
  const ForceSums& sums = moving.forces.sums();
  return moving.state.bytes() + moving.layout.bytes() + moving.forces.contact_bytes() +
         sums.grains.capacity() * sizeof(GrainSums) + sums.contacts.capacity() * sizeof(kernels::ContactSums) +
         packing.grains.capacity() * sizeof(Grain) +
         (packing.position.capacity() + packing.velocity.capacity()) * sizeof(Vector3) +
         packing.id.capacity() * sizeof(std::int64_t);
}

} // namespace boba

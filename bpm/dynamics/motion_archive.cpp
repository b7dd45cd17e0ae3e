// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/motion_archive.h"

#include "bpm/dynamics/node_exchange.h"

#include <cstring>
#include <utility>

namespace boba {

namespace {

/// Takes the next number of type T from packed nodes.
template <class T> T next(const std::byte*& from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  from += sizeof value;
  return value;
}

/// Packed nodes (x v f of each component in turn) as columns of numbers.
template <class Coordinate, class Real, class Stored>
void unpack_columns(const std::vector<std::byte>& nodes, std::vector<Stored>& x, std::vector<double>& v,
                    std::vector<double>& f) {
  for (const std::byte* from = nodes.data(); from != nodes.data() + nodes.size();) {
    x.push_back(static_cast<Stored>(next<Coordinate>(from)));
    v.push_back(next<Real>(from));
    f.push_back(next<Real>(from));
  }
}

template <class Coordinate, class Real, class Stored>
std::vector<std::byte> pack_columns(const std::vector<Stored>& x, const std::vector<double>& v,
                                    const std::vector<double>& f) {
  const std::size_t n = x.size();
  std::vector<std::byte> nodes(n * (sizeof(Coordinate) + 2 * sizeof(Real)));
  std::byte* to = nodes.data();
  const auto put = [&](auto value) {
    std::memcpy(to, &value, sizeof value);
    to += sizeof value;
  };
  for (std::size_t k = 0; k < n; ++k) {
    put(static_cast<Coordinate>(x[k]));
    put(static_cast<Real>(v[k]));
    put(static_cast<Real>(f[k]));
  }
  return nodes;
}

// Node by node in the packing's order, each rank its own: put together the same whatever the lanes and the ranks.
void save_nodes(Archive& archive, const MovingPacking& moving) {
  const std::vector<std::byte> nodes = own_nodes(moving);
  const bool is_full = moving.options.precision == Precision::full;
  std::vector<double> x, v, f;
  std::vector<std::int64_t> fixed_x;
  if (is_full) {
    unpack_columns<double, double>(nodes, x, v, f);
  } else {
    unpack_columns<std::int32_t, float>(nodes, fixed_x, v, f);
    std::vector<Vector3> origins = moving.state.origins();
    share_grains(moving, origins);
    archive.field("origin", origins);
  }
  const std::vector<std::int64_t> shape = {static_cast<std::int64_t>(v.size() / 3), 3};
  archive.save("position", is_full ? SavedValue{std::move(x), shape} : SavedValue{std::move(fixed_x), shape});
  archive.save("velocity", {std::move(v), shape});
  archive.save("force", {std::move(f), shape});
}

void restore_nodes(const Archive& archive, MovingPacking& moving) {
  std::vector<std::byte> nodes;
  moving.ranks().on_root([&] {
    const std::vector<std::int64_t> shape = {moving.packing.first_nodes().back(), 3};
    const std::vector<double>&v = archive.real_values("velocity", shape), &f = archive.real_values("force", shape);
    nodes = moving.options.precision == Precision::full
                ? pack_columns<double, double>(archive.real_values("position", shape), v, f)
                : pack_columns<std::int32_t, float>(archive.integer_values("position", shape), v, f);
  });
  scatter_nodes(moving, nodes);
  if (moving.options.precision == Precision::mixed) {
    const auto n_grains = static_cast<std::int64_t>(moving.state.origins().size());
    const std::vector<double>& origins = archive.real_values("origin", {n_grains, 3});
    for (std::size_t g = 0; g < moving.state.origins().size(); ++g) {
      moving.state.origins()[g] = Eigen::Map<const Vector3>(&origins[3 * g]);
    }
  }
}

/// What bonds remember: nothing where they remember nothing.
void save_memory(Archive& archive, const MovingPacking& moving) {
  const int n_slots = moving.layout.memory_slots();
  if (n_slots == 0) {
    return;
  }
  std::vector<double> rows;
  for (const int g : moving.layout.grains()) {
    const std::vector<double> of_grain = moving.state.memory_rows(g);
    rows.insert(rows.end(), of_grain.begin(), of_grain.end());
  }
  gather_rows(moving, n_slots, rows);
  if (moving.ranks().is_root()) {
    archive.save("bond_memory", {std::move(rows), {moving.packing.first_nodes().back(), n_slots}});
  }
}

void restore_memory(const Archive& archive, MovingPacking& moving) {
  const std::int64_t n_slots = moving.layout.memory_slots();
  if (n_slots == 0) {
    return;
  }
  const std::vector<std::int64_t> first = moving.packing.first_nodes();
  const std::vector<double>& rows = archive.real_values("bond_memory", {first.back(), n_slots});
  for (const int g : moving.layout.grains()) {
    moving.state.set_memory_rows(g, rows.data() + n_slots * first[g]);
  }
  moving.forces.bonds_changed();
}

void archive_cell(Archive& archive, MovingCell& cell) {
  MovingCell::Saved saved = cell.saved();
  archive.field("h", saved.h);
  archive.field("evaluated_h", saved.evaluated_h);
  archive.field("map", saved.map);
  archive.field("position_map", saved.position_map);
  archive.field("residual_rate", saved.residual_rate);
  archive.field("streaming", saved.streaming);
  archive.field("next_streaming", saved.next_streaming);
  archive.field("strain", saved.strain);
  if (archive.is_reading()) {
    cell.restore(saved);
  }
}

void archive_ends(Archive& archive, MovingPacking& moving) {
  double gap = moving.ends.gap();
  archive.field("gap", gap);
  std::vector<Wall> walls(moving.forces.walls().begin(), moving.forces.walls().end());
  archive.objects("walls", walls, [](Archive& a, Wall& wall) {
    a.field("point", wall.point);
    a.field("normal", wall.normal);
    a.field("velocity", wall.velocity);
    a.field("force", wall.force);
  });
  archive.objects("clamps", moving.ends.clamps(), [](Archive& a, Clamp& clamp) {
    a.field("grain", clamp.grain);
    a.field("node", clamp.node);
    a.field("velocity", clamp.velocity);
    a.field("force", clamp.force);
  });
  if (archive.is_reading()) {
    moving.ends.set_gap(gap);
    moving.forces.walls().set(std::move(walls));
  }
}

} // namespace

void archive_motion(Archive& archive, MovingPacking& moving) {
  if (archive.is_reading()) {
    restore_nodes(archive, moving);
    restore_memory(archive, moving);
    moving.forces.forget_contacts();
  } else {
    save_nodes(archive, moving);
    save_memory(archive, moving);
  }
  archive.inside("cell", [&] { archive_cell(archive, moving.cell); });
  archive.inside("ends", [&] { archive_ends(archive, moving); });
  archive.field("pressure", moving.pressure);
  archive.field("kinetic_energy", moving.kinetic_energy);
  archive.field("noted_momentum", moving.noted_momentum);
  archive.field("momentum_along_gradient", moving.momentum_along_gradient);
  archive.field("step", moving.step);
  archive.field("started", moving.started);
  archive.field("forces_kept", moving.forces_kept);
}

} // namespace boba

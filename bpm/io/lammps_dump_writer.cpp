// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/lammps_dump.h"

#include <algorithm>
#include <array>
#include <string>

namespace boba {

namespace {

/// Rows in ascending order of id.
std::vector<std::int64_t> order_by_id(const std::vector<std::int64_t>& ids) {
  std::vector<std::int64_t> order(ids.size());
  for (std::size_t row = 0; row < ids.size(); ++row) {
    order[row] = static_cast<std::int64_t>(row);
  }
  std::sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) { return ids[a] < ids[b]; });
  return order;
}

void print_box(OutputFile& out, const Box& box) {
  // One form for a periodic cell, tilted or not yet: LAMMPS's read_dump stops where the form changes within a file.
  const std::array<bool, 3>& directions = box.periodic();
  const bool is_tilted = box.xy() != 0.0 || box.xz() != 0.0 || box.yz() != 0.0 ||
                         std::any_of(directions.begin(), directions.end(), [](bool is) { return is; });
  const double xy = box.xy(), xz = box.xz(), yz = box.yz();
  const Vector3 low = box.origin() + Vector3(std::min({0.0, xy, xz, xy + xz}), std::min(0.0, yz), 0.0);
  const Vector3 high = box.origin() + box.lengths() + Vector3(std::max({0.0, xy, xz, xy + xz}), std::max(0.0, yz), 0.0);
  out.print("ITEM: BOX BOUNDS{}", is_tilted ? " xy xz yz" : "");
  for (const bool periodic : box.periodic()) {
    out.print(" {}", periodic ? "pp" : "ff");
  }
  const std::array<double, 3> tilts = {xy, xz, yz};
  for (int axis = 0; axis < 3; ++axis) {
    out.print("\n{:.17g} {:.17g}", low[axis], high[axis]);
    if (is_tilted) {
      out.print(" {:.17g}", tilts[axis]);
    }
  }
  out.print("\n");
}

} // namespace

LammpsDumpWriter::LammpsDumpWriter(const std::filesystem::path& path, DumpLayout layout, FileMode mode)
    : file_(path, mode), layout_(layout) {}

void LammpsDumpWriter::write(const Topology& topology, const Snapshot& snapshot) {
  const bool has_velocity = !snapshot.velocity.empty();
  const bool is_for_forces = layout_ == DumpLayout::forces;
  file_.print("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\n", snapshot.step, topology.n_nodes());
  print_box(file_, snapshot.box);
  file_.print("ITEM: ATOMS {}\n", is_for_forces  ? "id x y z vx vy vz fx fy fz"
                                  : has_velocity ? "id mol type x y z ix iy iz vx vy vz"
                                                 : "id mol type x y z ix iy iz");
  const std::vector<int> grain_of = is_for_forces ? std::vector<int>{} : topology.grain_of_node();
  for (const std::int64_t node : order_by_id(topology.id)) {
    const Eigen::Vector3i n = snapshot.box.image_of(snapshot.position[node]);
    const Vector3 x = snapshot.position[node] - snapshot.box.h() * n.cast<double>();
    if (is_for_forces) {
      const Vector3& v = snapshot.velocity.at(node);
      const Vector3& f = snapshot.force.at(node);
      file_.print("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", topology.id[node],
                  x[0], x[1], x[2], v[0], v[1], v[2], f[0], f[1], f[2]);
      continue;
    }
    const int grain = grain_of[node];
    file_.print("{} {} {} {:.10g} {:.10g} {:.10g} {} {} {}", topology.id[node], topology.molecule[grain],
                topology.species[grain] + 1, x[0], x[1], x[2], n[0], n[1], n[2]);
    if (has_velocity) {
      const Vector3& v = snapshot.velocity[node];
      file_.print(" {:.10g} {:.10g} {:.10g}", v[0], v[1], v[2]);
    }
    file_.print("\n");
  }
  file_.flush();
}

} // namespace boba

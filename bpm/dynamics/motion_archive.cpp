// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/motion_archive.h"

#include "bpm/dynamics/node_exchange.h"

#include <cstring>
#include <stdexcept>
#include <string>

namespace boba {

namespace {

std::vector<double> flat(const Matrix3& m) {
  return {m.data(), m.data() + 9};
}

Matrix3 matrix(const std::vector<double>& numbers) {
  if (numbers.size() != 9) {
    throw std::runtime_error("saved state: a matrix does not have nine numbers");
  }
  return Eigen::Map<const Matrix3>(numbers.data());
}

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
                                    const std::vector<double>& f, std::size_t n) {
  if (x.size() != n || v.size() != n || f.size() != n) {
    throw std::runtime_error("saved state: the nodes belong to another packing or precision (" +
                             std::to_string(x.size()) + " coordinates, " + std::to_string(n) + " expected)");
  }
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
void save_nodes(const MovingPacking& moving, SavedState& saved) {
  const std::vector<std::byte> nodes = own_nodes(moving);
  if (moving.options.precision == Precision::full) {
    unpack_columns<double, double>(nodes, saved.real["position"], saved.real["velocity"], saved.real["force"]);
    return;
  }
  unpack_columns<std::int32_t, float>(nodes, saved.integer["position"], saved.real["velocity"], saved.real["force"]);
  std::vector<Vector3> origins = moving.state.origins();
  share_grains(moving, origins);
  saved.real["origin"] = {origins.front().data(), origins.front().data() + 3 * origins.size()};
}

void restore_nodes(MovingPacking& moving, const SavedState& saved) {
  std::vector<std::byte> nodes;
  moving.ranks().on_root([&] {
    const auto n = static_cast<std::size_t>(3 * moving.packing.first_nodes().back());
    const std::vector<double>&v = saved.real.at("velocity"), &f = saved.real.at("force");
    nodes = moving.options.precision == Precision::full
                ? pack_columns<double, double>(saved.real.at("position"), v, f, n)
                : pack_columns<std::int32_t, float>(saved.integer.at("position"), v, f, n);
  });
  scatter_nodes(moving, nodes);
  if (moving.options.precision == Precision::mixed) {
    const std::vector<double>& origins = saved.real.at("origin");
    if (origins.size() != 3 * moving.state.origins().size()) {
      throw std::runtime_error("saved state: the grains' origins belong to another packing");
    }
    for (std::size_t g = 0; g < moving.state.origins().size(); ++g) {
      moving.state.origins()[g] = Eigen::Map<const Vector3>(&origins[3 * g]);
    }
  }
}

void save_ends(const MovingPacking& moving, SavedState& saved) {
  saved.real["end_gap"] = {moving.ends.gap()};
  std::vector<double>& walls = saved.real["walls"];
  for (const Wall& wall : moving.forces.walls()) {
    for (const Vector3& vector : {wall.point, wall.normal, wall.velocity}) {
      walls.insert(walls.end(), vector.data(), vector.data() + 3);
    }
    walls.push_back(wall.force);
  }
  saved.integer["clamp_count"] = {static_cast<std::int64_t>(moving.ends.clamps().size())};
  for (std::size_t k = 0; k < moving.ends.clamps().size(); ++k) {
    const std::string name = "clamp" + std::to_string(k);
    saved.integer[name + "_grain"] = moving.ends.clamps()[k].grain;
    saved.integer[name + "_node"] = moving.ends.clamps()[k].node;
    saved.real[name] = {moving.ends.clamps()[k].velocity[0], moving.ends.clamps()[k].velocity[1],
                        moving.ends.clamps()[k].velocity[2], moving.ends.clamps()[k].force[0],
                        moving.ends.clamps()[k].force[1],    moving.ends.clamps()[k].force[2]};
  }
}

void restore_ends(MovingPacking& moving, const SavedState& saved) {
  moving.ends.set_gap(saved.real.at("end_gap").at(0));
  const std::vector<double>& walls = saved.real.at("walls");
  std::vector<Wall> list;
  for (std::size_t at = 0; at + 10 <= walls.size(); at += 10) {
    const Eigen::Map<const Vector3> point(&walls[at]), normal(&walls[at + 3]), velocity(&walls[at + 6]);
    list.push_back({point, normal, velocity, walls[at + 9]});
  }
  moving.forces.walls().set(std::move(list));
  moving.ends.clamps().clear();
  for (std::int64_t k = 0; k < saved.integer.at("clamp_count").at(0); ++k) {
    const std::string name = "clamp" + std::to_string(k);
    Clamp clamp;
    clamp.grain = saved.integer.at(name + "_grain");
    clamp.node = saved.integer.at(name + "_node");
    const std::vector<double>& numbers = saved.real.at(name);
    clamp.velocity = {numbers.at(0), numbers.at(1), numbers.at(2)};
    clamp.force = {numbers.at(3), numbers.at(4), numbers.at(5)};
    moving.ends.clamps().push_back(std::move(clamp));
  }
}

} // namespace

void save_motion(const MovingPacking& moving, SavedState& saved) {
  save_nodes(moving, saved);
  const MovingCell::Saved cell = moving.cell.saved();
  saved.real["box_h"] = flat(cell.h);
  saved.real["evaluated_h"] = flat(cell.evaluated_h);
  saved.real["cell_map"] = flat(cell.map);
  saved.real["position_map"] = flat(cell.position_map);
  saved.real["residual_rate"] = flat(cell.residual_rate);
  saved.real["streaming"] = flat(cell.streaming);
  saved.real["next_streaming"] = flat(cell.next_streaming);
  saved.real["scalars"] = {cell.strain, moving.pressure, moving.kinetic_energy};
  saved.real["velocity_sum"] = {moving.noted_momentum.begin(), moving.noted_momentum.end()};
  saved.real["momentum_along_gradient"] = {moving.momentum_along_gradient.begin(),
                                           moving.momentum_along_gradient.end()};
  saved.integer["step"] = {moving.step};
  saved.integer["started"] = {moving.started ? 1 : 0, moving.forces_kept ? 1 : 0};
  save_ends(moving, saved);
}

void restore_motion(MovingPacking& moving, const SavedState& saved) {
  restore_nodes(moving, saved);
  const std::vector<double>& scalars = saved.real.at("scalars");
  moving.cell.restore({.h = matrix(saved.real.at("box_h")),
                       .evaluated_h = matrix(saved.real.at("evaluated_h")),
                       .map = matrix(saved.real.at("cell_map")),
                       .position_map = matrix(saved.real.at("position_map")),
                       .residual_rate = matrix(saved.real.at("residual_rate")),
                       .streaming = matrix(saved.real.at("streaming")),
                       .next_streaming = matrix(saved.real.at("next_streaming")),
                       .strain = scalars.at(0)});
  moving.pressure = scalars.at(1);
  moving.kinetic_energy = scalars.at(2);
  const std::vector<double>& sum = saved.real.at("velocity_sum");
  moving.noted_momentum = {sum.at(0), sum.at(1), sum.at(2)};
  const std::vector<double>& along_gradient = saved.real.at("momentum_along_gradient");
  moving.momentum_along_gradient = {along_gradient.at(0), along_gradient.at(1), along_gradient.at(2)};
  restore_ends(moving, saved);
  moving.step = saved.integer.at("step").at(0);
  moving.started = saved.integer.at("started").at(0) != 0;
  moving.forces_kept = saved.integer.at("started").at(1) != 0;
  moving.forces.contact_list().invalidate();
}

} // namespace boba

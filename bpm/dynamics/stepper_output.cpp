// SPDX-License-Identifier: GPL-3.0-or-later
// What a stepper hands out and stores: totals, snapshots, saved states.
#include "bpm/dynamics/stepper.h"

#include <cstring>
#include <stdexcept>

namespace boba {

Totals Stepper::totals() const {
  Totals totals;
  for (const GrainSums& grain : forces_.grain_sums()) {
    for (int c = 0; c < 6; ++c) {
      totals.stress[c] -= (grain.virial[c] + grain.kinetic[c]) / evaluated_volume_;
    }
  }
  totals.pressure = pressure_;
  totals.kinetic_energy = kinetic_energy_;
  const ContactTotals contacts = forces_.contact_totals();
  totals.elastic_energy = bond_energy() + contacts.energy;
  totals.largest_overlap = contacts.largest_overlap;
  return totals;
}

Snapshot Stepper::snapshot(Simulation::Parts parts) const {
  if ((parts.force || (parts.velocity && started_)) && !forces_kept_) {
    throw std::logic_error("snapshot: the forces of step " + std::to_string(step_) +
                           " were not kept; an "
                           "observer must ask for it");
  }
  Snapshot snapshot;
  snapshot.step = step_;
  snapshot.time = time();
  snapshot.strain = strain_;
  snapshot.streaming_rate = residual_rate_(0, 1) / box_.h()(1, 1);
  snapshot.box = box_;
  const Vector3 shift = box_.origin() - position_map_ * box_.origin();
  const double back = started_ ? -0.5 * options_.dt / material_.node_mass : 0.0;
  snapshot.grain_centre.assign(layout_.n_grains(), Vector3::Zero());
  for (const int g : layout_.grains()) {
    Vector3& centre = snapshot.grain_centre[g];
    for (int node = 0; node < layout_.n_nodes(g); ++node) {
      const Vector3 x = state_.position(g, node);
      snapshot.position.push_back(position_map_ * x + shift);
      centre += snapshot.position.back();
      if (parts.velocity) {
        snapshot.velocity.push_back(state_.velocity(g, node) + back * state_.force(g, node));
      }
      if (parts.force) {
        snapshot.force.push_back(state_.force(g, node));
      }
    }
    centre /= layout_.n_nodes(g);
  }
  if (parts.own && ranks().is_distributed()) {
    snapshot.grains = layout_.grains();
  } else {
    gather(snapshot.position);
    if (parts.positions_on_all_ranks) {
      ranks().broadcast(snapshot.position);
    }
    if (parts.velocity) {
      gather(snapshot.velocity);
    }
    if (parts.force) {
      gather(snapshot.force);
    }
  }
  share_grains(snapshot.grain_centre);
  for (int g = 0; g < layout_.n_grains(); ++g) {
    const GrainSums& sums = forces_.grain_sums()[g];
    std::array<double, 6> stress;
    // The cell has moved since the forces: scaled so that the grains' sum over the snapshot's volume is the stress.
    for (int c = 0; c < 6; ++c) {
      stress[c] = -(sums.virial[c] + sums.kinetic[c]) * box_.volume() / evaluated_volume_;
    }
    snapshot.grain_stress.push_back(stress);
  }
  return snapshot;
}

std::size_t Stepper::bytes() const {
  return state_.bytes() + forces_.contact_list().bytes() +
         (packing_.position.capacity() + packing_.velocity.capacity()) * sizeof(Vector3) +
         packing_.id.capacity() * sizeof(std::int64_t);
}

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

} // namespace

void Stepper::save(SavedState& saved) const {
  save_nodes(saved);
  saved.real["box_h"] = flat(box_.h());
  saved.real["cell_map"] = flat(cell_map_);
  saved.real["position_map"] = flat(position_map_);
  saved.real["residual_rate"] = flat(residual_rate_);
  saved.real["scalars"] = {strain_, evaluated_volume_, pressure_, kinetic_energy_};
  saved.real["velocity_sum"] = {velocity_sum_.begin(), velocity_sum_.end()};
  saved.integer["step"] = {step_};
  saved.integer["started"] = {started_ ? 1 : 0, forces_kept_ ? 1 : 0};
  save_ends(saved);
}

// Node by node in the packing's order, each rank its own: put together the same whatever the lanes and the ranks.
void Stepper::save_nodes(SavedState& saved) const {
  const std::vector<std::byte> nodes = own_nodes();
  if (options_.precision == Precision::full) {
    unpack_columns<double, double>(nodes, saved.real["position"], saved.real["velocity"], saved.real["force"]);
    return;
  }
  unpack_columns<std::int32_t, float>(nodes, saved.integer["position"], saved.real["velocity"], saved.real["force"]);
  std::vector<Vector3> origins = state_.origins();
  share_grains(origins);
  saved.real["origin"] = {origins.front().data(), origins.front().data() + 3 * origins.size()};
}

void Stepper::restore_nodes(const SavedState& saved) {
  std::vector<std::byte> nodes;
  ranks().on_root([&] {
    const auto n = static_cast<std::size_t>(3 * packing_.first_nodes().back());
    const std::vector<double>&v = saved.real.at("velocity"), &f = saved.real.at("force");
    nodes = options_.precision == Precision::full
                ? pack_columns<double, double>(saved.real.at("position"), v, f, n)
                : pack_columns<std::int32_t, float>(saved.integer.at("position"), v, f, n);
  });
  scatter_nodes(nodes);
  if (options_.precision == Precision::mixed) {
    const std::vector<double>& origins = saved.real.at("origin");
    if (origins.size() != 3 * state_.origins().size()) {
      throw std::runtime_error("saved state: the grains' origins belong to another packing");
    }
    for (std::size_t g = 0; g < state_.origins().size(); ++g) {
      state_.origins()[g] = Eigen::Map<const Vector3>(&origins[3 * g]);
    }
  }
}

void Stepper::save_ends(SavedState& saved) const {
  saved.real["end_gap"] = {end_gap_};
  std::vector<double>& walls = saved.real["walls"];
  for (const Wall& wall : forces_.walls()) {
    for (const Vector3& vector : {wall.point, wall.normal, wall.velocity}) {
      walls.insert(walls.end(), vector.data(), vector.data() + 3);
    }
    walls.push_back(wall.force);
  }
  saved.integer["clamp_count"] = {static_cast<std::int64_t>(clamps_.size())};
  for (std::size_t k = 0; k < clamps_.size(); ++k) {
    const std::string name = "clamp" + std::to_string(k);
    saved.integer[name + "_grain"] = clamps_[k].grain;
    saved.integer[name + "_node"] = clamps_[k].node;
    saved.real[name] = {clamps_[k].velocity[0], clamps_[k].velocity[1], clamps_[k].velocity[2],
                        clamps_[k].force[0],    clamps_[k].force[1],    clamps_[k].force[2]};
  }
}

void Stepper::restore_ends(const SavedState& saved) {
  end_gap_ = saved.real.at("end_gap").at(0);
  const std::vector<double>& walls = saved.real.at("walls");
  forces_.walls().clear();
  for (std::size_t at = 0; at + 10 <= walls.size(); at += 10) {
    const Eigen::Map<const Vector3> point(&walls[at]), normal(&walls[at + 3]), velocity(&walls[at + 6]);
    forces_.walls().push_back({point, normal, velocity, walls[at + 9]});
  }
  clamps_.clear();
  for (std::int64_t k = 0; k < saved.integer.at("clamp_count").at(0); ++k) {
    const std::string name = "clamp" + std::to_string(k);
    Clamp clamp;
    clamp.grain = saved.integer.at(name + "_grain");
    clamp.node = saved.integer.at(name + "_node");
    const std::vector<double>& numbers = saved.real.at(name);
    clamp.velocity = {numbers.at(0), numbers.at(1), numbers.at(2)};
    clamp.force = {numbers.at(3), numbers.at(4), numbers.at(5)};
    clamps_.push_back(std::move(clamp));
  }
}

std::array<double, 2> Stepper::end_forces() const {
  if (clamps_.size() == 2) {
    return {-clamps_[0].force[2], clamps_[1].force[2]};
  }
  if (forces_.walls().size() == 2) {
    return {forces_.walls()[0].force, forces_.walls()[1].force};
  }
  return {0.0, 0.0};
}

void Stepper::restore(const SavedState& saved) {
  restore_nodes(saved);
  box_.set_h(matrix(saved.real.at("box_h")));
  cell_map_ = matrix(saved.real.at("cell_map"));
  position_map_ = matrix(saved.real.at("position_map"));
  residual_rate_ = matrix(saved.real.at("residual_rate"));
  const std::vector<double>& scalars = saved.real.at("scalars");
  strain_ = scalars.at(0);
  evaluated_volume_ = scalars.at(1);
  pressure_ = scalars.at(2);
  kinetic_energy_ = scalars.at(3);
  const std::vector<double>& sum = saved.real.at("velocity_sum");
  velocity_sum_ = {sum.at(0), sum.at(1), sum.at(2)};
  restore_ends(saved);
  step_ = saved.integer.at("step").at(0);
  started_ = saved.integer.at("started").at(0) != 0;
  forces_kept_ = saved.integer.at("started").at(1) != 0;
  forces_.contact_list().invalidate();
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
// What a stepper hands out and stores: totals, snapshots, saved states.
#include "bpm/dynamics/stepper.h"

#include <algorithm>
#include <stdexcept>
#include <type_traits>

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
  totals.elastic_energy = bond_energy() + forces_.contact_totals().energy;
  totals.largest_overlap = forces_.contact_totals().largest_overlap;
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
  snapshot.position.reserve(packing_.position.size());
  for (int g = 0; g < layout_.n_grains(); ++g) {
    Vector3 centre = Vector3::Zero();
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
    snapshot.grain_centre.push_back(centre / layout_.n_nodes(g));
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

template <class Array, class Number> void copy_into(Array& to, const std::vector<Number>& from, const char* name) {
  if (from.size() != to.size()) {
    throw std::runtime_error(std::string("saved state: ") + name + " belongs to another packing or precision (" +
                             std::to_string(from.size()) + " numbers, " + std::to_string(to.size()) + " expected)");
  }
  std::transform(from.begin(), from.end(), to.begin(),
                 [](Number number) { return static_cast<typename Array::value_type>(number); });
}

} // namespace

void Stepper::save(SavedState& saved) const {
  save_nodes(saved);
  saved.real["box_h"] = flat(box_.h());
  saved.real["cell_map"] = flat(cell_map_);
  saved.real["position_map"] = flat(position_map_);
  saved.real["residual_rate"] = flat(residual_rate_);
  saved.real["scalars"] = {strain_, evaluated_volume_, pressure_, kinetic_energy_};
  saved.integer["step"] = {step_};
  saved.integer["started"] = {started_ ? 1 : 0, forces_kept_ ? 1 : 0};
  save_ends(saved);
}

void Stepper::save_nodes(SavedState& saved) const {
  state_.visit([&](const auto& arrays) {
    if constexpr (std::is_integral_v<typename std::remove_reference_t<decltype(arrays)>::Coordinate>) {
      saved.integer["x"] = {arrays.x.begin(), arrays.x.end()};
      for (const Vector3& origin : state_.origins()) {
        saved.real["origin"].insert(saved.real["origin"].end(), origin.data(), origin.data() + 3);
      }
    } else {
      saved.real["x"] = {arrays.x.begin(), arrays.x.end()};
    }
    saved.real["v"] = {arrays.v.begin(), arrays.v.end()};
    saved.real["f"] = {arrays.f.begin(), arrays.f.end()};
  });
}

void Stepper::restore_nodes(const SavedState& saved) {
  state_.visit([&](auto& arrays) {
    if constexpr (std::is_integral_v<typename std::remove_reference_t<decltype(arrays)>::Coordinate>) {
      copy_into(arrays.x, saved.integer.at("x"), "x");
      const std::vector<double>& origins = saved.real.at("origin");
      if (origins.size() != 3 * state_.origins().size()) {
        throw std::runtime_error("saved state: the grains' origins belong to another packing");
      }
      for (std::size_t g = 0; g < state_.origins().size(); ++g) {
        state_.origins()[g] = Eigen::Map<const Vector3>(&origins[3 * g]);
      }
    } else {
      copy_into(arrays.x, saved.real.at("x"), "x");
    }
    copy_into(arrays.v, saved.real.at("v"), "v");
    copy_into(arrays.f, saved.real.at("f"), "f");
  });
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
  restore_ends(saved);
  step_ = saved.integer.at("step").at(0);
  started_ = saved.integer.at("started").at(0) != 0;
  forces_kept_ = saved.integer.at("started").at(1) != 0;
  forces_.contact_list().invalidate();
}

} // namespace boba

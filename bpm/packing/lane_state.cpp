// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/lane_state.h"

#include "bpm/grain/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace boba {

namespace {

/// The power of two that lets coordinates reach four times the radius of the largest template.
double quantum_for(const Packing& packing) {
  double radius = 1.0;
  for (const auto& grain_template : packing.templates) {
    for (const Vector3& x : grain_template->position) {
      radius = std::max(radius, x.norm());
    }
  }
  return std::ldexp(1.0, static_cast<int>(std::ceil(std::log2(4.0 * radius))) - 31);
}

template <class Array> Vector3 triple(const Array& array, std::int64_t at, std::int64_t stride) {
  return {static_cast<double>(array[at]), static_cast<double>(array[at + stride]),
          static_cast<double>(array[at + 2 * stride])};
}

template <class Array> void set_triple(Array& array, std::int64_t at, std::int64_t stride, const Vector3& value) {
  using T = typename Array::value_type;
  for (int c = 0; c < 3; ++c) {
    if constexpr (std::is_integral_v<T>) {
      array[at + c * stride] = static_cast<T>(std::lround(value[c]));
    } else {
      array[at + c * stride] = static_cast<T>(value[c]);
    }
  }
}

/// e_c^2 of bonds that yield and never break; a float holds it.
constexpr double unbreakable = 1e30;

/// e_c^2 of each bond of a grain. With scatter the strengths follow the distribution of Weibull, whose share of bonds
/// that are weaker than e is 1 - exp(-(e / strain)^modulus); the numbers depend on the seed and the grain's number
/// alone.
std::vector<double> squared_strengths(const Breaking& breaking, int grain, std::int64_t n_bonds) {
  std::vector<double> limits(n_bonds, breaking.is_possible() ? breaking.strain * breaking.strain : unbreakable);
  if (breaking.weibull_modulus > 0.0) {
    Random random((breaking.seed << 32) ^ (0x9e3779b97f4a7c15ULL * (static_cast<std::uint64_t>(grain) + 1)));
    for (double& limit : limits) {
      limit *= std::pow(-std::log1p(-random.uniform()), 2.0 / breaking.weibull_modulus);
    }
  }
  return limits;
}

} // namespace

LaneState::LaneState(const Packing& packing, const LaneLayout& layout) : layout_(layout) {
  reset(packing);

  const std::vector<std::int64_t> first = packing.first_nodes();
  for (const int g : layout.grains()) {
    if (precision() == Precision::mixed) {
      for (int node = 0; node < layout.n_nodes(g); ++node) {
        origin_[g] += packing.position[first[g] + node] / layout.n_nodes(g);
      }
    }
    for (int node = 0; node < layout.n_nodes(g); ++node) {
      set_position(g, node, packing.position[first[g] + node]);
      set_velocity(g, node, packing.velocity[first[g] + node]);
    }
  }
}

void LaneState::reset(const Packing& packing) {
  origin_.assign(layout_.n_grains(), Vector3::Zero());
  visit([&](auto& arrays) {
    arrays.x.assign(layout_.size(), 0);
    arrays.v.assign(layout_.size(), 0);
    arrays.f.assign(layout_.size(), 0);
    arrays.memory.assign(layout_.memory_size(), 1); // of idle lanes: a strain that they never reach
  });
  begin_idle_memory(packing);
  for (const int g : layout_.grains()) {
    if (layout_.remembers(g)) {
      begin_memory(packing, g);
    }
  }
  quantum_ = precision() == Precision::mixed ? quantum_for(packing) : 1.0;
  for (const Block& block : layout_.blocks()) {
    const GrainTemplate& undeformed = *packing.templates[block.template_index];
    for (std::int64_t node = 0; node < block.n_nodes; ++node) {
      for (int lane = 0; lane < block.n_lanes; ++lane) {
        visit([&](auto& arrays) {
          set_triple(arrays.x, block.offset + 3 * node * block.n_lanes + lane, block.n_lanes,
                     undeformed.position[node] / quantum_);
        });
      }
    }
  }
}

void LaneState::reset_idle_lanes(const Block& block, const GrainTemplate& undeformed) {
  visit([&](auto& arrays) {
    for (int lane = 0; lane < block.n_lanes; ++lane) {
      for (std::int64_t node = 0; block.grain[lane] < 0 && node < block.n_nodes; ++node) {
        const std::int64_t at = block.offset + 3 * node * block.n_lanes + lane;
        set_triple(arrays.x, at, block.n_lanes, undeformed.position[node] / quantum_);
        set_triple(arrays.v, at, block.n_lanes, Vector3::Zero());
        set_triple(arrays.f, at, block.n_lanes, Vector3::Zero());
      }
    }
  });
}

/// Bonds of idle lanes that yield have the lengths of the template too: they stay cheap.
void LaneState::begin_idle_memory(const Packing& packing) {
  visit([&](auto& arrays) {
    using Real = typename std::remove_reference_t<decltype(arrays)>::Real;
    for (const Block& block : layout_.blocks()) {
      Real* memory = arrays.memory.data() + block.memory;
      const std::vector<Bond>& bonds = packing.templates[block.template_index]->bonds;
      for (std::size_t b = 0; block.n_remembered == YieldingBondLaw::n_remembered && b < bonds.size(); ++b) {
        Real* of_bond = memory + b * block.n_remembered * block.n_lanes;
        std::fill(of_bond + block.n_lanes, of_bond + 2 * block.n_lanes, static_cast<Real>(bonds[b].r0));
        std::fill(of_bond + 2 * block.n_lanes, of_bond + 3 * block.n_lanes, Real{0});
      }
    }
  });
}

/// Strengths, and with bonds that yield their lengths without force and no plastic strain.
void LaneState::begin_memory(const Packing& packing, int grain) {
  const std::vector<Bond>& bonds = packing.template_of(grain).bonds;
  const auto n_bonds = static_cast<std::int64_t>(bonds.size());
  const std::vector<double> limits = squared_strengths(packing.grains[grain].breaking, grain, n_bonds);
  visit([&](auto& arrays) {
    using Real = typename std::remove_reference_t<decltype(arrays)>::Real;
    for (std::int64_t b = 0; b < n_bonds; ++b) {
      const double numbers[] = {limits[b], bonds[b].r0, 0.0};
      for (int k = 0; k < layout_.n_remembered(grain); ++k) {
        arrays.memory[layout_.memory_index(grain, b, k)] = static_cast<Real>(numbers[k]);
      }
    }
  });
}

std::size_t LaneState::node_bytes() const {
  return visit(
      [](const auto& arrays) { return 3 * (sizeof(arrays.x[0]) + sizeof(arrays.v[0]) + sizeof(arrays.f[0])); });
}

namespace {

/// Calls visit(number) for position, velocity and force of every node of a grain, in the order in which they are
/// packed.
template <class Arrays, class Visit>
void for_each_number(const LaneLayout& layout, int grain, Arrays& arrays, Visit&& visit) {
  for (int node = 0; node < layout.n_nodes(grain); ++node) {
    for (int c = 0; c < 3; ++c) {
      const std::int64_t at = layout.index(grain, node, c);
      visit(arrays.x[at]);
      visit(arrays.v[at]);
      visit(arrays.f[at]);
    }
  }
}

} // namespace

void LaneState::pack(int grain, std::byte* bytes) const {
  visit([&](const auto& arrays) {
    for_each_number(layout_, grain, arrays, [&](const auto& number) {
      std::memcpy(bytes, &number, sizeof(number));
      bytes += sizeof(number);
    });
  });
}

void LaneState::unpack(int grain, const std::byte* bytes) {
  visit([&](auto& arrays) {
    for_each_number(layout_, grain, arrays, [&](auto& number) {
      std::memcpy(&number, bytes, sizeof(number));
      bytes += sizeof(number);
    });
  });
}

Vector3 LaneState::position(int grain, int node) const {
  const Vector3 x =
      visit([&](const auto& arrays) { return triple(arrays.x, layout_.index(grain, node, 0), layout_.stride(grain)); });
  return precision() == Precision::full ? x : Vector3(origin_[grain] + quantum_ * x);
}
Vector3 LaneState::velocity(int grain, int node) const {
  return visit(
      [&](const auto& arrays) { return triple(arrays.v, layout_.index(grain, node, 0), layout_.stride(grain)); });
}
Vector3 LaneState::force(int grain, int node) const {
  return visit(
      [&](const auto& arrays) { return triple(arrays.f, layout_.index(grain, node, 0), layout_.stride(grain)); });
}

double LaneState::bond_memory(int grain, std::int64_t bond, int number) const {
  return visit([&](const auto& arrays) {
    return static_cast<double>(arrays.memory[layout_.memory_index(grain, bond, number)]);
  });
}

std::vector<double> LaneState::memory_rows(int grain) const {
  const auto n_slots = static_cast<std::size_t>(layout_.memory_slots());
  std::vector<double> rows(n_slots * layout_.n_nodes(grain), 0.0);
  if (layout_.remembers(grain)) {
    const std::vector<std::int64_t>& first = layout_.first_bonds(grain);
    for (int node = 0; node < layout_.n_nodes(grain); ++node) {
      std::size_t slot = n_slots * node;
      for (std::int64_t b = first[node]; b < first[node + 1]; ++b) {
        for (int k = 0; k < layout_.n_remembered(grain); ++k) {
          rows[slot++] = bond_memory(grain, b, k);
        }
      }
    }
  }
  return rows;
}

void LaneState::set_memory_rows(int grain, const double* rows) {
  if (!layout_.remembers(grain)) {
    return;
  }
  const std::vector<std::int64_t>& first = layout_.first_bonds(grain);
  visit([&](auto& arrays) {
    using Real = typename std::remove_reference_t<decltype(arrays)>::Real;
    for (int node = 0; node < layout_.n_nodes(grain); ++node) {
      const double* row = rows + static_cast<std::int64_t>(layout_.memory_slots()) * node;
      for (std::int64_t b = first[node]; b < first[node + 1]; ++b) {
        for (int k = 0; k < layout_.n_remembered(grain); ++k) {
          arrays.memory[layout_.memory_index(grain, b, k)] = static_cast<Real>(*row++);
        }
      }
    }
  });
}

void LaneState::set_position(int grain, int node, const Vector3& x) {
  const Vector3 coordinate = precision() == Precision::full ? x : Vector3((x - origin_[grain]) / quantum_);
  visit([&](auto& arrays) { set_triple(arrays.x, layout_.index(grain, node, 0), layout_.stride(grain), coordinate); });
}
void LaneState::set_velocity(int grain, int node, const Vector3& v) {
  visit([&](auto& arrays) { set_triple(arrays.v, layout_.index(grain, node, 0), layout_.stride(grain), v); });
}
void LaneState::set_force(int grain, int node, const Vector3& f) {
  visit([&](auto& arrays) { set_triple(arrays.f, layout_.index(grain, node, 0), layout_.stride(grain), f); });
}

Vector3 LaneState::velocity_sum(int grain) const {
  Vector3 sum = Vector3::Zero();
  for (int node = 0; node < layout_.n_nodes(grain); ++node) {
    sum += velocity(grain, node);
  }
  return sum;
}

void LaneState::add_velocity(int grain, const Vector3& change) {
  for (int node = 0; node < layout_.n_nodes(grain); ++node) {
    set_velocity(grain, node, velocity(grain, node) + change);
  }
}

Vector3 LaneState::position_sum(int grain) const {
  Vector3 sum = Vector3::Zero();
  for (int node = 0; node < layout_.n_nodes(grain); ++node) {
    sum += position(grain, node);
  }
  return sum;
}

namespace {

/// The profile's component `row` for the lanes of one node: `start` of each lane, and the gradient for its coordinates.
template <class Coordinate, class Real>
void add_profile_to_node(const Coordinate* x, Real* v, int n_lanes, const double* start, const double* weight,
                         const Vector3& gradient) {
  for (int lane = 0; lane < n_lanes; ++lane) {
    const double change = gradient[0] * static_cast<double>(x[lane]) +
                          gradient[1] * static_cast<double>(x[n_lanes + lane]) +
                          gradient[2] * static_cast<double>(x[2 * n_lanes + lane]);
    v[lane] += static_cast<Real>(start[lane] + weight[lane] * change);
  }
}

} // namespace

void LaneState::add_profile(const Block& block, const Matrix3& gradient, const Vector3& centre) {
  for (int row = 0; row < 3; ++row) {
    const Vector3 along = gradient.row(row);
    if (along == Vector3::Zero()) {
      continue;
    }
    std::array<double, max_lanes> start{}, weight{};
    for (int lane = 0; lane < block.n_lanes; ++lane) {
      if (block.grain[lane] >= 0) {
        start[lane] = along.dot(origin_[block.grain[lane]] - centre);
        weight[lane] = quantum_;
      }
    }
    visit([&](auto& arrays) {
      for (int node = 0; node < block.n_nodes; ++node) {
        const std::int64_t at = block.offset + 3 * static_cast<std::int64_t>(node) * block.n_lanes;
        add_profile_to_node(arrays.x.data() + at, arrays.v.data() + at + row * block.n_lanes, block.n_lanes,
                            start.data(), weight.data(), along);
      }
    });
  }
}

void LaneState::map_origins(const Matrix3& map, const Vector3& shift) {
  if (precision() == Precision::mixed) {
    for (Vector3& origin : origin_) {
      origin = map * origin + shift;
    }
  }
}

double LaneState::recentre() {
  if (precision() == Precision::full) {
    return 0.0;
  }
  std::int64_t farthest = 0;
#pragma omp parallel for schedule(dynamic, 1) reduction(max : farthest)
  for (const int g : layout_.grains()) {
    const std::int64_t stride = layout_.stride(g), n = layout_.n_nodes(g);
    for (int c = 0; c < 3; ++c) {
      std::int32_t* x = mixed_.x.data() + layout_.index(g, 0, c);
      std::int64_t sum = 0;
      for (std::int64_t node = 0; node < n; ++node) {
        sum += x[3 * node * stride];
        farthest = std::max(farthest, std::abs(static_cast<std::int64_t>(x[3 * node * stride])));
      }
      const auto mean = static_cast<std::int32_t>(sum / n);
      if (std::abs(mean) > (1 << 27)) { // a sixteenth of the range: grains move slowly, this is rare
        for (std::int64_t node = 0; node < n; ++node) {
          x[3 * node * stride] -= mean;
        }
        origin_[g][c] += quantum_ * mean;
      }
    }
  }
  return static_cast<double>(farthest) / 2147483648.0;
}

void LaneState::take(const LaneState& other) {
  full_ = other.full_;
  mixed_ = other.mixed_;
  origin_ = other.origin_;
}

std::size_t LaneState::bytes() const {
  return visit([](const auto& arrays) {
    return arrays.x.capacity() * sizeof(arrays.x[0]) +
           (arrays.v.capacity() + arrays.f.capacity() + arrays.memory.capacity()) * sizeof(arrays.v[0]);
  });
}

} // namespace boba

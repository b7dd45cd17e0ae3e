// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/material.h"
#include "bpm/packing/packing.h"

#include <array>
#include <vector>

namespace boba::bench {

/// A packing in a fixed cell, advanced by the engine's scheme in plain loops and long double: 11 bits more than double.
class Twin {
public:
  using Real = long double;
  using Vector = std::array<Real, 3>;

  Twin(const Packing& packing, const Material& material, double dt);
  /// The half kick at the start, as Stepper::start.
  void start() { kick(Real(0.5) * dt_); }
  void advance();

  const std::vector<Vector>& position() const { return x_; }
  Real kinetic_energy() const; ///< of the half-step velocities, k d^2

private:
  void kick(Real dt);
  void find_contacts();
  void add_bonds();
  void add_contacts();

  struct NodePair {
    std::int64_t i, j;
  };

  const Packing& packing_;
  Material material_;
  Real dt_;
  std::vector<std::int64_t> first_;
  std::vector<std::vector<std::uint8_t>> bonded_;
  std::vector<Vector> x_, v_, f_;
  std::vector<NodePair> near_; ///< unbonded pairs that may touch within the next steps
  int steps_ = 0;
};

} // namespace boba::bench

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "bpm/laws/breaking.h"
#include "bpm/laws/yielding.h"
#include "bpm/packing/box.h"
#include "bpm/packing/snapshot.h"

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace boba {

/// One grain of a packing: which template it is made of and what its bonds are like.
struct Grain {
  int template_index = 0;
  int species = 0;
  double alpha = 0.0;        ///< many-body coefficient, k d
  std::int64_t molecule = 0; ///< number shown in files
  Breaking breaking = {};    ///< what breaks its bonds
  Yielding yielding = {};    ///< when its bonds yield

  /// Numbers that each of its bonds remembers; 0 for elastic bonds that do not break.
  int n_remembered() const {
    return yielding.is_possible()   ? YieldingBondLaw::n_remembered
           : breaking.is_possible() ? BreakingBondLaw::n_remembered
                                    : 0;
  }
};

/// Everything a run starts from: the cell, the grains and every node's position and velocity.
///
/// Nodes are numbered grain by grain, in template order inside a grain. Positions are unwrapped and each grain is
/// whole.
struct Packing {
  Box box;
  std::vector<std::shared_ptr<const GrainTemplate>> templates;
  std::vector<Grain> grains;
  std::vector<std::int64_t> id;  ///< per node, as files show it
  std::vector<Vector3> position; ///< d
  std::vector<Vector3> velocity; ///< d/tau
  double strain = 0.0;           ///< shear strain until now, of the run that this one continues
  std::array<bool, 3> walls{};   ///< rigid walls stand at the cell's faces across these axes, along which it is open

  int n_grains() const { return static_cast<int>(grains.size()); }
  const GrainTemplate& template_of(int grain) const { return *templates[grains[grain].template_index]; }
  /// Number of the first node of each grain, and the total as last entry (size n_grains + 1).
  std::vector<std::int64_t> first_nodes() const;
  std::vector<int> nodes_of_grains() const;
  /// Bonds are written out for every grain only when `with_bonds`.
  Topology topology(bool with_bonds) const;
};

/// True when the bonds of some grain may break.
bool bonds_break(const Packing& packing);
/// True when the bonds of some grain may yield.
bool bonds_yield(const Packing& packing);

/// Where one grain goes: the template's nodes are rotated about their mean, then moved to `centre`.
struct Placement {
  Grain grain;
  Vector3 centre = Vector3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// A packing at rest from templates and placements; ids and molecules run from 1.
Packing make_packing(const Box& box, std::vector<std::shared_ptr<const GrainTemplate>> templates,
                     const std::vector<Placement>& placements);

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/aligned_array.h"
#include "bpm/packing/lane_layout.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace boba {

/// Positions, velocities and forces of all nodes in the lane layout.
template <class Coordinate_, class Real_> struct LaneArrays {
  using Coordinate = Coordinate_;
  using Real = Real_;
  AlignedArray<Coordinate> x; ///< d, or quanta from the grain's origin
  AlignedArray<Real> v, f;    ///< d/tau, k d
  AlignedArray<Real> memory;  ///< what bonds remember; empty where none does
};

/// The nodes of a packing as it moves. Velocities are those of half steps between steps (see Stepper).
///
/// In mixed precision a coordinate is an integer number of quanta, a power of two of d that leaves room for four times
/// the largest grain's radius: 3e-8 d for a grain of radius 10 d. Differences of positions are then exact, and the
/// force on a bond as good as a float's seven digits; slow drifts are not lost (see kernels/drift_kernel.h).
class LaneState {
public:
  /// Copies the packing in; idle lanes get the undeformed template at rest, so that they stay finite and cheap. The
  /// layout must outlive the state.
  LaneState(const Packing& packing, const LaneLayout& layout);

  /// Begins again with the layout as it is now: all grains undeformed at the origin, at rest.
  void reset(const Packing& packing);
  /// Puts the undeformed template, at rest, into the idle lanes of a block. They belong to no grain, but are moved with
  /// the others, and in a long shear a grain without neighbours may come apart.
  void reset_idle_lanes(const Block& block, const GrainTemplate& undeformed);
  /// Bytes of a node's coordinates, velocity and force as they are stored; the quanta are the packing's, not the
  /// rank's.
  std::size_t node_bytes() const;
  /// Copies a grain's nodes as they are stored, one after the other. The grain's origin is not among them.
  void pack(int grain, std::byte* bytes) const;
  void unpack(int grain, const std::byte* bytes);

  Precision precision() const { return layout_.precision(); }
  double quantum() const { return quantum_; }                       ///< d; 1 in full precision
  const Vector3& origin(int grain) const { return origin_[grain]; } ///< 0 in full precision

  Vector3 position(int grain, int node) const;
  Vector3 velocity(int grain, int node) const;
  Vector3 force(int grain, int node) const;
  void set_position(int grain, int node, const Vector3& x);
  void set_velocity(int grain, int node, const Vector3& v);
  void set_force(int grain, int node, const Vector3& f);

  /// One of the numbers that a bond of a grain remembers; of grains whose bonds do.
  double bond_memory(int grain, std::int64_t bond, int number) const;
  /// What all bonds of a grain remember: for each node a row of LaneLayout::memory_slots() numbers, those of the bonds
  /// that it is the first node of and then zeros.
  std::vector<double> memory_rows(int grain) const;
  void set_memory_rows(int grain, const double* rows);

  Vector3 velocity_sum(int grain) const;
  /// Adds to the velocity of every node of a grain.
  void add_velocity(int grain, const Vector3& change);

  /// Adds the linear profile gradient (x - centre) to the velocities of a block's nodes, 1/tau and d; idle lanes stay.
  void add_profile(const Block& block, const Matrix3& gradient, const Vector3& centre);
  Vector3 position_sum(int grain) const;

  /// Moves the origins with an affine map; the drift moves the nodes. Nothing in full precision.
  void map_origins(const Matrix3& map, const Vector3& shift);
  /// Puts origins back to where their grains are, by whole quanta; positions do not change. Returns the largest
  /// coordinate that was met, as a share of the range.
  double recentre();

  /// Calls visit with the arrays that are in use.
  template <class Visit> decltype(auto) visit(Visit&& visit) {
    return precision() == Precision::full ? visit(full_) : visit(mixed_);
  }
  template <class Visit> decltype(auto) visit(Visit&& visit) const {
    return precision() == Precision::full ? visit(full_) : visit(mixed_);
  }
  /// Takes the numbers of another state of the same layout.
  void take(const LaneState& other);
  std::size_t bytes() const;
  std::vector<Vector3>& origins() { return origin_; }
  const std::vector<Vector3>& origins() const { return origin_; }

private:
  void begin_memory(const Packing& packing, int grain);
  void begin_idle_memory(const Packing& packing);

  const LaneLayout& layout_;
  LaneArrays<double, double> full_;
  LaneArrays<std::int32_t, float> mixed_;
  std::vector<Vector3> origin_;
  double quantum_ = 1.0;
};

} // namespace boba

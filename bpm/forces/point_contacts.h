// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_laws.h"
#include "bpm/forces/evaluation.h"
#include "bpm/forces/force_sums.h"
#include "bpm/forces/point_list.h"
#include "bpm/packing/lane_state.h"

#include <cstdint>
#include <vector>

namespace boba {

/// Contacts of a packing whose grains are single nodes: one flat list for all, in place of lists for pairs of grains.
///
/// The list holds all pairs closer than the contact range and a skin. It lasts until some node has moved, beyond the
/// cell's own motion since the list was built, by what is left of half the skin: positions are compared, so nothing has
/// to tell this object of motion. The skin is chosen at each build by how fast nodes moved since the one before.
/// Forces and sums are those of ContactForces to the last bit.
class PointContacts {
public:
  /// `law` and `layout` must outlive this object. \param skin the widest, d
  PointContacts(const LaneLayout& layout, const ContactModel& law, double skin);
  /// True for packings that this class is for.
  static bool serves(const LaneLayout& layout);
  void layout_changed() { is_built_ = false; }

  /// Copies the nodes, and builds the list when it no longer holds.
  void prepare(const LaneState& state, const Box& box);
  /// Evaluates the law for all candidates; sums of contacts are reset and filled where asked for.
  void evaluate(Precision precision, const Box& box, const Evaluation& what, ForceSums& sums);
  /// Adds the forces to those of a block.
  void add(const Block& block, double* f) const;
  void add(const Block& block, float* f) const;

  std::int64_t n_builds() const { return n_builds_; }
  std::int64_t n_candidates() const { return list_.n_candidates(); }
  std::size_t bytes() const;

private:
  void collect(const LaneState& state);
  bool holds(const Box& box);
  void choose_skin();
  void build(const LaneState& state, const Box& box);
  template <class Real>
  void evaluate_in(std::vector<Real>& force, const Box& box, const Evaluation& what, ForceSums& sums);
  template <class Real> void add_from(const std::vector<Real>& force, const Block& block, Real* f) const;

  const LaneLayout& layout_;
  const ContactModel& law_;
  double widest_skin_, skin_;
  bool is_built_ = false;
  PointList list_;
  std::vector<kernels::PointRow> x_, v_; ///< per slot
  std::vector<Vector3> at_build_;        ///< per slot: position when the list was built, d
  Matrix3 h_inverse_at_build_ = Matrix3::Identity();
  Vector3 origin_at_build_ = Vector3::Zero();
  std::vector<double> force_; ///< per grain and component, k d; one of the two is in use
  std::vector<float> force_in_floats_;
  std::int64_t n_builds_ = 0;
  double moved_ = 0.0; ///< most of any node since the build, beyond the cell's motion, d
  std::int64_t steps_since_build_ = 0;
};

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
// How a force field knows its contacts: copies of the nodes that may touch, which candidates are near, and the force of
// each. Bonds, and what is summed up, are in force_field.cpp.
#include "bpm/forces/force_field.h"
#include "bpm/forces/lane_kernels.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace boba {

kernels::ContactCandidates ForceField::seen_by_kernels(const ContactPair& pair,
                                                       const std::vector<kernels::NodePair>& pairs, const Box& box,
                                                       const Matrix3& residual_rate) const {
  const Vector3 n(pair.image.a, pair.image.b, pair.image.c);
  const Vector3 shift = box.h() * n, velocity = residual_rate * n;
  return {pairs.data(),      static_cast<std::int64_t>(pairs.size()), nodes_of_[pair.a],
          nodes_of_[pair.b], {shift[0], shift[1], shift[2]},          {velocity[0], velocity[1], velocity[2]}};
}

void ForceField::find_near(ContactPair& pair, const Box& box) {
  const double reach = contact_list_.near_reach(pair);
  pair.touches.clear(); // a pair without near candidates is not evaluated
  if (pair.candidates.empty()) {
    pair.near.clear();
    return;
  }
  pair.near.resize(pair.candidates.size() + 1);
  pair.near.resize(table_.near_candidates(seen_by_kernels(pair, pair.candidates, box, Matrix3::Zero()), reach * reach,
                                          pair.near.data()));
  if (!std::includes(pair.near.begin(), pair.near.end(), pair.followed.begin(), pair.followed.end())) {
    thread_local std::vector<kernels::NodePair> all;
    all.clear();
    std::set_union(pair.near.begin(), pair.near.end(), pair.followed.begin(), pair.followed.end(),
                   std::back_inserter(all));
    pair.near.assign(all.begin(), all.end());
  }
}

void ForceField::contacts_between(ContactPair& pair, const Box& box, const Evaluation& what) {
  thread_local std::vector<kernels::Touch> touches;
  thread_local std::vector<kernels::ContactNode> rows;
  const auto capacity = static_cast<std::size_t>(kernels::touch_capacity(static_cast<std::int64_t>(pair.near.size())));
  if (touches.size() < capacity) {
    touches.resize(capacity);
    rows.resize(capacity);
  }
  pair.sums = no_contacts;
  const ContactModel& law = pair.inside() ? *inner_contact_ : *contact_;
  const std::int64_t n_touching =
      law.evaluate(seen_by_kernels(pair, pair.near, box, what.residual_rate), rows.data(), touches.data(), pair.sums);
  pair.touches.assign(touches.begin(), touches.begin() + n_touching);
  if (n_touching > 0 && law.range() < contact_->range()) { // so that one distance tells the largest overlap of all
    pair.sums.smallest_r2 = std::pow(std::sqrt(pair.sums.smallest_r2) + contact_->range() - law.range(), 2);
  }
}

void ForceField::collect(int grain, std::span<const std::int32_t> nodes, const LaneState& state) {
  state.visit([&](const auto& lanes) {
    kernels_of(table_, lanes)
        .collect(nodes.data(), static_cast<std::int64_t>(nodes.size()), lanes.x.data() + layout_.first(grain),
                 lanes.v.data() + layout_.first(grain), layout_.stride(grain), state.origin(grain).data(),
                 state.quantum(), contact_nodes_.get() + first_node_[grain]);
  });
}

/// Brings the contact list and the contact nodes up to the present state.
void ForceField::prepare_contacts(const LaneState& state, const Box& box) {
  const bool changed = contact_list_.update(state, box, network_of_grain_) || !contact_list_.near_holds();
  if (collected_ && !changed) {
    return;
  }
  if (changed) {
    locate_nodes();
  }
#pragma omp parallel for schedule(dynamic, 1)
  for (const int grain : layout_.grains()) {
    collect(grain, listed(grain), state);
  }
  if (changed) {
    list_near(box);
    split_by_ranks();
  }
}

/// Says where the nodes of each grain are found, those of other ranks included.
void ForceField::locate_nodes() {
  if (distribution_.is_distributed()) {
    halo_.rebuild(contact_list_, layout_, distribution_, ContactHalo::Nodes::listed);
  }
  nodes_of_.assign(layout_.n_grains(), nullptr);
  for (const int grain : layout_.grains()) {
    nodes_of_[grain] = contact_nodes_.get() + first_node_[grain];
  }
  for (const int ghost : contact_list_.ghosts()) {
    nodes_of_[ghost] = halo_.nodes_of(ghost);
  }
}

/// Finds the candidates that may touch in the steps to come; the halo is then of their nodes alone.
void ForceField::list_near(const Box& box) {
  if (distribution_.is_distributed()) {
    halo_.begin(contact_nodes_.get());
    halo_.end();
  }
  std::vector<ContactPair>& pairs = contact_list_.pairs();
  contact_list_.begin_near();
#pragma omp parallel for schedule(dynamic, 4)
  for (int p = 0; p < static_cast<int>(pairs.size()); ++p) {
    find_near(pairs[p], box);
  }
  contact_list_.list_near();
  if (distribution_.is_distributed()) {
    halo_.rebuild(contact_list_, layout_, distribution_, ContactHalo::Nodes::near);
  }
}

/// Sorts the pairs that may touch, and all blocks, by whether they wait for other ranks.
void ForceField::split_by_ranks() {
  own_part_ = {};
  shared_part_ = {};
  const std::vector<ContactPair>& pairs = contact_list_.pairs();
  const auto is_shared = [&](const ContactPair& pair) { return !layout_.holds(pair.a) || !layout_.holds(pair.b); };
  for (int p = 0; p < static_cast<int>(pairs.size()); ++p) {
    if (!pairs[p].near.empty()) {
      (is_shared(pairs[p]) ? shared_part_ : own_part_).pairs.push_back(p);
    }
  }
  const auto waits = [&](int grain) {
    const auto sides = grain >= 0 ? contact_list_.near_sides(grain) : std::span<const ContactSide>{};
    return std::any_of(sides.begin(), sides.end(),
                       [&](const ContactSide& side) { return is_shared(pairs[side.pair]); });
  };
  for (int b = 0; b < static_cast<int>(layout_.blocks().size()); ++b) {
    const std::vector<int>& grains = layout_.blocks()[b].grain;
    (std::any_of(grains.begin(), grains.end(), waits) ? shared_part_ : own_part_).blocks.push_back(b);
  }
}

} // namespace boba

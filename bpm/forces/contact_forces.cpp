// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/contact_forces.h"

#include "bpm/forces/lane_kernels.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace boba {

ContactForces::ContactForces(const LaneLayout& layout, const Material& material, double skin,
                             const kernels::KernelTable& table, const Distribution& distribution)
    : layout_(layout), table_(table), distribution_(distribution), law_(contact_model(between_grains(material))),
      inner_law_(material.contact_diameter ? contact_model(material) : law_),
      list_(layout, table, {law_->range(), inner_law_->range()}, skin, distribution) {}

void ContactForces::layout_changed() {
  std::int64_t n_nodes = 0;
  first_node_.assign(layout_.n_grains(), 0);
  for (const int grain : layout_.grains()) {
    first_node_[grain] = n_nodes;
    n_nodes += layout_.n_nodes(grain);
  }
  nodes_ = std::make_unique_for_overwrite<kernels::ContactNode[]>(n_nodes);
  halo_.clear();
  list_.layout_changed();
  collected_ = false;
}

kernels::ContactCandidates ContactForces::seen_by_kernels(const ContactPair& pair,
                                                          const std::vector<kernels::NodePair>& pairs, const Box& box,
                                                          const Matrix3& residual_rate) const {
  const Vector3 n(pair.image.a, pair.image.b, pair.image.c);
  const Vector3 shift = box.h() * n, velocity = residual_rate * n;
  return {pairs.data(),      static_cast<std::int64_t>(pairs.size()), nodes_of_[pair.a],
          nodes_of_[pair.b], {shift[0], shift[1], shift[2]},          {velocity[0], velocity[1], velocity[2]}};
}

void ContactForces::find_near(ContactPair& pair, const Box& box) {
  const double reach = list_.near_reach(pair);
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

void ContactForces::evaluate(int index, const Box& box, const Evaluation& what) {
  ContactPair& pair = list_.pairs()[index];
  thread_local std::vector<kernels::Touch> touches;
  thread_local std::vector<kernels::ContactNode> rows;
  const auto capacity = static_cast<std::size_t>(kernels::touch_capacity(static_cast<std::int64_t>(pair.near.size())));
  if (touches.size() < capacity) {
    touches.resize(capacity);
    rows.resize(capacity);
  }
  pair.sums = no_contacts;
  const ContactModel& law = pair.inside() ? *inner_law_ : *law_;
  const std::int64_t n_touching =
      law.evaluate(seen_by_kernels(pair, pair.near, box, what.residual_rate), rows.data(), touches.data(), pair.sums);
  pair.touches.assign(touches.begin(), touches.begin() + n_touching);
  if (n_touching > 0 && law.range() < law_->range()) { // so that one distance tells the largest overlap of all
    pair.sums.smallest_r2 = std::pow(std::sqrt(pair.sums.smallest_r2) + law_->range() - law.range(), 2);
  }
}

template <class Real> void ContactForces::add(int grain, Real* f, kernels::ContactSums* sums) const {
  if (sums != nullptr) {
    *sums = no_contacts;
  }
  for (const ContactSide& side : list_.near_sides(grain)) {
    const ContactPair& pair = list_.pairs()[side.pair];
    kernels_in<Real>(table_).add_touches(pair.touches.data(), static_cast<std::int64_t>(pair.touches.size()), side.sign,
                                         f, layout_.stride(grain));
    if (sums != nullptr && !pair.touches.empty()) {
      for (int c = 0; c < 6; ++c) {
        sums->virial[c] += 0.5 * pair.sums.virial[c];
      }
      sums->smallest_r2 = std::min(sums->smallest_r2, pair.sums.smallest_r2);
      sums->potential += 0.5 * pair.sums.potential;
      sums->n_touching += pair.sums.n_touching;
    }
  }
}

void ContactForces::collect(int grain, std::span<const std::int32_t> nodes, const LaneState& state) {
  state.visit([&](const auto& lanes) {
    kernels_of(table_, lanes)
        .collect(nodes.data(), static_cast<std::int64_t>(nodes.size()), lanes.x.data() + layout_.first(grain),
                 lanes.v.data() + layout_.first(grain), layout_.stride(grain), state.origin(grain).data(),
                 state.quantum(), nodes_.get() + first_node_[grain]);
  });
}

void ContactForces::prepare(const LaneState& state, const Box& box,
                            const std::vector<const NetworkData*>& network_of_grain) {
  const bool changed = list_.update(state, box, network_of_grain) || !list_.near_holds();
  const bool is_collected = std::exchange(collected_, false);
  if (is_collected && !changed) {
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
void ContactForces::locate_nodes() {
  if (distribution_.is_distributed()) {
    halo_.rebuild(list_, layout_, distribution_, ContactHalo::Nodes::listed);
  }
  nodes_of_.assign(layout_.n_grains(), nullptr);
  for (const int grain : layout_.grains()) {
    nodes_of_[grain] = nodes_.get() + first_node_[grain];
  }
  for (const int ghost : list_.ghosts()) {
    nodes_of_[ghost] = halo_.nodes_of(ghost);
  }
}

/// Finds the candidates that may touch in the steps to come; the halo is then of their nodes alone.
void ContactForces::list_near(const Box& box) {
  if (distribution_.is_distributed()) {
    halo_.begin(nodes_.get());
    halo_.end();
  }
  std::vector<ContactPair>& pairs = list_.pairs();
  list_.begin_near();
#pragma omp parallel for schedule(dynamic, 4)
  for (int p = 0; p < static_cast<int>(pairs.size()); ++p) {
    find_near(pairs[p], box);
  }
  list_.list_near();
  if (distribution_.is_distributed()) {
    halo_.rebuild(list_, layout_, distribution_, ContactHalo::Nodes::near);
  }
}

/// Sorts the pairs that may touch, and all blocks, by whether they wait for other ranks.
void ContactForces::split_by_ranks() {
  own_part_ = {};
  shared_part_ = {};
  const std::vector<ContactPair>& pairs = list_.pairs();
  const auto is_shared = [&](const ContactPair& pair) { return !layout_.holds(pair.a) || !layout_.holds(pair.b); };
  for (int p = 0; p < static_cast<int>(pairs.size()); ++p) {
    if (!pairs[p].near.empty()) {
      (is_shared(pairs[p]) ? shared_part_ : own_part_).pairs.push_back(p);
    }
  }
  const auto waits = [&](int grain) {
    const auto sides = grain >= 0 ? list_.near_sides(grain) : std::span<const ContactSide>{};
    return std::any_of(sides.begin(), sides.end(),
                       [&](const ContactSide& side) { return is_shared(pairs[side.pair]); });
  };
  for (int b = 0; b < static_cast<int>(layout_.blocks().size()); ++b) {
    const std::vector<int>& grains = layout_.blocks()[b].grain;
    (std::any_of(grains.begin(), grains.end(), waits) ? shared_part_ : own_part_).blocks.push_back(b);
  }
}

template void ContactForces::add(int, double*, kernels::ContactSums*) const;
template void ContactForces::add(int, float*, kernels::ContactSums*) const;

} // namespace boba

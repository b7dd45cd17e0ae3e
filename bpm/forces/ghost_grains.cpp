// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/ghost_grains.h"

#include <algorithm>
#include <cstring>

namespace boba {

/// What a rank must know of a grain that it does not own. Its owner's records of places: first those of nodes that
/// moved, then of those that are followed by themselves, then, where somebody needs them, all.
struct GhostRecord {
  GrainFrame frame;
  Bounds bounds;
  double deviation;
  std::int32_t first_record, n_moved, n_followed, all_noted;
};

struct PlaceRecord {
  std::int32_t node;
  float x[3];
};

namespace {

PlaceRecord record_of(std::int32_t node, const Vector3& place) {
  return {node, {static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])}};
}

Vector3 place_of(const PlaceRecord& record) {
  return {record.x[0], record.x[1], record.x[2]};
}

} // namespace

/// Finds out which grains of other ranks stand in our pairs, and which of ours other ranks know nothing of yet.
void GhostGrains::find(const std::vector<ContactPair>& pairs, std::vector<TrackedGrain>& grains, bool afresh) {
  if (!distribution_.is_distributed()) {
    return;
  }
  const std::vector<int> before = afresh ? std::vector<int>{} : ghosts_;
  ghosts_.clear();
  for (const ContactPair& pair : pairs) {
    for (const int grain : {pair.a, pair.b}) {
      if (!layout_.holds(grain)) {
        ghosts_.push_back(grain);
      }
    }
  }
  std::sort(ghosts_.begin(), ghosts_.end());
  ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());
  for (const int gone : before) {
    if (!std::binary_search(ghosts_.begin(), ghosts_.end(), gone)) {
      grains[gone] = {};
    }
  }
  const Ownership& ownership = distribution_.ownership;
  std::vector<RootPlace> all, fresh;
  fresh_.assign(ghosts_.size(), 0);
  for (std::size_t k = 0; k < ghosts_.size(); ++k) {
    all.push_back({ownership.owner(ghosts_[k]), ownership.place(ghosts_[k])});
    if (!std::binary_search(before.begin(), before.end(), ghosts_[k])) {
      fresh_[k] = 1;
      fresh.push_back(all.back());
    }
  }
  const int n_own = static_cast<int>(layout_.grains().size());
  forest_ = make_star_forest(n_own, all);
  const std::unique_ptr<StarForest> asking = make_star_forest(n_own, fresh);
  wanted_.assign(n_own, 0);
  for (const int k : asking->wanted()) {
    wanted_[k] = 1;
  }
}

/// What the other ranks are told of this rank's grains: a record for each, and the places that the records name.
struct GhostGrains::Message {
  std::vector<GhostRecord> grains;
  std::vector<PlaceRecord> places;
};

GhostGrains::Message GhostGrains::message_of_own_grains(const GrainTracking& tracking) const {
  Message message;
  std::vector<PlaceRecord>& places = message.places;
  for (std::size_t k = 0; k < layout_.grains().size(); ++k) {
    const int g = layout_.grains()[k];
    const TrackedGrain& grain = tracking[g];
    message.grains.push_back({grain.frame, grain.grid.bounds(), grain.deviation,
                              static_cast<std::int32_t>(places.size()), static_cast<std::int32_t>(grain.moved.size()),
                              static_cast<std::int32_t>(grain.followed.size()), grain.all_noted ? 1 : 0});
    for (std::size_t m = 0; m < grain.moved.size(); ++m) {
      places.push_back(record_of(grain.moved[m], grain.moved_to[m]));
    }
    for (std::size_t m = 0; m < grain.followed.size(); ++m) {
      places.push_back(record_of(grain.followed[m], grain.followed_at[m]));
    }
    for (int node = 0; (grain.all_noted || wanted_[k] != 0) && node < layout_.n_nodes(g); ++node) {
      places.push_back(record_of(node, tracking.place(g, node)));
    }
  }
  return message;
}

/// Of the places that the owners have sent records of, those that this rank needs: grain by grain.
GhostGrains::Message GhostGrains::message_about_ghosts(const Message& own) const {
  Message message;
  message.grains.resize(ghosts_.size());
  forest_->copy(sizeof(GhostRecord), own.grains.data(), message.grains.data());
  std::vector<RootPlace> from;
  for (std::size_t k = 0; k < ghosts_.size(); ++k) {
    const GhostRecord& record = message.grains[k];
    const bool all = record.all_noted != 0 || fresh_[k] != 0;
    const int first = record.first_record + (all ? record.n_moved : 0);
    const int n = record.n_followed + (all ? layout_.n_nodes(ghosts_[k]) : record.n_moved);
    for (int i = 0; i < n; ++i) {
      from.push_back({distribution_.ownership.owner(ghosts_[k]), first + i});
    }
  }
  if (distribution_.ranks->any(!from.empty())) {
    message.places.resize(from.size());
    make_star_forest(static_cast<int>(own.places.size()), from)
        ->copy(sizeof(PlaceRecord), own.places.data(), message.places.data());
  }
  return message;
}

/// Takes over what its owner says of one ghost; returns the record of a place behind its last one.
const PlaceRecord* GhostGrains::take(TrackedGrain& grain, int ghost, const GhostRecord& record, bool all,
                                     const PlaceRecord* next) const {
  grain.frame = record.frame;
  grain.deviation = record.deviation;
  for (int m = 0; !all && m < record.n_moved; ++m, ++next) {
    grain.moved.push_back(next->node);
    grain.moved_to.push_back(place_of(*next));
    grain.grid.insert(next->node, grain.moved_to.back());
  }
  grain.followed.clear();
  grain.followed_at.clear();
  for (int m = 0; m < record.n_followed; ++m, ++next) {
    grain.followed.push_back(next->node);
    grain.followed_at.push_back(place_of(*next));
  }
  if (all) {
    std::vector<Vector3> places;
    Bounds bounds = record.bounds; // of the places as first noted: some may have moved out of them, or in
    for (int node = 0; node < layout_.n_nodes(ghost); ++node, ++next) {
      places.push_back(place_of(*next));
      bounds.include(places.back());
    }
    grain.grid = GrainGrid(places, bounds, reach_.between() / (1.0 - ContactReach::largest_shortening));
    grain.all_noted = true;
  }
  return next;
}

/// Brings frames, deviations and places of the ghosts up to what their owners have just found.
void GhostGrains::follow(GrainTracking& tracking) {
  if (!distribution_.is_distributed()) {
    return;
  }
  const Message message = message_about_ghosts(message_of_own_grains(tracking));
  const PlaceRecord* next = message.places.data();
  for (std::size_t k = 0; k < ghosts_.size(); ++k) {
    const GhostRecord& record = message.grains[k];
    next = take(tracking.grains()[ghosts_[k]], ghosts_[k], record, record.all_noted != 0 || fresh_[k] != 0, next);
  }
  std::fill(fresh_.begin(), fresh_.end(), 0);
  std::fill(wanted_.begin(), wanted_.end(), 0);
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
// Grains of other ranks near ours. Their owners follow them; what they know of frames, places and strays comes here
// whenever the grains are looked at, so that pairs are searched and kept by the same rules on both sides.
#include "bpm/forces/contact_list.h"

#include <algorithm>
#include <cstring>

namespace boba {

namespace {

/// What a rank must know of a grain that it does not own. Its owner's records of places: first those of nodes that
/// moved, then of those that are followed by themselves, then, where somebody needs them, all.
struct GhostRecord {
  GrainFrame frame;
  Bounds bounds;
  double stray;
  std::int32_t first_record, n_moved, n_followed, anew;
};

struct PlaceRecord {
  std::int32_t node;
  float x[3];
};

PlaceRecord record_of(std::int32_t node, const Vector3& place) {
  return {node, {static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])}};
}

Vector3 place_of(const PlaceRecord& record) {
  return {record.x[0], record.x[1], record.x[2]};
}

} // namespace

void ContactList::share_bounds(std::vector<Bounds>& bounds) const {
  static_assert(sizeof(Bounds) == 6 * sizeof(double));
  distribution_.ranks->share_rows({bounds.data()->low.data(), 6 * bounds.size()}, 6, distribution_.ownership);
}

/// Finds out which grains of other ranks stand in our pairs, and which of ours other ranks know nothing of yet.
void ContactList::find_ghosts() {
  if (!distribution_.is_distributed()) {
    return;
  }
  const std::vector<int> before = built_ ? ghosts_ : std::vector<int>{};
  ghosts_.clear();
  for (const ContactPair& pair : pairs_) {
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
      grains_[gone] = {};
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
  ghost_forest_ = make_star_forest(n_own, all);
  const std::unique_ptr<StarForest> asking = make_star_forest(n_own, fresh);
  wanted_.assign(n_own, 0);
  for (const int k : asking->wanted()) {
    wanted_[k] = 1;
  }
}

/// Brings frames, strays and places of the ghosts up to what their owners have just found.
void ContactList::follow_ghosts() {
  if (!distribution_.is_distributed()) {
    return;
  }
  std::vector<GhostRecord> own, ghosts(ghosts_.size());
  std::vector<PlaceRecord> sent, received;
  for (std::size_t k = 0; k < layout_.grains().size(); ++k) {
    const int g = layout_.grains()[k];
    const TrackedGrain& grain = grains_[g];
    own.push_back({grain.frame, grain.grid.bounds(), grain.stray, static_cast<std::int32_t>(sent.size()),
                   static_cast<std::int32_t>(grain.moved.size()), static_cast<std::int32_t>(grain.followed.size()),
                   grain.anew ? 1 : 0});
    for (std::size_t m = 0; m < grain.moved.size(); ++m) {
      sent.push_back(record_of(grain.moved[m], grain.moved_to[m]));
    }
    for (std::size_t m = 0; m < grain.followed.size(); ++m) {
      sent.push_back(record_of(grain.followed[m], grain.followed_at[m]));
    }
    for (int node = 0; (grain.anew || wanted_[k] != 0) && node < layout_.n_nodes(g); ++node) {
      sent.push_back(record_of(node, place(g, node)));
    }
  }
  ghost_forest_->copy(sizeof(GhostRecord), own.data(), ghosts.data());

  std::vector<RootPlace> from;
  for (std::size_t k = 0; k < ghosts_.size(); ++k) {
    const GhostRecord& record = ghosts[k];
    const bool all = record.anew != 0 || fresh_[k] != 0;
    const int first = record.first_record + (all ? record.n_moved : 0);
    const int n = record.n_followed + (all ? layout_.n_nodes(ghosts_[k]) : record.n_moved);
    for (int i = 0; i < n; ++i) {
      from.push_back({distribution_.ownership.owner(ghosts_[k]), first + i});
    }
  }
  if (distribution_.ranks->any(!from.empty())) {
    received.resize(from.size());
    make_star_forest(static_cast<int>(sent.size()), from)->copy(sizeof(PlaceRecord), sent.data(), received.data());
  }

  std::size_t next = 0;
  std::vector<Vector3> places;
  for (std::size_t k = 0; k < ghosts_.size(); ++k) {
    const GhostRecord& record = ghosts[k];
    TrackedGrain& grain = grains_[ghosts_[k]];
    grain.frame = record.frame;
    grain.stray = record.stray;
    const bool all = record.anew != 0 || fresh_[k] != 0;
    for (int m = 0; !all && m < record.n_moved; ++m, ++next) {
      grain.moved.push_back(received[next].node);
      grain.moved_to.push_back(place_of(received[next]));
      grain.grid.insert(received[next].node, grain.moved_to.back());
    }
    grain.followed.clear();
    grain.followed_at.clear();
    for (int m = 0; m < record.n_followed; ++m, ++next) {
      grain.followed.push_back(received[next].node);
      grain.followed_at.push_back(place_of(received[next]));
    }
    if (all) {
      places.clear();
      Bounds bounds = record.bounds; // of the places as first noted: some may have moved out of them, or in
      for (int node = 0; node < layout_.n_nodes(ghosts_[k]); ++node) {
        places.push_back(place_of(received[next++]));
        bounds.include(places.back());
      }
      grain.grid = GrainGrid(places, bounds, reach_between() / (1.0 - largest_shortening));
      grain.anew = true;
    }
  }
  std::fill(fresh_.begin(), fresh_.end(), 0);
  std::fill(wanted_.begin(), wanted_.end(), 0);
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/parallel/ranks.h"

#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

namespace boba {

/// Pieces of work that are dealt out to the ranks like cards: item i is done by rank i mod the number of ranks.
///
/// Items that lie side by side cost alike (grains of one species, rows of a lattice), so every rank has about as much
/// to do. Which rank does what is without influence on a result as long as an item's value depends on the item alone
/// and sums over items are formed after sharing, in their order. One rank does all, and shares nothing.
class DealtItems {
public:
  /// The ranks must outlive this.
  DealtItems(const Ranks& ranks, std::int64_t n) : ranks_(&ranks), n_(n) {}

  const Ranks& ranks() const { return *ranks_; }
  std::int64_t n_items() const { return n_; }
  std::int64_t n_own() const { return n_of(ranks_->rank()); }
  /// This rank's k-th item.
  std::int64_t own(std::int64_t k) const { return item_of(ranks_->rank(), k); }

  /// Each rank has filled in the entries of its own items; afterwards all ranks have all entries. Collective.
  ///
  /// \param all one entry an item
  /// \param part what of an entry is shared: a plain value without pointers, or a std::vector of such, of any size
  /// \throws std::length_error for more than 2^31 values, on all ranks.
  template <class Entry, class Part = std::identity> void share(std::vector<Entry>& all, Part part = {}) const {
    if (ranks_->is_distributed()) {
      share_parts(all, part, std::type_identity<std::remove_cvref_t<std::invoke_result_t<Part, Entry&>>>());
    }
  }

private:
  std::int64_t n_of(int rank) const { return n_ > rank ? (n_ - rank - 1) / ranks_->size() + 1 : 0; }
  std::int64_t item_of(int rank, std::int64_t k) const { return rank + k * ranks_->size(); }

  /// All ranks' values, rank by rank.
  template <class Value>
  std::vector<Value> gathered(const std::vector<Value>& own, std::span<const std::int64_t> counts) const {
    static_assert(std::is_trivially_destructible_v<Value>, "values travel as bytes");
    std::vector<Value> all(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
    ranks_->gather_all(own.data(), all.data(), counts, sizeof(Value));
    return all;
  }

  template <class Value, class Entry, class Part>
  void share_parts(std::vector<Entry>& all, Part part, std::type_identity<Value>) const {
    std::vector<std::int64_t> counts(ranks_->size());
    std::vector<Value> mine;
    for (std::int64_t k = 0; k < n_own(); ++k) {
      mine.push_back(std::invoke(part, all[own(k)]));
    }
    for (int rank = 0; rank < ranks_->size(); ++rank) {
      counts[rank] = n_of(rank);
    }
    const std::vector<Value> values = gathered(mine, counts);
    auto from = values.begin();
    for (int rank = 0; rank < ranks_->size(); ++rank) {
      for (std::int64_t k = 0; k < counts[rank]; ++k) {
        std::invoke(part, all[item_of(rank, k)]) = *from++;
      }
    }
  }

  template <class Value, class Entry, class Part>
  void share_parts(std::vector<Entry>& all, Part part, std::type_identity<std::vector<Value>>) const {
    std::vector<std::int64_t> sizes(n_), counts(ranks_->size(), 0);
    std::vector<Value> mine;
    for (std::int64_t k = 0; k < n_own(); ++k) {
      const std::vector<Value>& list = std::invoke(part, all[own(k)]);
      sizes[own(k)] = static_cast<std::int64_t>(list.size());
      mine.insert(mine.end(), list.begin(), list.end());
    }
    share(sizes);
    for (std::int64_t i = 0; i < n_; ++i) {
      counts[i % ranks_->size()] += sizes[i];
    }
    const std::vector<Value> values = gathered(mine, counts);
    auto from = values.begin();
    for (int rank = 0; rank < ranks_->size(); ++rank) {
      for (std::int64_t k = 0; k < n_of(rank); ++k) {
        const std::int64_t i = item_of(rank, k);
        std::invoke(part, all[i]).assign(from, from + sizes[i]);
        from += sizes[i];
      }
    }
  }

  const Ranks* ranks_;
  std::int64_t n_;
};

} // namespace boba

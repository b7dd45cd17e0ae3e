// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/parallel/ownership.h"

#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace boba {

/// An error that all ranks know of: one of them met it, and all of them throw it.
class RankError : public std::runtime_error {
public:
  RankError(int met_by, bool wrong_input, const std::string& what)
      : std::runtime_error(what), rank(met_by), is_wrong_input(wrong_input) {}
  int rank;            ///< the first that met it
  bool is_wrong_input; ///< it was std::invalid_argument
};

/// The ranks of a run and what they do together. Every function but rank, size and the like is collective: all ranks
/// call it, in the same order. With one rank there is no MPI, and nothing is done.
class Ranks {
public:
  /// One rank, without MPI.
  static const Ranks& alone();
  /// Those of MPI_COMM_WORLD, which must be initialised.
  static Ranks of_world();

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool is_root() const { return rank_ == 0; }
  bool is_distributed() const { return size_ > 1; }

  /// Element by element the largest of all ranks, in place.
  void largest(std::span<double> values) const;
  double largest(double value) const {
    largest({&value, 1});
    return value;
  }
  double smallest(double value) const { return -largest(-value); }
  bool any(bool value) const { return is_distributed() ? largest(value ? 1.0 : 0.0) > 0.0 : value; }
  /// Element by element whether any rank has set it (to 1; else 0), in place.
  void any(std::span<char> flags) const;
  std::int64_t sum(std::int64_t value) const;

  /// Rank 0's values for all; sizes are taken over too.
  void broadcast_bytes(void* values, std::size_t bytes) const;
  template <class T> void broadcast(T& values) const {
    if (!is_distributed()) {
      return;
    }
    if constexpr (std::is_trivially_copyable_v<T>) {
      broadcast_bytes(&values, sizeof(T));
    } else {
      std::uint64_t n = values.size();
      broadcast_bytes(&n, sizeof n);
      values.resize(n);
      broadcast_bytes(static_cast<void*>(values.data()), n * sizeof(*values.data()));
    }
  }

  /// The values of all ranks on rank 0, one rank's after the other; elsewhere nothing. \throws as gather_all
  template <class T> std::vector<T> gathered(const std::vector<T>& own) const {
    if (!is_distributed()) {
      return own;
    }
    const std::vector<std::int64_t> counts = counts_of_ranks(std::ssize(own));
    std::vector<T> all(is_root() ? std::accumulate(counts.begin(), counts.end(), std::int64_t{0}) : 0);
    gather(own.data(), all.data(), counts, sizeof(T));
    return all;
  }

  /// A table of one row a grain, whose owners have filled in theirs: afterwards all ranks have all rows.
  void share_rows(std::span<double> table, int width, const Ownership& ownership) const;

  /// Every rank's items of so many bytes, one rank's behind the other's, on all ranks; rank r has `counts[r]` of them.
  /// \throws std::length_error for 2^31 items and more, on all ranks.
  void gather_all(const void* own, void* all, std::span<const std::int64_t> counts, std::size_t item_bytes) const;

  /// Calls work() on all ranks. When it throws on any, all throw RankError with the message of the first that did.
  template <class Work> void collectively(Work&& work) const {
    if (!is_distributed()) {
      work();
      return;
    }
    Failure failure;
    try {
      work();
    } catch (const RankError&) {
      throw; // all ranks are throwing it
    } catch (const std::invalid_argument& error) {
      failure = {true, true, error.what()};
    } catch (const std::exception& error) {
      failure = {true, false, error.what()};
    }
    agree(failure);
  }

  /// The same for work that is rank 0's alone.
  template <class Work> void on_root(Work&& work) const {
    collectively([&] {
      if (is_root()) {
        work();
      }
    });
  }

private:
  struct Failure {
    bool failed = false, wrong_input = false;
    std::string message;
  };
  Ranks(int rank, int size) : rank_(rank), size_(size) {}
  void agree(const Failure& failure) const;
  std::vector<std::int64_t> counts_of_ranks(std::int64_t own) const;
  /// As gather_all, on rank 0 alone.
  void gather(const void* own, void* all, std::span<const std::int64_t> counts, std::size_t item_bytes) const;

  int rank_ = 0, size_ = 1;
};

} // namespace boba

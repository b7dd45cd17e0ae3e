// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/parallel/dealt_items.h"

#include <cstdint>
#include <exception>

namespace boba::measure {

/// Calls `body(i)` for i in [0, n) on all threads, each index once, in no order; the first exception is thrown on.
///
/// An exception may not leave an OpenMP region by itself, hence the catch. Results stay independent of the number of
/// threads as long as `body(i)` writes only to what belongs to i.
template <class Body> void parallel_loop(std::int64_t n, const Body& body) {
  std::exception_ptr first_error;
#pragma omp parallel for schedule(dynamic)
  for (std::int64_t i = 0; i < n; ++i) {
    try {
      body(i);
    } catch (...) {
#pragma omp critical(boba_measure_parallel_loop)
      if (!first_error) {
        first_error = std::current_exception();
      }
    }
  }
  if (first_error) {
    std::rethrow_exception(first_error);
  }
}

/// The same for this rank's own of some items; together the ranks do all. Collective: what is thrown on one rank is
/// thrown on all (RankError).
template <class Body> void parallel_loop(const DealtItems& items, const Body& body) {
  items.ranks().collectively([&] { parallel_loop(items.n_own(), [&](std::int64_t k) { body(items.own(k)); }); });
}

} // namespace boba::measure

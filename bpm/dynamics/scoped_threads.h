// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <omp.h>

namespace boba {

/// The calling thread's parallel regions have so many threads while this exists; afterwards as many as before.
class ScopedThreads {
public:
  explicit ScopedThreads(int n_threads) : before_(omp_get_max_threads()) { omp_set_num_threads(n_threads); }
  ~ScopedThreads() { omp_set_num_threads(before_); }
  ScopedThreads(const ScopedThreads&) = delete;
  ScopedThreads& operator=(const ScopedThreads&) = delete;

private:
  int before_;
};

} // namespace boba

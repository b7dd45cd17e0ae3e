// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <boost/align/aligned_alloc.hpp>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <cstddef>
#include <new>
#include <vector>

namespace boba {

/// Allocates on cache lines, and what is large on pages of 2 MiB where the system has them: a bond visits tens of pages
/// of four arrays, more than the processor's first table of page addresses holds at 4 KiB a page.
template <class T> struct LaneAllocator {
  using value_type = T;

  LaneAllocator() = default;
  template <class U> LaneAllocator(const LaneAllocator<U>&) {}

  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    const bool large = bytes >= large_page / 4;
    void* at = boost::alignment::aligned_alloc(large ? large_page : cache_line, bytes);
    if (at == nullptr) {
      throw std::bad_alloc();
    }
#if defined(MADV_HUGEPAGE)
    if (large) {
      // Advice only. The last page may be shared with small allocations, which do not mind.
      madvise(at, (bytes + large_page - 1) / large_page * large_page, MADV_HUGEPAGE);
    }
#endif
    return static_cast<T*>(at);
  }
  void deallocate(T* at, std::size_t) {
    boost::alignment::aligned_free(at);
  }

  template <class U> bool operator==(const LaneAllocator<U>&) const {
    return true;
  }

private:
  static constexpr std::size_t cache_line = 64, large_page = std::size_t{2} << 20;
};

/// Array whose first element lies on a cache line.
template <class T> using AlignedArray = std::vector<T, LaneAllocator<T>>;

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
// Free of library types: the module that knows PETSc includes it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boba {

/// Where the original of a leaf lies: a place in the root array of a rank.
struct RootPlace {
  int rank, index;
};

/// Copies of other ranks' values: *roots* are owned, *leaves* are copies of them. A PetscSF in a form without types of
/// PETSc.
///
/// Everything is collective: all ranks call it, in the same order.
class StarForest {
public:
  virtual ~StarForest() = default;
  /// Roots to leaves, items of `bytes` each (a multiple of 4). Neither array may be touched between begin and end, but
  /// for roots without leaves and places that are no leaf.
  virtual void begin(std::size_t bytes, const void* roots, void* leaves) = 0;
  virtual void end() = 0;
  /// Leaves to roots: each root takes the value of one of its leaves; roots without leaves keep theirs.
  virtual void collect(std::size_t bytes, const void* leaves, void* roots) = 0;
  /// Roots of this rank that have a leaf anywhere, ascending.
  virtual std::vector<int> wanted() const = 0;
  /// Messages that this rank receives and items in them, at each begin/end; its own leaves are none.
  struct Traffic {
    std::int64_t messages = 0, items = 0;
  };
  virtual Traffic incoming() const = 0;

  void copy(std::size_t bytes, const void* roots, void* leaves) {
    begin(bytes, roots, leaves);
    end();
  }
};

/// Leaf k is at `leaf_places[k]` of the leaf array (at k when there are no places) and copies the root `roots[k]`.
/// \throws std::runtime_error when PETSc's module cannot be loaded.
std::unique_ptr<StarForest> make_star_forest(int n_roots, std::span<const RootPlace> roots,
                                             std::span<const int> leaf_places = {});

/// What the module exports.
struct StarForestModule {
  void (*initialise)();
  void (*finalise)();
  StarForest* (*make)(int n_roots, int n_leaves, const RootPlace* roots, const int* leaf_places);
};

/// Ends PETSc if it was started.
void finalise_star_forests();

} // namespace boba

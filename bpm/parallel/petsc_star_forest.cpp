// SPDX-License-Identifier: GPL-3.0-or-later
// The one file of the engine that knows PETSc: a module of its own.
#include "bpm/parallel/star_forest.h"

#include <algorithm>
#include <map>
#include <petscsf.h>
#include <stdexcept>
#include <string>

namespace boba {

namespace {

void check(PetscErrorCode code, const char* doing) {
  if (code != 0) {
    const char* text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw std::runtime_error(std::string("PETSc, ") + doing + ": " + (text != nullptr ? text : "unknown error"));
  }
}

/// So many bytes as one item: of doubles where they fit, since PETSc copies number by number.
MPI_Datatype item_type(std::size_t bytes) {
  static std::map<std::size_t, MPI_Datatype> types;
  const auto [at, is_new] = types.try_emplace(bytes, MPI_DATATYPE_NULL);
  if (is_new) {
    const bool doubles = bytes % sizeof(double) == 0;
    MPI_Type_contiguous(static_cast<int>(bytes / (doubles ? sizeof(double) : sizeof(int))),
                        doubles ? MPI_DOUBLE : MPI_INT, &at->second);
    MPI_Type_commit(&at->second);
  }
  return at->second;
}

class PetscStarForest : public StarForest {
public:
  PetscStarForest(int n_roots, int n_leaves, const RootPlace* roots, const int* leaf_places) {
    static_assert(sizeof(PetscInt) == sizeof(int));
    check(PetscSFCreate(PETSC_COMM_WORLD, &forest_), "making a star forest");
    check(PetscSFSetType(forest_, PETSCSFBASIC), "choosing its type");
    PetscSFNode* nodes = nullptr;
    check(PetscMalloc1(n_leaves, &nodes), "allocating leaves");
    for (int leaf = 0; leaf < n_leaves; ++leaf) {
      nodes[leaf].rank = roots[leaf].rank;
      nodes[leaf].index = roots[leaf].index;
    }
    check(PetscSFSetGraph(forest_, n_roots, n_leaves, const_cast<int*>(leaf_places), PETSC_COPY_VALUES, nodes,
                          PETSC_OWN_POINTER),
          "describing its graph");
    check(PetscSFSetUp(forest_), "setting it up");
  }
  PetscStarForest(const PetscStarForest&) = delete;
  PetscStarForest& operator=(const PetscStarForest&) = delete;
  ~PetscStarForest() override { PetscSFDestroy(&forest_); }

  void begin(std::size_t bytes, const void* roots, void* leaves) override {
    bytes_ = bytes;
    roots_ = roots;
    leaves_ = leaves;
    check(PetscSFBcastBegin(forest_, item_type(bytes), roots, leaves, MPI_REPLACE), "beginning to copy");
  }
  void end() override { check(PetscSFBcastEnd(forest_, item_type(bytes_), roots_, leaves_, MPI_REPLACE), "copying"); }
  void collect(std::size_t bytes, const void* leaves, void* roots) override {
    check(PetscSFReduceBegin(forest_, item_type(bytes), leaves, roots, MPI_REPLACE), "beginning to collect");
    check(PetscSFReduceEnd(forest_, item_type(bytes), leaves, roots, MPI_REPLACE), "collecting");
  }
  std::vector<int> wanted() const override {
    PetscInt n_ranks = 0;
    const PetscMPIInt* ranks = nullptr;
    const PetscInt *first = nullptr, *roots = nullptr;
    check(PetscSFGetLeafRanks(forest_, &n_ranks, &ranks, &first, &roots), "looking at its leaves");
    if (n_ranks == 0) {
      return {};
    }
    std::vector<int> wanted(roots + first[0], roots + first[n_ranks]);
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    return wanted;
  }
  Traffic incoming() const override {
    PetscInt n_ranks = 0;
    const PetscMPIInt* ranks = nullptr;
    const PetscInt* first = nullptr;
    check(PetscSFGetRootRanks(forest_, &n_ranks, &ranks, &first, nullptr, nullptr), "looking at its ranks");
    int self = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &self);
    Traffic traffic;
    for (PetscInt r = 0; r < n_ranks; ++r) {
      if (ranks[r] != self) {
        ++traffic.messages;
        traffic.items += first[r + 1] - first[r];
      }
    }
    return traffic;
  }

private:
  PetscSF forest_ = nullptr;
  std::size_t bytes_ = 0;
  const void* roots_ = nullptr;
  void* leaves_ = nullptr;
};

void initialise() {
  // Signals are the program's own business.
  check(PetscOptionsSetValue(nullptr, "-no_signal_handler", "true"), "setting an option");
  check(PetscInitializeNoArguments(), "starting");
  check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr), "taking over its errors");
}

void finalise() {
  PetscFinalize();
}

StarForest* make(int n_roots, int n_leaves, const RootPlace* roots, const int* leaf_places) {
  return new PetscStarForest(n_roots, n_leaves, roots, leaf_places);
}

} // namespace

} // namespace boba

extern "C" const boba::StarForestModule boba_star_forest_module = {boba::initialise, boba::finalise, boba::make};

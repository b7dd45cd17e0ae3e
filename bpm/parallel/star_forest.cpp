// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/parallel/star_forest.h"

#include "base/program.h"

#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

namespace fs = std::filesystem;

const StarForestModule* loaded = nullptr;

/// ../lib/boba beside the program, in the build tree as installed; on Debian below lib/<architecture> too.
const StarForestModule* load() {
  const fs::path root = program_folder().parent_path();
  std::string reasons;
  for (const char* folder : {"lib/boba", "lib/x86_64-linux-gnu/boba", "lib64/boba"}) {
    const fs::path file = root / folder / "boba_petsc.so";
    if (!fs::exists(file)) {
      continue;
    }
    void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (module == nullptr) {
      reasons += fmt::format("; {}", dlerror());
      continue;
    }
    const auto* entry = static_cast<const StarForestModule*>(dlsym(module, "boba_star_forest_module"));
    if (entry != nullptr) {
      entry->initialise();
      return entry;
    }
  }
  throw std::runtime_error(fmt::format(
      "a run on several ranks needs boba_petsc.so in {}{}", (root / "lib/boba").string(),
      reasons.empty() ? ", which is not there; it is built where PETSc is (Debian: libpetsc-real-dev)" : reasons));
}

} // namespace

std::unique_ptr<StarForest> make_star_forest(int n_roots, std::span<const RootPlace> roots,
                                             std::span<const int> leaf_places) {
  if (loaded == nullptr) {
    loaded = load();
  }
  return std::unique_ptr<StarForest>(loaded->make(n_roots, static_cast<int>(roots.size()), roots.data(),
                                                  leaf_places.empty() ? nullptr : leaf_places.data()));
}

void finalise_star_forests() {
  if (loaded != nullptr) {
    loaded->finalise();
    loaded = nullptr;
  }
}

} // namespace boba

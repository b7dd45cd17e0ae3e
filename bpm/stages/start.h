// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/template_spec.h"
#include "bpm/laws/material.h"
#include "bpm/packing/packing.h"
#include "bpm/toml/scene_table.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// Told what takes time or deserves a word while a packing is made.
using Narrator = std::function<void(const std::string&)>;

/// How the many-body coefficient of some grains is given.
struct AlphaChoice {
  std::optional<double> alpha;   ///< k d
  std::optional<double> poisson; ///< looked up in the installed table
};

/// alpha or poisson of a table. \throws InputError when both are given, or none where one is needed.
AlphaChoice read_alpha(const SceneTable& table, bool is_needed);
/// The keys of such a table.
std::vector<SceneKey> alpha_keys(bool is_needed);

/// What breaks the bonds of some grains, but for the seed. \throws InputError when a key has nothing to act on.
Breaking read_breaking(const SceneTable& table);
/// When they yield. \throws InputError as above, and with break_smoothing.
Yielding read_yielding(const SceneTable& table);
/// The keys of such a table.
std::vector<SceneKey> bond_keys();

struct SceneTemplate {
  std::string name;
  TemplateSpec spec;
};

/// Those of a species that have one size.
struct GrainsOfSize {
  int template_index = 0;
  std::int64_t count = 0;
};

struct SceneSpecies {
  std::string name;
  int template_index = 0;
  std::int64_t count = 0;          ///< of all sizes together
  std::vector<GrainsOfSize> sizes; ///< empty: every grain is made from `template_index`
  AlphaChoice material;
  Breaking breaking; ///< but for the seed
  Yielding yielding;
};

/// The grains that a scene names.
struct SceneGrains {
  std::vector<SceneTemplate> templates;
  std::vector<SceneSpecies> species;
};

/// Where the files of a start are looked for.
struct StartFiles {
  std::filesystem::path folder; ///< the scene's
  bool must_exist = true;       ///< not for a run that continues from its checkpoint

  /// The file that a key names. \throws InputError when it is needed and there is none.
  std::filesystem::path file(const SceneTable& table, const std::string& key) const;
};

/// What a start makes its packing from.
struct StartContext {
  std::vector<std::shared_ptr<const GrainTemplate>> templates; ///< of the scene's [[template]] tables
  std::vector<Grain> grains;                                   ///< of its [[species]] tables, alpha settled
  Material material;
  std::uint64_t seed = 1;
  std::function<double(const AlphaChoice&)> alpha; ///< \throws InputError outside the table
  Narrator narrate;
};

/// How a scene starts: the packing before the first stage. One class per kind of start.
///
/// Beside these members a class has `static SceneSection section()`, its keys. The section is that of a first [[stage]]
/// ("insert"), whose class reads it in a constructor from a SceneTable; or it is a part of [start] whose first key
/// names a file of its format, and the class has a constructor from a SceneTable and StartFiles.
class StartEntry {
public:
  virtual ~StartEntry() = default;
  /// Refuses grains that the start cannot place. \throws InputError by SceneTable::fail.
  virtual void check(const SceneTable& table, const SceneGrains& grains) const = 0;
  /// Is the cell open on its sides, as that of a specimen is?
  virtual bool cell_is_open(const SceneGrains& grains) const = 0;
  virtual Packing make(const StartContext& context) const = 0;
  /// The files that it reads: a run may not replace them.
  virtual std::vector<std::filesystem::path> files() const { return {}; }
};

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/start.h"

#include "bpm/toml/schema.h"

#include <fmt/format.h>

namespace boba {

AlphaChoice read_alpha(const SceneTable& table, bool is_needed) {
  const AlphaChoice choice{table.maybe_real("alpha"), table.maybe_real("poisson")};
  if (choice.alpha && choice.poisson) {
    table.fail("poisson", "is given together with alpha; give one of them");
  }
  if (is_needed && !choice.alpha && !choice.poisson) {
    table.fail("alpha", "is missing; give alpha (k d) or poisson");
  }
  return choice;
}

std::vector<SceneKey> alpha_keys(bool is_needed) {
  const std::string note = is_needed ? " (this or `poisson`)" : " (default: as stored with the trajectory, else 0)";
  SceneKey alpha = above_key("alpha", "k d", -1.1, 100.0, "",
                             "many-body coefficient" + note + "; at about -1.1 the network loses its rigidity");
  SceneKey poisson =
      real_key("poisson", "", -0.8, 0.44, "",
               "Poisson's ratio; alpha follows by monotone interpolation in the installed table, which reaches no "
               "further; give alpha beyond");
  return {alpha, poisson};
}

Breaking read_breaking(const SceneTable& table) {
  Breaking breaking;
  const std::optional<double> strain = table.maybe_real("break_strain");
  for (const char* key : {"break_in", "break_smoothing", "break_scatter"}) {
    if (!strain && table.has(key)) {
      table.fail(key, "needs break_strain beside it");
    }
  }
  breaking.strain = strain.value_or(0.0);
  breaking.in_tension_only = table.text("break_in", "either") == "tension";
  breaking.smooth = table.boolean("break_smoothing", false);
  breaking.weibull_modulus = table.maybe_real("break_scatter").value_or(0.0);
  return breaking;
}

Yielding read_yielding(const SceneTable& table) {
  const std::optional<double> strain = table.maybe_real("yield_strain");
  if (!strain && table.has("yield_hardening")) {
    table.fail("yield_hardening", "needs yield_strain beside it");
  }
  if (strain && table.boolean("break_smoothing", false)) {
    table.fail("break_smoothing", "is not for bonds that yield");
  }
  return {strain.value_or(0.0), table.real("yield_hardening", 0.0)};
}

std::vector<SceneKey> bond_keys() {
  return {above_key("break_strain", "", 0.0, 10.0, "",
                    "strain (r - r0) / r0 above which a bond breaks for good; its nodes then touch like any unbonded "
                    "pair (docs/notation.md)"),
          choice_key("break_in", {"either", "tension"}, "\"either\"",
                     "bonds break when they are stretched or compressed too far, or in tension alone"),
          boolean_key("break_smoothing", "false", "a bond's force fades as 1 - (e / break_strain)^8"),
          above_key("break_scatter", "", 0.0, 1000.0, "",
                    "strengths scatter from bond to bond: Weibull's modulus, with break_strain as scale"),
          above_key("yield_strain", "", 0.0, 0.5, "",
                    "elastic strain |r - r_eq| / r_eq at which a bond yields: its length without force, r_eq, follows"),
          real_key("yield_hardening", "", 0.0, 100.0, "0",
                   "by how much that strain grows with the plastic strain of the bond; 0: perfectly plastic")};
}

std::filesystem::path StartFiles::file(const SceneTable& table, const std::string& key) const {
  std::filesystem::path path = folder / table.text(key, "");
  std::error_code error;
  if (must_exist && !std::filesystem::is_regular_file(path, error)) {
    table.fail(key, fmt::format("there is no such file ({})", path.lexically_normal().string()));
  }
  return path;
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/pressure_keys.h"

#include "bpm/io/input_error.h"

#include <fmt/format.h>

namespace boba {

std::vector<SceneKey> pressure_keys(const std::string& without) {
  return {
      above_key("pressure", "k/d", 0.0, 100.0, "", "pressure to hold" + without),
      above_key(
          "normalised_pressure", "", 0.0, 10.0, "",
          "the same as P~ = P (2 - 2 nu^2) / E; E and nu from the installed table (mean of E / (2 - 2 nu^2) over all "
          "nodes when species differ)"),
      above_key("gain", "d/(k tau)", 0.0, 10.0, "",
                "gain g of the barostat, d ln L / dt = g (P - P_target); default 1 / (3 K t_c), see docs/notation.md"),
      above_key("rate_cap", "1/tau", 0.0, 0.1, "1e-3", "largest |d ln L / dt| of the barostat"),
  };
}

ScenePressure::ScenePressure(const SceneTable& table, bool others_use_gain)
    : table_(table.name()), pressure_(table.maybe_real("pressure")),
      normalised_(table.maybe_real("normalised_pressure")), gain_(table.maybe_real("gain")),
      rate_cap_(table.real("rate_cap", Barostat().rate_cap)) {
  if (pressure_ && normalised_) {
    table.fail("normalised_pressure", "is given together with pressure; give one of them");
  }
  for (const char* key : {"gain", "rate_cap"}) {
    if (!is_given() && !others_use_gain && table.has(key)) {
      table.fail(key, "needs pressure or normalised_pressure");
    }
  }
}

std::optional<Barostat> ScenePressure::barostat(const StageContext& context) const {
  if (!is_given()) {
    return std::nullopt;
  }
  if (normalised_ && !context.numbers.modulus) {
    throw InputError(
        fmt::format("{}: {}.normalised_pressure = {:g}: E and nu are unknown, because an alpha of the packing lies "
                    "outside the installed table; give pressure (k/d) instead",
                    context.scene, table_, *normalised_));
  }
  const double pressure = normalised_ ? *normalised_ * *context.numbers.modulus : *pressure_;
  return Barostat{pressure, gain_, rate_cap_};
}

} // namespace boba

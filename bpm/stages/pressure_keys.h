// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/barostat.h"
#include "bpm/stages/stage.h"

#include <optional>
#include <string>
#include <vector>

namespace boba {

/// The keys of a stage that holds a pressure. \param without what the documentation adds for a stage without them
std::vector<SceneKey> pressure_keys(const std::string& without);

/// The pressure that a stage's table gives, itself or relative to the grains' modulus.
class ScenePressure {
public:
  /// \param others_use_gain gain and rate_cap have a use without a pressure too
  /// \throws InputError when both forms are given, or the barostat's keys without a pressure.
  explicit ScenePressure(const SceneTable& table, bool others_use_gain = false);
  bool is_given() const { return pressure_ || normalised_; }
  /// The barostat with its target, P = P~ E / (2 - 2 nu^2) when the normalised pressure P~ was given; none without a
  /// pressure. \throws InputError when E and nu are needed and unknown.
  std::optional<Barostat> barostat(const StageContext& context) const;

private:
  std::string table_; ///< name, for messages
  std::optional<double> pressure_, normalised_, gain_;
  double rate_cap_;
};

} // namespace boba

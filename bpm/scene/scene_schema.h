// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/toml/schema.h"

#include <string>
#include <vector>

namespace boba {

/// Every table a scene may have, those of registered stages and starts included: the format's only definition. The
/// reader and docs/scene.md come from it.
const std::vector<SceneSection>& scene_schema();

/// docs/scene.md.
std::string scene_reference();

} // namespace boba

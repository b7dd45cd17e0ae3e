// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/start.h"

namespace boba {

/// The grain that a [[template]] describes. \throws InputError when its keys do not make one.
SceneTemplate read_template(const SceneTable& table, const StartFiles& files);

} // namespace boba

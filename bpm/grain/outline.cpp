// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/outline.h"

#include <cmath>

namespace boba {

Outline::Outline(const TemplateSpec& spec, double scale) : shape_(shape_kind(spec.shape).make(spec, scale)) {}

Outline Outline::with_volume(const TemplateSpec& spec, double volume) {
  return Outline(spec, std::cbrt(volume / Outline(spec, 1.0).volume()));
}

} // namespace boba

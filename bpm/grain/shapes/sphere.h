// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/shapes/shape.h"

namespace boba {

/// `radius`.
class SphereKind final : public ShapeKind {
public:
  std::string name() const override { return "sphere"; }
  std::vector<std::string> keys() const override { return {"radius"}; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::vector<BoundedLength> widths(const TemplateSpec&) const override { return {}; }
  std::string text(const TemplateSpec& spec) const override;
};

} // namespace boba

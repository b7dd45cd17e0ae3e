// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/shapes/shape.h"

namespace boba {

/// `file`, a closed surface of triangles, and `scale`, its unit in d.
class MeshKind final : public ShapeKind {
public:
  std::string name() const override { return "mesh"; }
  std::vector<std::string> keys() const override { return {"file", "scale"}; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::vector<BoundedLength> widths(const TemplateSpec& spec) const override;
  std::string text(const TemplateSpec& spec) const override;
  void check(const TemplateSpec& spec) const override;
};

} // namespace boba

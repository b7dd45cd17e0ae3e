// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/shapes/shape.h"

namespace boba {

/// `polyhedron`, a name, with `radius`, that of the sphere through its outermost corners; or `vertices`. `rounding` s
/// shrinks it about its centre by 1 - s and rolls a ball round it whose radius is s times that of the largest sphere
/// inside, so that faces keep their places where all touch that sphere.
class PolyhedronKind final : public ShapeKind {
public:
  std::string name() const override { return "polyhedron"; }
  std::vector<std::string> keys() const override { return {"polyhedron", "vertices", "radius", "rounding"}; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::vector<BoundedLength> widths(const TemplateSpec& spec) const override;
  std::string text(const TemplateSpec& spec) const override;
  void check(const TemplateSpec& spec) const override;
};

} // namespace boba

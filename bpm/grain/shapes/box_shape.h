// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/shapes/shape.h"

namespace boba {

/// `size`: the edges of a cuboid.
class BoxKind : public ShapeKind {
public:
  std::string name() const override { return "box"; }
  std::vector<std::string> keys() const override { return {"size"}; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::vector<BoundedLength> widths(const TemplateSpec& spec) const override;
  std::string text(const TemplateSpec& spec) const override;
};

/// The same without a surface: bonds cross the faces.
class PeriodicBoxKind final : public BoxKind {
public:
  std::string name() const override { return "periodic_box"; }
};

/// " size=..." of a canonical text, bounds as given and of a width: three lengths along x, y and z.
std::string size_text(const TemplateSpec& spec);
std::vector<BoundedLength> given_size(const TemplateSpec& spec);
std::vector<BoundedLength> size_widths(const TemplateSpec& spec);

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/shapes/shape.h"

namespace boba {

/// The shapes that `size`, three lengths along x, y and z, describes.
class SizedKind : public ShapeKind {
public:
  std::vector<std::string> keys() const override { return {"size"}; }
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::vector<BoundedLength> widths(const TemplateSpec& spec) const override;
  std::string text(const TemplateSpec& spec) const override;
};

/// The shapes about z that `radius` and `height` describe.
class RadiusAndHeightKind : public ShapeKind {
public:
  std::vector<std::string> keys() const override { return {"radius", "height"}; }
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::string text(const TemplateSpec& spec) const override;
};

} // namespace boba

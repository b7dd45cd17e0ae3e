// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/shapes/shape.h"

namespace boba {

/// `size`, `exponent` e and `exponent_z` f: (|x/a|^e + |y/b|^e)^(f/e) + |z/c|^f = 1, with a, b, c half the size.
///
/// An exponent of 2 is round, a large one a box, 1 an octahedron. Source of the form: A. H. Barr, "Superquadrics and
/// angle-preserving transformations", IEEE Computer Graphics and Applications 1 (1981), 11.
class SuperellipsoidKind final : public ShapeKind {
public:
  std::string name() const override { return "superellipsoid"; }
  std::vector<std::string> keys() const override { return {"size", "exponent", "exponent_z"}; }
  std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const override;
  std::vector<BoundedLength> given(const TemplateSpec& spec) const override;
  std::vector<BoundedLength> widths(const TemplateSpec& spec) const override;
  std::string text(const TemplateSpec& spec) const override;
  void check(const TemplateSpec& spec) const override;
};

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/template_spec.h"

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace boba {

/// A solid centred on the origin. Lengths in d.
class SolidShape {
public:
  virtual ~SolidShape() = default;

  /// d^3.
  virtual double volume() const = 0;
  /// Half the edges of a cuboid about the origin that holds the solid.
  virtual Eigen::Vector3d half_lengths() const = 0;
  /// The factor by which the solid must be scaled for its surface to pass through x: below 1 inside, above 1 outside.
  virtual double reach(const Eigen::Vector3d& x) const = 0;
  /// Force (k d) of a wall of stiffness k at the surface: -k times the distance beyond each face, along its normal;
  /// zero inside.
  virtual Eigen::Vector3d wall_force(const Eigen::Vector3d& x) const = 0;
};

/// A length of a template that has a lower bound, d.
struct BoundedLength {
  std::string name;
  double value;
  double lowest;
};

/// All that differs from one kind of shape to the next. A new kind is a source file and a line each in shape_kinds.h
/// and shape_kinds.cpp.
class ShapeKind {
public:
  virtual ~ShapeKind() = default;

  /// What a scene calls it.
  virtual std::string name() const = 0;
  /// The keys of a [[template]] that give its size and proportions.
  virtual std::vector<std::string> keys() const = 0;
  /// The solid of a specification, scaled as a whole by `scale`.
  virtual std::unique_ptr<const SolidShape> make(const TemplateSpec& spec, double scale) const = 0;
  /// The lengths as given; with `n_nodes` they are proportions.
  virtual std::vector<BoundedLength> given(const TemplateSpec& spec) const = 0;
  /// The widths that must hold two nodes however the shape is scaled.
  virtual std::vector<BoundedLength> widths(const TemplateSpec& spec) const = 0;
  /// What `canonical_text` says of the size: with `n_nodes` the proportions alone.
  virtual std::string text(const TemplateSpec& spec) const = 0;
  /// \throws std::invalid_argument where the specification makes no solid of this kind.
  virtual void check(const TemplateSpec&) const {}
};

/// Least value of a length that is only a proportion, and least width of a grain (d).
constexpr double least_proportion = 1e-3, least_width = 2.0;

/// The kind of a specification's shape.
const ShapeKind& shape_kind(TemplateSpec::Shape shape);
/// The names of all kinds, in the order of TemplateSpec::Shape.
std::vector<std::string> shape_names();

} // namespace boba

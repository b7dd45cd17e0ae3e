// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/shape_kinds.h"

#include <array>
#include <stdexcept>
#include <utility>

namespace boba {

namespace {

/// All kinds, in the order of TemplateSpec::Shape.
const auto& all_kinds() {
  using Shape = TemplateSpec::Shape;
  static const std::array<std::pair<Shape, const ShapeKind*>, 9> kinds = {
      {{Shape::sphere, &sphere_kind()},
       {Shape::cylinder, &cylinder_kind()},
       {Shape::box, &box_kind()},
       {Shape::periodic_box, &periodic_box_kind()},
       {Shape::ellipsoid, &ellipsoid_kind()},
       {Shape::superellipsoid, &superellipsoid_kind()},
       {Shape::capsule, &capsule_kind()},
       {Shape::polyhedron, &polyhedron_kind()},
       {Shape::mesh, &mesh_kind()}}};
  return kinds;
}

} // namespace

const ShapeKind& shape_kind(TemplateSpec::Shape shape) {
  for (const auto& [known, kind] : all_kinds()) {
    if (known == shape) {
      return *kind;
    }
  }
  throw std::invalid_argument("grain template: unknown shape number");
}

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const auto& [shape, kind] : all_kinds()) {
    names.push_back(kind->name());
  }
  return names;
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/box_shape.h"
#include "bpm/grain/shapes/capsule.h"
#include "bpm/grain/shapes/cylinder.h"
#include "bpm/grain/shapes/ellipsoid.h"
#include "bpm/grain/shapes/mesh_shape.h"
#include "bpm/grain/shapes/polyhedron.h"
#include "bpm/grain/shapes/sphere.h"
#include "bpm/grain/shapes/superellipsoid.h"

#include <array>
#include <stdexcept>
#include <utility>

namespace boba {

namespace {

/// All kinds, in the order of TemplateSpec::Shape.
const auto& all_kinds() {
  static const SphereKind sphere;
  static const CylinderKind cylinder;
  static const BoxKind box;
  static const PeriodicBoxKind periodic_box;
  static const EllipsoidKind ellipsoid;
  static const SuperellipsoidKind superellipsoid;
  static const CapsuleKind capsule;
  static const PolyhedronKind polyhedron;
  static const MeshKind mesh;
  static const std::array<std::pair<TemplateSpec::Shape, const ShapeKind*>, 9> kinds = {
      {{TemplateSpec::Shape::sphere, &sphere},
       {TemplateSpec::Shape::cylinder, &cylinder},
       {TemplateSpec::Shape::box, &box},
       {TemplateSpec::Shape::periodic_box, &periodic_box},
       {TemplateSpec::Shape::ellipsoid, &ellipsoid},
       {TemplateSpec::Shape::superellipsoid, &superellipsoid},
       {TemplateSpec::Shape::capsule, &capsule},
       {TemplateSpec::Shape::polyhedron, &polyhedron},
       {TemplateSpec::Shape::mesh, &mesh}}};
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

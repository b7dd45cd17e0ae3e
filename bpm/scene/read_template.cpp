// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/read_template.h"

#include "bpm/grain/shapes/shape.h"
#include "bpm/mesh/closed_mesh.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <stdexcept>
#include <vector>

namespace boba {

namespace {

using Shape = TemplateSpec::Shape;

std::string with_article(const std::string& shape) {
  return (shape.front() == 'e' ? "an " : "a ") + shape;
}

/// "a sphere, a cylinder or a capsule": the shapes that take a key.
std::string shapes_that_take(const std::string& key) {
  std::vector<std::string> shapes;
  for (const std::string& name : shape_names()) {
    const std::vector<std::string> keys = shape_kind(shape_from_string(name)).keys();
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) {
      shapes.push_back(with_article(name));
    }
  }
  const std::string last = shapes.back();
  shapes.pop_back();
  return shapes.empty() ? last : fmt::format("{} or {}", fmt::join(shapes, ", "), last);
}

/// Keys that mean nothing for the template's shape are mistakes, not decoration.
void check_shape_keys(const SceneTable& table, Shape shape) {
  const std::vector<std::string> keys = shape_kind(shape).keys();
  const std::set<std::string> taken(keys.begin(), keys.end());
  for (const std::string& name : shape_names()) {
    for (const std::string& key : shape_kind(shape_from_string(name)).keys()) {
      if (table.has(key) && !taken.contains(key)) {
        table.fail(key, fmt::format("belongs to {}, not to {}", shapes_that_take(key), with_article(to_string(shape))));
      }
    }
  }
  if (shape == Shape::periodic_box && table.has("surface")) {
    table.fail("surface", "belongs to a grain with a surface, not to a periodic_box");
  }
  if (shape == Shape::sphere && table.has("radius") && table.has("nodes")) {
    table.fail("nodes", "is given together with radius; a sphere takes one of them");
  }
}

void read_polyhedron(const SceneTable& table, TemplateSpec& spec) {
  const std::vector<double> numbers = table.vector("vertices", {});
  for (std::size_t n = 0; n < numbers.size(); n += 3) {
    spec.vertices.emplace_back(numbers[n], numbers[n + 1], numbers[n + 2]);
  }
  for (const char* other : {"polyhedron", "radius"}) {
    if (!spec.vertices.empty() && table.has(other)) {
      table.fail(other, "is given together with vertices; a polyhedron takes one of them");
    }
  }
  spec.polyhedron = table.text("polyhedron", spec.polyhedron);
  spec.rounding = table.real("rounding", spec.rounding);
}

/// False when the file is not needed and not there: a run that continues has its grains in the checkpoint.
bool read_mesh(const SceneTable& table, const StartFiles& files, TemplateSpec& spec) {
  if (!table.has("file")) {
    table.fail("file", "is missing: a mesh is read from a file in STL, OFF, PLY or OBJ");
  }
  const std::filesystem::path path = files.file(table, "file");
  std::error_code error;
  if (!files.must_exist && !std::filesystem::is_regular_file(path, error)) {
    return false;
  }
  try {
    spec.mesh = closed_surface(read_triangle_mesh(path));
  } catch (const std::invalid_argument& fault) {
    table.fail("file", fmt::format("the mesh {}", fault.what()));
  }
  return true;
}

/// The key that a message about the whole specification points at.
const char* place_of_fault(const SceneTable& table) {
  for (const char* key : {"nodes", "vertices", "radius", "size", "file"}) {
    if (table.has(key)) {
      return key;
    }
  }
  return "name";
}

} // namespace

SceneTemplate read_template(const SceneTable& table, const StartFiles& files) {
  SceneTemplate result;
  result.name = table.text("name", "");
  TemplateSpec& spec = result.spec;
  spec.shape = shape_from_string(table.text("shape", "sphere"));
  check_shape_keys(table, spec.shape);
  spec.surface = surface_from_string(table.text("surface", "cut"));
  spec.radius = table.real("radius", spec.radius);
  spec.height = table.real("height", spec.height);
  const std::vector<double> size = table.vector("size", {20.0, 20.0, 20.0});
  spec.size = {size[0], size[1], size[2]};
  spec.exponent = table.real("exponent", spec.exponent);
  spec.exponent_z = table.maybe_real("exponent_z");
  spec.scale = table.real("scale", spec.scale);
  read_polyhedron(table, spec);
  if (const auto nodes = table.maybe_integer("nodes")) {
    spec.n_nodes = static_cast<int>(*nodes);
  }
  spec.seed = static_cast<std::uint64_t>(table.integer("seed", 1));
  if (spec.shape == Shape::mesh && !read_mesh(table, files, spec)) {
    return result;
  }
  try {
    validate(spec);
  } catch (const std::invalid_argument& error) {
    table.fail(place_of_fault(table), fmt::format("the template cannot be made: {}", error.what()));
  }
  return result;
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_spec.h"

#include "bpm/grain/shapes/shape.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

namespace boba {

namespace {

using Shape = TemplateSpec::Shape;
using Surface = TemplateSpec::Surface;

constexpr int smallest_grain = 20;
constexpr int largest_grain = 20'000'000;

void require_between(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high)) { // also refuses NaN
    throw std::invalid_argument(
        fmt::format("grain template: {} = {} is outside the allowed {} .. {}", name, value, low, high));
  }
}

constexpr double longest = 1e4; // d

/// As given: lengths, or with a number of nodes proportions.
void validate_size(const TemplateSpec& spec) {
  for (const BoundedLength& length : shape_kind(spec.shape).given(spec)) {
    require_between(length.name.c_str(), length.value, length.lowest, longest);
  }
}

/// A sheet or a thread thinner than two nodes holds no network, however often it is tried.
void validate_scaled_size(const TemplateSpec& spec) {
  const double scale = std::cbrt(*spec.n_nodes / (spec.density * nominal_volume(spec)));
  for (const BoundedLength& width : shape_kind(spec.shape).widths(spec)) {
    require_between(fmt::format("{} (scaled to {} nodes)", width.name, *spec.n_nodes).c_str(), scale * width.value,
                    width.lowest, longest);
  }
}

} // namespace

std::string to_string(Shape shape) {
  return shape_kind(shape).name();
}

std::string to_string(Surface surface) {
  return surface == Surface::cut ? "cut" : "wall";
}

Shape shape_from_string(const std::string& word) {
  const std::vector<std::string> names = shape_names();
  const auto at = std::find(names.begin(), names.end(), word);
  if (at == names.end()) {
    throw std::invalid_argument(
        fmt::format("grain template: shape = \"{}\" is not one of {}", word, fmt::join(names, ", ")));
  }
  return static_cast<Shape>(at - names.begin());
}

Surface surface_from_string(const std::string& word) {
  if (word == "cut") {
    return Surface::cut;
  }
  if (word == "wall") {
    return Surface::wall;
  }
  throw std::invalid_argument(fmt::format("grain template: surface = \"{}\" is not one of cut, wall", word));
}

bool is_single_node(const TemplateSpec& spec) {
  return spec.shape == Shape::sphere && spec.n_nodes == 1;
}

double nominal_volume(const TemplateSpec& spec) {
  return shape_kind(spec.shape).make(spec, 1.0)->volume();
}

void validate(const TemplateSpec& spec) {
  shape_kind(spec.shape).check(spec);
  validate_size(spec);
  if (spec.shape == Shape::periodic_box && spec.surface == Surface::wall) {
    throw std::invalid_argument("grain template: surface = \"wall\" has no meaning for a periodic_box; leave it out");
  }
  require_between("density", spec.density, 1.0, 2.0);
  require_between("bond_cutoff", spec.bond_cutoff, 1.1, 2.5);
  if (is_single_node(spec)) {
    return;
  }
  if (spec.n_nodes) {
    require_between("n_nodes", *spec.n_nodes, smallest_grain, largest_grain);
    validate_scaled_size(spec);
  } else {
    require_between("number of nodes (from the size)", spec.density * nominal_volume(spec), smallest_grain,
                    largest_grain);
  }
}

std::string canonical_text(const TemplateSpec& spec) {
  // Raise the version whenever build_template gives other nodes for the same specification.
  std::string text = fmt::format("boba-grain-template version=1 shape={}", to_string(spec.shape));
  if (spec.shape != Shape::periodic_box) {
    text += " surface=" + to_string(spec.surface);
  }
  if (spec.n_nodes) {
    text += fmt::format(" n_nodes={}", *spec.n_nodes);
  }
  text += shape_kind(spec.shape).text(spec);
  return text + fmt::format(" density={} bond_cutoff={} seed={}", spec.density, spec.bond_cutoff, spec.seed);
}

std::uint64_t template_hash(const std::string& canonical_text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const unsigned char c : canonical_text) {
    hash = (hash ^ c) * 0x100000001b3ULL;
  }
  return hash;
}

} // namespace boba

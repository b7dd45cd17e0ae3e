// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_spec.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

using Shape = TemplateSpec::Shape;
using Surface = TemplateSpec::Surface;

constexpr std::array shape_names{std::pair{Shape::sphere, "sphere"}, std::pair{Shape::cylinder, "cylinder"},
                                 std::pair{Shape::box, "box"}, std::pair{Shape::periodic_box, "periodic_box"}};

constexpr int smallest_grain = 20;
constexpr int largest_grain = 20'000'000;

void require_between(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high)) { // also refuses NaN
    throw std::invalid_argument(
        fmt::format("grain template: {} = {} is outside the allowed {} .. {}", name, value, low, high));
  }
}

bool is_box(Shape shape) {
  return shape == Shape::box || shape == Shape::periodic_box;
}

double volume(const TemplateSpec& spec) {
  const double r = spec.radius;
  switch (spec.shape) {
  case Shape::sphere:
    return 4.0 / 3.0 * M_PI * r * r * r;
  case Shape::cylinder:
    return M_PI * r * r * spec.height;
  default:
    return spec.size.prod();
  }
}

constexpr double longest = 1e4; // d

/// As given: lengths, or with a number of nodes proportions.
void validate_size(const TemplateSpec& spec) {
  if (is_box(spec.shape)) {
    for (int a = 0; a < 3; ++a) {
      require_between(fmt::format("size[{}]", a).c_str(), spec.size[a], spec.n_nodes ? 1e-3 : 2.0, longest);
    }
  } else if (spec.shape == Shape::cylinder) {
    require_between("radius", spec.radius, spec.n_nodes ? 1e-3 : 1.5, longest);
    require_between("height", spec.height, spec.n_nodes ? 1e-3 : 2.0, longest);
  } else if (!spec.n_nodes) {
    require_between("radius", spec.radius, 1.5, longest);
  }
}

/// A sheet or a thread thinner than two nodes holds no network, however often it is tried.
void validate_scaled_size(const TemplateSpec& spec) {
  const double scale = std::cbrt(*spec.n_nodes / (spec.density * volume(spec)));
  const auto require = [&](const std::string& name, double length) {
    require_between(fmt::format("{} (scaled to {} nodes)", name, *spec.n_nodes).c_str(), scale * length, 2.0, longest);
  };
  if (is_box(spec.shape)) {
    for (int a = 0; a < 3; ++a) {
      require(fmt::format("size[{}]", a), spec.size[a]);
    }
  } else if (spec.shape == Shape::cylinder) {
    require("diameter", 2.0 * spec.radius);
    require("height", spec.height);
  }
}

} // namespace

std::string to_string(Shape shape) {
  for (const auto& [value, name] : shape_names) {
    if (value == shape) {
      return name;
    }
  }
  throw std::invalid_argument("grain template: unknown shape number");
}

std::string to_string(Surface surface) {
  return surface == Surface::cut ? "cut" : "wall";
}

Shape shape_from_string(const std::string& word) {
  for (const auto& [value, name] : shape_names) {
    if (word == name) {
      return value;
    }
  }
  throw std::invalid_argument(
      fmt::format("grain template: shape = \"{}\" is not one of sphere, cylinder, box, periodic_box", word));
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

void validate(const TemplateSpec& spec) {
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
    require_between("number of nodes (from the size)", spec.density * volume(spec), smallest_grain, largest_grain);
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
  // With a number of nodes only the proportions count.
  const double unit = !spec.n_nodes ? 1.0 : is_box(spec.shape) ? spec.size.x() : spec.radius;
  if (is_box(spec.shape)) {
    text += fmt::format(" size={},{},{}", spec.size.x() / unit, spec.size.y() / unit, spec.size.z() / unit);
  } else if (spec.shape == Shape::cylinder) {
    text += fmt::format(" radius={} height={}", spec.radius / unit, spec.height / unit);
  } else if (!spec.n_nodes) {
    text += fmt::format(" radius={}", spec.radius);
  }
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

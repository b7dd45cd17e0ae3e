// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/read_sizes.h"

#include "bpm/scene/size_classes.h"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numbers>
#include <set>
#include <stdexcept>

namespace boba {

namespace {

constexpr std::size_t most_classes = 64;
const std::string list = "list";

struct Sizes {
  std::vector<double> diameters; // over the template's
  std::vector<double> shares;    // in any unit
};

/// A key that belongs to the other kind of distribution is a mistake.
void refuse(const SceneTable& table, std::initializer_list<const char*> keys, const std::string& distribution) {
  for (const char* key : keys) {
    if (table.has(key)) {
      table.fail(key, fmt::format("has no meaning for distribution = \"{}\"", distribution));
    }
  }
}

Sizes read_classes(const SceneTable& table) {
  const std::string distribution = table.text("distribution", "");
  if (distribution == list) {
    refuse(table, {"spread", "classes"}, distribution);
    if (!table.has("diameters")) {
      table.fail("diameters", "is missing; distribution = \"list\" needs it");
    }
    const std::vector<double> diameters = table.vector("diameters", {});
    const std::vector<double> shares = table.vector("shares", std::vector<double>(diameters.size(), 1.0));
    if (shares.size() != diameters.size()) {
      table.fail("shares", fmt::format("has {} numbers; there are {} diameters", shares.size(), diameters.size()));
    }
    return {diameters, shares};
  }
  refuse(table, {"diameters", "shares"}, distribution);
  if (!table.has("spread")) {
    table.fail("spread", fmt::format("is missing; distribution = \"{}\" needs it", distribution));
  }
  const auto n = static_cast<int>(table.integer("classes", 5));
  try {
    return {size_classes(distribution, table.real("spread", 0.0), n), std::vector<double>(n, 1.0)};
  } catch (const std::invalid_argument& error) {
    table.fail("spread", error.what());
  }
}

/// The same shape, every length times `factor`.
TemplateSpec scaled(TemplateSpec spec, double factor) {
  if (spec.n_nodes) { // lengths are proportions
    spec.n_nodes = static_cast<int>(std::lround(*spec.n_nodes * factor * factor * factor));
    return spec;
  }
  spec.radius *= factor;
  spec.height *= factor;
  spec.size *= factor;
  spec.scale *= factor;
  for (Eigen::Vector3d& vertex : spec.vertices) {
    vertex *= factor;
  }
  return spec;
}

void check_template(const SceneTable& table, const SceneTemplate& base) {
  const bool is_bulk = base.spec.shape == TemplateSpec::Shape::periodic_box;
  if (is_bulk || is_single_node(base.spec)) {
    table.fail("distribution", fmt::format("cannot scale the template \"{}\": {}", base.name,
                                           is_bulk ? "a periodic_box has no surface" : "a single node has one size"));
  }
}

int add_template(const SceneTable& table, Scene& scene, const SceneTemplate& base, const std::string& species,
                 double diameter) {
  const SceneTemplate made = {fmt::format("{} of {}, size {:.4g}", base.name, species, diameter),
                              scaled(base.spec, diameter)};
  const bool has_shape = made.spec.shape != TemplateSpec::Shape::mesh || made.spec.mesh != nullptr;
  try {
    if (has_shape) { // the file of a stored scene's mesh may be gone
      if (made.spec.n_nodes == 1) {
        throw std::invalid_argument("one node");
      }
      validate(made.spec);
    }
  } catch (const std::invalid_argument& error) {
    table.fail("distribution", fmt::format("the template \"{}\" at {:.3g} times its size cannot be made: {}", base.name,
                                           diameter, error.what()));
  }
  scene.templates.push_back(made);
  return static_cast<int>(scene.templates.size()) - 1;
}

} // namespace

std::vector<SceneKey> size_keys() {
  std::vector<std::string> distributions = size_distributions();
  distributions.push_back(list);
  return {
      required(choice_key("distribution", distributions, "", "of the grains' diameters, over that of the template")),
      real_key("spread", "", 1e-3, 0.5, "", "standard deviation over mean of the diameters; not for a list"),
      integer_key("classes", 2.0, static_cast<double>(most_classes), "5",
                  "how many sizes stand for the distribution, with the same share each; not for a list"),
      numbers_key("diameters", "", 0.05, 20.0, 1, most_classes, "of a list, over that of the template"),
      numbers_key("shares", "", 1e-6, 1e6, 1, most_classes, "of each diameter of a list, in any unit; absent: equal"),
      choice_key("by", {"number", "volume"}, "\"number\"", "what the shares and the distribution count"),
  };
}

void read_sizes(const SceneTable& table, Scene& scene, SceneSpecies& species) {
  const SceneTable* size = table.inner("size");
  if (size == nullptr) {
    return;
  }
  const SceneTemplate base = scene.templates[species.template_index];
  check_template(*size, base);
  Sizes sizes = read_classes(*size);
  if (size->text("by", "number") == "volume") {
    sizes.shares = shares_by_number(sizes.shares, sizes.diameters);
  }
  const std::vector<std::int64_t> counts = dealt_out(species.count, sizes.shares);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) {
      size->fail("distribution",
                 fmt::format("{} grains are too few: those of {:.4g} times the template's diameter would be none",
                             species.count, sizes.diameters[i]));
    }
    const int made = add_template(*size, scene, base, species.name, sizes.diameters[i]);
    species.sizes.push_back({made, counts[i]});
  }
}

void drop_replaced_templates(Scene& scene) {
  std::set<int> replaced, used;
  for (const SceneSpecies& species : scene.species) {
    (species.sizes.empty() ? used : replaced).insert(species.template_index);
  }
  std::vector<int> new_index;
  std::vector<SceneTemplate> kept;
  for (int t = 0; t < std::ssize(scene.templates); ++t) {
    new_index.push_back(static_cast<int>(kept.size()));
    if (!replaced.contains(t) || used.contains(t)) {
      kept.push_back(scene.templates[t]);
    }
  }
  for (SceneSpecies& species : scene.species) {
    for (GrainsOfSize& grains : species.sizes) {
      grains.template_index = new_index[grains.template_index];
    }
    species.template_index =
        species.sizes.empty() ? new_index[species.template_index] : species.sizes.front().template_index;
  }
  scene.templates = std::move(kept);
}

std::string realised_sizes(const SceneSpecies& species,
                           const std::vector<std::shared_ptr<const GrainTemplate>>& templates) {
  std::vector<std::int64_t> counts;
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (const GrainsOfSize& grains : species.sizes) {
    const double diameter = std::cbrt(6.0 / std::numbers::pi * templates[grains.template_index]->reference_volume);
    const auto count = static_cast<double>(grains.count);
    counts.push_back(grains.count);
    n += count;
    sum += count * diameter;
    squares += count * diameter * diameter;
  }
  const double mean = sum / n;
  const double deviation = std::sqrt(std::max(0.0, squares / n - mean * mean));
  return fmt::format("{} grains of {} sizes ({}); mean diameter {:.4g} d, standard deviation {:.3g} of that",
                     species.count, counts.size(), fmt::join(counts, ", "), mean, deviation / mean);
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/scene_size.h"

#include "bpm/io/input_error.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <string>

namespace boba {

namespace {

/// A template is cut from a larger bulk, whose pair search holds about this much for each node (bytes).
constexpr double bytes_per_template_node = 4000.0;

} // namespace

double expected_nodes(const TemplateSpec& spec) {
  if (spec.n_nodes) {
    return *spec.n_nodes;
  }
  if (spec.shape == TemplateSpec::Shape::mesh && spec.mesh == nullptr) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return spec.density * nominal_volume(spec);
}

SceneSize expected_size(const Scene& scene) {
  SceneSize size;
  for (const SceneTemplate& t : scene.templates) {
    size.template_nodes += expected_nodes(t.spec);
  }
  const bool only_single_nodes =
      std::ranges::all_of(scene.templates, [](const SceneTemplate& t) { return expected_nodes(t.spec) == 1.0; });
  double of_grains = 0.0;
  for (const SceneSpecies& species : scene.species) {
    const double nodes = expected_nodes(scene.templates[species.template_index].spec);
    const auto count = static_cast<double>(species.count);
    size.nodes += species.sizes.empty() ? count * nodes : 0.0;
    for (const GrainsOfSize& grains : species.sizes) {
      size.nodes += static_cast<double>(grains.count) * expected_nodes(scene.templates[grains.template_index].spec);
    }
    of_grains += count * (only_single_nodes ? bytes_per_single_node : bytes_per_grain);
  }
  size.bytes = of_grains + size.nodes * bytes_per_node + size.template_nodes * bytes_per_template_node;
  return size;
}

double available_memory() {
  std::ifstream in("/proc/meminfo");
  for (std::string name; in >> name;) {
    if (name == "MemAvailable:") {
      double kibibytes = 0.0;
      in >> kibibytes;
      return kibibytes * 1024.0;
    }
    in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::numeric_limits<double>::infinity(); // not Linux: the allocation itself will tell
}

void check_memory(const Scene& scene) {
  const SceneSize size = expected_size(scene);
  const double available = available_memory();
  constexpr double most_nodes = 2e9; // node numbers of one run fit 31 bits
  if (size.nodes > most_nodes || size.bytes > available) {
    throw InputError(
        fmt::format("{}: the scene asks for {:.4g} nodes ({:.4g} in templates), about {:.3g} GB; this machine has "
                    "{:.3g} GB free. Lower species.count or template.nodes",
                    scene.path.string(), size.nodes, size.template_nodes, size.bytes * 1e-9, available * 1e-9));
  }
}

} // namespace boba

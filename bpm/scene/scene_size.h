// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/scene/scene.h"

#include <cstdint>

namespace boba {

/// Memory of a run beyond its templates, for each node (bytes): the engine's state and one copy for files.
constexpr double bytes_per_node = 250.0;
/// The same for each grain: its place, and its share of the pairs with neighbours in a dense packing. Measured 1 kB for
/// each of 20000 single nodes, which have one list, and 16 kB for grains of 20 nodes, at a packing fraction of 0.2.
constexpr double bytes_per_single_node = 1.2e3, bytes_per_grain = 16e3;

/// How large a scene is, from its numbers alone.
struct SceneSize {
  double nodes = 0.0;          ///< of the packing
  double template_nodes = 0.0; ///< of all templates together
  double bytes = 0.0;          ///< needed at most, building included
};

/// Nodes a template will have, about, before it is built; NaN for a mesh whose file is gone, which only a run that
/// continues has.
double expected_nodes(const TemplateSpec& spec);

/// For scenes that place their own grains, on one rank; zero for a start from files.
SceneSize expected_size(const Scene& scene);

/// Memory that the system can give without swapping (bytes), from /proc/meminfo.
double available_memory();

/// \throws InputError when the scene needs more memory than there is, with both numbers.
void check_memory(const Scene& scene);

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/scene/scene.h"

namespace boba {

/// The keys of [species.size].
std::vector<SceneKey> size_keys();

/// Gives a species with a [species.size] the sizes that the table describes, and the scene a template for each.
/// A species without one stays as it is. \throws InputError when the table makes no sense for its template.
void read_sizes(const SceneTable& table, Scene& scene, SceneSpecies& species);

/// Takes templates away that only species with sizes name: no grain is made from them.
void drop_replaced_templates(Scene& scene);

/// "100 grains of 5 sizes (20, 20, 20, 20, 20); mean diameter 9.98 d, standard deviation 0.149 of that": of the
/// templates as they were built, a grain's diameter being that of the sphere of its volume.
std::string realised_sizes(const SceneSpecies& species,
                           const std::vector<std::shared_ptr<const GrainTemplate>>& templates);

} // namespace boba

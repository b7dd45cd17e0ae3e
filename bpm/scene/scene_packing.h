// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stable_step.h"
#include "bpm/scene/poisson_table.h"
#include "bpm/scene/scene.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// alpha as given, or from the table. \throws InputError outside the table, and where the network is not stable.
double resolve_alpha(const AlphaChoice& choice, const Material& material, const PoissonTable& table);

/// The packing a scene starts from: templates built or taken from the cache, grains placed; or read from its files.
/// \throws InputError, std::invalid_argument, std::runtime_error from whatever part refuses.
Packing make_start(const Scene& scene, const PoissonTable& table, const Narrator& narrate);

/// The time step that dt = "auto" stands for, as a share of the largest stable one. Source: docs/stability.md, "Time
/// step".
inline constexpr double automatic_share = 0.6;

/// Puts the step that `dt = "auto"` stands for into the options, and into the overrides, so that whatever reads the
/// scene again (a checkpoint, a trajectory) finds the number. Returns the largest stable step of the packing, if any.
std::optional<PackingStep> settle_time_step(Scene& scene, const Packing& packing);

/// \throws InputError, naming run.dt, when the scene's step is not below the packing's stable one.
void check_time_step(const Scene& scene, const std::optional<PackingStep>& stable);

/// E / (2 - 2 nu^2) of the grains (k/d), mean over all nodes; empty when an alpha lies outside the table.
/// Source: docs/notation.md, "Derived numbers".
std::optional<double> effective_modulus(const Packing& packing, const Material& material, const PoissonTable& table);

} // namespace boba

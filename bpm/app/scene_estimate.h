// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/run_quantities.h"
#include "bpm/scene/scene.h"

#include <string>
#include <vector>

namespace boba {

/// Number of steps of each stage, and whether it is known or a guess.
struct StageEstimates {
  std::vector<double> steps;
  std::vector<bool> exact;
};

/// Shear, hold and press know their length. A compression is taken to end where packings of spheres are known to be,
/// phi = 0.6 + 0.27 (P~ / 0.1)^(2/3) with phi counted to d/2 outside the nodes, plus a fifth for settling.
/// Source: Clemmer, Hackney & Grest: phi_c about 0.6, P~ ~ (phi - phi_c)^(3/2), phi about 0.87 at P~ = 0.1.
StageEstimates estimate_stages(const std::vector<SceneStage>& stages, const Packing& packing,
                               const PackingNumbers& numbers, double dt);

struct Measurement {
  double bytes = 0.0; ///< of the engine's state, by the growth of resident memory
  double node_steps_per_second = 0.0;
  std::string instruction_set;
};

/// Runs the packing at rest for about half a second.
Measurement measure_speed(const Packing& packing, const Scene& scene);

/// What this scene does not need and therefore does not pay for.
std::vector<std::string> skipped_work(const Packing& packing, const Scene& scene);

} // namespace boba

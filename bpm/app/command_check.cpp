// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command.h"
#include "bpm/app/progress_display.h"
#include "bpm/app/scene_estimate.h"
#include "bpm/app/thread_warning.h"
#include "bpm/io/printable.h"
#include "bpm/packing/lane_layout.h"
#include "bpm/packing/packing_numbers.h"
#include "bpm/scene/continued_run.h"
#include "bpm/scene/scene_packing.h"
#include "bpm/scene/scene_size.h"
#include "bpm/scene/scene_stages.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace boba {

namespace {

struct CheckArguments {
  std::filesystem::path scene;
  std::vector<std::string> overrides;
  std::optional<int> threads;
  bool quick = false;
};

void print_templates(const Packing& packing, const Scene& scene) {
  std::vector<int> grains(packing.templates.size(), 0);
  for (const Grain& grain : packing.grains) {
    ++grains[grain.template_index];
  }
  constexpr std::size_t most_lines = 8;
  for (std::size_t t = 0; t < std::min(packing.templates.size(), most_lines); ++t) {
    const GrainTemplate& grain = *packing.templates[t];
    const std::string name = t < scene.templates.size() ? scene.templates[t].name : fmt::format("network {}", t);
    fmt::print("  {}: {} grains of {} nodes, {} bonds ({:.2f} a node)\n", printable(name), grains[t], grain.n_nodes(),
               grain.bonds.size(), static_cast<double>(grain.bonds.size()) / grain.n_nodes());
  }
  if (packing.templates.size() > most_lines) {
    fmt::print("  and {} more networks\n", packing.templates.size() - most_lines);
  }
}

/// Returns whether the time step is stable for every grain of the packing.
bool print_time_step(const Scene& scene, const std::optional<PackingStep>& stable) {
  if (!stable) {
    fmt::print("time step: {:g} tau; no grain has bonds\n", scene.options.dt);
    return true;
  }
  const bool good = scene.options.dt < stable->dt;
  fmt::print(
      "time step: {:g} tau; bonds are stable up to {:.4g} tau (alpha = {:g}), deep contacts to somewhat less{}\n",
      scene.options.dt, stable->dt, stable->alpha, good ? "" : ": TOO LARGE");
  return good;
}

void print_memory(const Packing& packing, double bytes, std::int64_t nodes) {
  double in_templates = 0.0;
  for (const auto& grain : packing.templates) {
    in_templates += static_cast<double>(grain->n_nodes()) * sizeof(Vector3) +
                    static_cast<double>(grain->bonds.size()) * sizeof(Bond);
  }
  fmt::print("memory: {:.1f} MB, {:.0f} bytes a node (measured; templates: {:.1f} MB more); {:.1f} GB are free\n",
             bytes * 1e-6, bytes / static_cast<double>(nodes), in_templates * 1e-6, available_memory() * 1e-9);
}

void print_stages(const Scene& scene, const StageContext& context, double node_steps_per_second) {
  const auto duration = [&](double steps) {
    return readable_duration(steps * static_cast<double>(context.numbers.n_nodes) / node_steps_per_second);
  };
  double total = 0.0;
  for (const SceneStage& stage : scene.stages) {
    const StageLength length = stage.entry->estimate(context);
    const double steps = std::ceil(length.time / scene.options.dt - 1e-6);
    total += steps;
    fmt::print("{}: {}{:.0f} steps, {:g} tau{}\n", stage.label(), length.is_exact ? "" : "about ", steps,
               steps * scene.options.dt, node_steps_per_second > 0.0 ? ", " + duration(steps) : "");
  }
  if (node_steps_per_second > 0.0) {
    fmt::print("speed: {:.3g} M node-steps/s with {} threads, measured on the packing as it starts; in all about {}\n",
               node_steps_per_second * 1e-6, scene.options.threads, duration(total));
  }
}

ExitCode check_quickly(const Scene& scene) {
  const SceneSize size = expected_size(scene);
  check_memory(scene);
  fmt::print("{}: {}\nabout {:.0f} nodes, {:.1f} MB at most; {:.1f} GB are free\n", scene.path.string(),
             printable(scene.title), size.nodes, size.bytes * 1e-6, available_memory() * 1e-9);
  return ExitCode::done;
}

ExitCode check(const CheckArguments& a) {
  const auto narrate = [](const std::string& text) { fmt::print("{}\n", printable(text)); };
  Scene scene = read_scene_to_run(a.scene, a.overrides, narrate);
  scene.options.threads = a.threads.value_or(scene.options.threads);
  warn_of_threads(scene.options.threads);
  if (a.quick) {
    return check_quickly(scene);
  }
  const PoissonTable table = PoissonTable::installed();
  const Packing packing = make_start(scene, table, narrate);
  const std::optional<double> modulus = effective_modulus(packing, scene.material, table);
  const StageContext context = stage_context(scene, packing, modulus);
  prepare_stages(scene, context); // says what would stop a run
  const PackingNumbers& numbers = context.numbers;
  fmt::print("{}: {}\n{} nodes, {} grains, phi_reference {:.4g}\n", scene.path.string(), printable(scene.title),
             numbers.n_nodes, packing.n_grains(), numbers.phi_reference(packing.box));
  print_templates(packing, scene);
  fmt::print("lanes filled: {:.0f} %\n", 100.0 * LaneLayout(packing).filled());
  const bool stable = print_time_step(scene, settle_time_step(scene, packing));
  if (!stable) {
    return ExitCode::check_failed; // it would blow up while its speed is measured
  }
  const Measurement measured = measure_speed(packing, scene);
  print_memory(packing, measured.bytes, numbers.n_nodes);
  print_stages(scene, context, measured.node_steps_per_second);
  fmt::print("instruction set: {}\nskipped: {}\n", measured.instruction_set,
             fmt::join(skipped_work(packing, scene), "; "));
  return ExitCode::done;
}

} // namespace

CommandBody add_check_command(CLI::App& app) {
  auto a = std::make_shared<CheckArguments>();
  app.add_option("scene", a->scene, "scene file (TOML)")->required();
  app.add_option("--set", a->overrides, "replace a value: section.key=value, stage.0.key=value")
      ->type_name("PLACE=VALUE")
      ->allow_extra_args(false);
  app.add_option("--threads", a->threads, "threads")->check(CLI::Range(1, 1024));
  app.add_flag("--quick", a->quick, "read and check the scene, estimate its size; build and measure nothing");
  app.footer("Exit code 3 when the time step is not stable.");
  return [a] { return check(*a); };
}

} // namespace boba

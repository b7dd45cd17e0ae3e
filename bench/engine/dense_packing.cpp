// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/engine/dense_packing.h"

#include "bpm/archive/archive.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/grain/template_cache.h"
#include "bpm/io/checkpoint.h"
#include "bpm/io/input_error.h"
#include "bpm/packing/insertion.h"
#include "bpm/stages/compress.h"

#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <utility>

namespace boba::bench {

double dense_pressure(double alpha) {
  if (alpha == 0.0) {
    return 0.1 * 1.84 / (2.0 - 2.0 * 0.25 * 0.25);
  }
  if (alpha == 2.0) {
    return 0.1 * 4.05 / (2.0 - 2.0 * 0.01 * 0.01);
  }
  throw std::invalid_argument("dense packing: alpha must be 0 or 2");
}

CellRates dense_shear_rates(double excess_pressure, double rate) {
  return {.shear = rate, .dilation = 0.02 * excess_pressure};
}

namespace {

Packing loose_packing(int n_grains, int n_nodes, double alpha) {
  TemplateSpec spec;
  spec.n_nodes = n_nodes;
  Insertion insertion;
  insertion.templates = {std::make_shared<const GrainTemplate>(TemplateCache().get(spec))};
  insertion.grains.assign(n_grains, Grain{.alpha = alpha});
  insertion.packing_fraction = 0.38;
  return insert_at_random(insertion);
}

Snapshot compressed_and_sheared(const Packing& loose, double pressure) {
  Stepper stepper(loose, Material{}, SimulationOptions{.threads = 2});
  CompressDriver driver(
      {.barostat = {.pressure = pressure}, .rate = 2e-3, .pressure_tolerance = 0.01, .kinetic_tolerance = 1e-2});
  stepper.start();
  driver.begin(stepper);
  while (!driver.finished()) {
    stepper.advance(Virial::trace);
    stepper.move_cell(driver.update(stepper));
  }
  while (stepper.strain() < 0.1) {
    stepper.advance(Virial::trace);
    stepper.move_cell(dense_shear_rates(stepper.pressure() - pressure));
  }
  stepper.advance(Virial::full);
  return take_snapshot(stepper.moving(), {.velocity = true});
}

void archive_state(Archive& archive, Packing& packing) {
  Matrix3 cell = packing.box.h();
  archive.field("position", packing.position);
  archive.field("velocity", packing.velocity);
  archive.field("cell", cell);
  packing.box.set_h(cell);
}

/// The state in a folder of the cache; nothing when there is none, or none that this version reads.
std::optional<SavedState> kept_in(const std::filesystem::path& store) {
  if (!std::filesystem::exists(store)) {
    return std::nullopt;
  }
  try {
    return latest_checkpoint(store).data;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

} // namespace

Packing dense_packing(int n_grains, int n_nodes, double alpha) {
  Packing packing = loose_packing(n_grains, n_nodes, alpha);
  const std::filesystem::path store =
      default_cache_directory() / fmt::format("dense-{}x{}-alpha{}", n_grains, n_nodes, alpha);
  const std::optional<SavedState> kept = kept_in(store);
  if (!kept) {
    const Snapshot dense = compressed_and_sheared(packing, dense_pressure(alpha));
    packing.position = dense.position;
    packing.velocity = dense.velocity;
    packing.box.set_h(dense.box.h());
    SavedState data;
    Archive archive = Archive::saving_to(data);
    archive_state(archive, packing);
    std::filesystem::create_directories(store);
    write_checkpoint(store, data);
  } else {
    Archive archive = Archive::reading_from(*kept);
    archive_state(archive, packing);
  }
  return packing;
}

} // namespace boba::bench

// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/specimen/dynamic_box.h"

#include "bpm/dynamics/simulation.h"
#include "bpm/stages/compress.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/shear.h"

#include <memory>
#include <stdexcept>

namespace boba::calibration {

namespace {

Simulation at_rest(const GrainTemplate& box, double alpha) {
  if (!box.period) {
    throw std::invalid_argument("dynamic moduli need a periodic network");
  }
  return {make_packing(Box(-0.5 * *box.period, *box.period), {std::make_shared<GrainTemplate>(box)},
                       {Placement{.grain = {.alpha = alpha}}}),
          Material{}, SimulationOptions{}};
}

/// Keeps the totals of the last step of a stage.
class LastStep : public Observer {
public:
  bool wants(const StepForecast& forecast) override { return forecast.last_of_stage; }
  void observe(const Simulation& simulation, const StageProgress&) override { totals = simulation.totals(); }
  Totals totals;
};

} // namespace

DynamicModuli dynamic_moduli(const GrainTemplate& box, double alpha, double pressure, double strain, double settle) {
  DynamicModuli moduli;
  LastStep last;
  Observer* observers[] = {&last};

  Simulation compressed = at_rest(box, alpha);
  compressed.run(0,
                 CompressDriver({.barostat = {.pressure = pressure, .gain = {}, .rate_cap = 1e-3},
                                 .rate = 1e-5,
                                 .pressure_tolerance = 1e-3,
                                 .kinetic_tolerance = 1e-6,
                                 .max_time = 1e5}),
                 {});
  compressed.run(1, HoldDriver({.time = settle, .barostat = {}}), observers);
  moduli.bulk = last.totals.pressure / (1.0 - compressed.box().volume() / box.period->prod());

  Simulation sheared = at_rest(box, alpha);
  sheared.run(0, ShearDriver({.rate = 1e-5, .strain = strain, .remap = Remap::positions, .barostat = {}}), {});
  sheared.run(1, HoldDriver({.time = settle, .barostat = {}}), observers);
  moduli.shear = last.totals.stress[3] / sheared.strain();
  return moduli;
}

} // namespace boba::calibration

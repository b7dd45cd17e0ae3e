// SPDX-License-Identifier: GPL-3.0-or-later
// The barostat: from which gain it is unstable, how it answers a step of the target, and how far from its target the
// pressure is under shear.
#include "bpm/dynamics/barostat.h"

#include "bench/stability/cases.h"
#include "bpm/dynamics/elastic_probe.h"
#include "bpm/dynamics/simulation.h"

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace boba::bench {

namespace {

constexpr double normalised = 0.1;

struct Deviation {
  double mean = 0.0, rms = 0.0, largest = 0.0; ///< of P / P_target - 1
};

/// Runs with a held pressure; deviations over the second half.
class Hold {
public:
  Hold(Stepper& stepper, Barostat barostat, double gain) : stepper_(stepper), barostat_(barostat), gain_(gain) {}

  double deviation() const { return stepper_.pressure() / barostat_.pressure - 1.0; }

  void step(double shear) {
    stepper_.advance(Virial::trace);
    stepper_.move_cell({.shear = shear, .dilation = barostat_rate(barostat_, gain_, stepper_.pressure())});
  }

  Deviation run(double time, double shear) {
    const auto n = static_cast<std::int64_t>(time / stepper_.options().dt);
    const std::int64_t n_last = n - n / 2; // steps that count
    Deviation d;
    for (std::int64_t i = 0; i < n; ++i) {
      step(shear);
      if (i >= n / 2) {
        const double now = deviation(), share = 1.0 / static_cast<double>(n_last);
        d.mean += now * share;
        d.rms += now * now * share;
        d.largest = std::max(d.largest, std::abs(now));
      }
    }
    d.rms = std::sqrt(d.rms);
    return d;
  }

private:
  Stepper& stepper_;
  Barostat barostat_;
  double gain_;
};

/// The target rises by 1 %: when the pressure has gone 63 % of the way, how far it overshoots, what is left at the end.
void step_response(const Folder& folder, const Packing& packing, double pressure, double modulus) {
  OutputFile file =
      csv(folder, "barostat_step", "gain,rate_cap,expected_time_tau,time_tau,overshoot,rms_at_end,largest_at_end");
  for (const double cap : {1e-3, 1e9}) { // the default, and none: without it an unstable gain has nothing to hold it
    for (int quarters = cap < 1.0 ? -20 : -4; quarters <= 8; ++quarters) {
      const double gain = std::pow(10.0, 0.25 * quarters), expected = 1.0 / (3.0 * gain * modulus);
      Stepper stepper(packing, {}, {.dt = 0.1});
      stepper.start();
      Hold hold(stepper, {.pressure = 1.01 * pressure, .rate_cap = cap}, gain);
      double reached = NAN, overshoot = 0.0;
      Deviation end{NAN, NAN, NAN};
      try {
        const auto n = static_cast<std::int64_t>(std::min(std::max(20.0 * expected, 1000.0), 20000.0) / 0.1);
        for (std::int64_t i = 0; i < n; ++i) {
          hold.step(0.0);
          const double rise = (stepper.pressure() / pressure - 1.0) / 0.01;
          reached = std::isnan(reached) && rise >= 1.0 - std::exp(-1.0) ? stepper.time() : reached;
          overshoot = std::max(overshoot, rise - 1.0);
        }
        end = hold.run(200.0, 0.0);
      } catch (const BlowUp&) {
      } catch (const std::invalid_argument&) { // without a cap the cell may turn inside out within a step
      }
      file.print("{:.4e},{},{:.4g},{:.4g},{:.4g},{:.3e},{:.3e}\n", gain, cap, expected, reached, overshoot, end.rms,
                 end.largest);
      file.flush();
    }
  }
  file.close();
}

void under_shear(const Folder& folder, const Packing& packing, double pressure) {
  OutputFile file =
      csv(folder, "barostat_shear", "rate_per_tau,gain,is_default,mean,rms,largest,modulus_k_d,crossing_tau");
  for (const double rate : {1.024e-3, 2.56e-4, 6.4e-5, 1.6e-5}) {
    for (const double asked : {0.0, 1e-5, 1e-4, 1e-3, 5e-3, 0.02, 0.05, 0.2, 1.0, 5.0}) {
      Stepper stepper(packing, {}, {.dt = 0.1});
      stepper.start();
      const double modulus = affine_bulk_modulus(stepper.moving()),
                   crossing = sound_crossing(stepper.moving(), modulus);
      const Barostat barostat{.pressure = pressure, .gain = asked > 0.0 ? std::optional(asked) : std::nullopt};
      const double gain = barostat_gain(barostat, {modulus, crossing, rate});
      Deviation d{NAN, NAN, NAN};
      try {
        const double strain = rate < 2e-5 ? 0.1 : 0.3;
        d = Hold(stepper, barostat, gain).run(strain / rate, rate);
      } catch (const BlowUp&) {
      }
      file.print("{:.4e},{:.4e},{},{:.3e},{:.3e},{:.3e},{:.4f},{:.3f}\n", rate, gain, asked == 0.0, d.mean, d.rms,
                 d.largest, modulus, crossing);
      file.flush();
    }
  }
  file.close();
}

} // namespace

void barostat(const Folder& folder) {
  const double alpha = 2.0, pressure = pressure_of(normalised, alpha);
  const Packing packing =
      compressed({.n_grains = 16, .n_nodes = 100, .alpha = alpha, .pressure = normalised, .tolerance = 1e-5});
  Stepper probe(packing, {}, {});
  probe.start();
  under_shear(folder, packing, pressure);
  step_response(folder, packing, pressure, affine_bulk_modulus(probe.moving()));
}

} // namespace boba::bench

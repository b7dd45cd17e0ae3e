// SPDX-License-Identifier: GPL-3.0-or-later
// A million steps of shear in double and in mixed precision: what a run is made for, where its energy goes, and whether
// grains are left behind.
#include "bench/stability/cases.h"
#include "bench/stability/ledger.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/measure/blocking.h"
#include "bpm/stages/shear.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace boba::bench {

namespace {

constexpr double rate = 1.024e-4, strain = 10.24; ///< 1e6 steps of 0.1 tau
constexpr double strain_at_first = 1.024;         ///< before the means begin
constexpr int steps_between = 200;

/// What is compared. A disturbance far below anything measured shows what becomes of double's own rounding.
struct Case {
  const char* name;
  Precision precision;
  double disturbance; ///< velocities at the start, d/tau
};
constexpr Case cases[] = {
    {"double", Precision::full, 0.0}, {"double disturbed", Precision::full, 1e-9}, {"mixed", Precision::mixed, 0.0}};

/// Looks at every so many steps.
class Regular : public Observer {
public:
  bool wants(const StepForecast& forecast) final { return forecast.step % steps_between == 0; }
  void observe(const Simulation& simulation, const StageProgress&) final {
    if (simulation.step() > last_) { // ends of stages are told twice
      last_ = simulation.step();
      look(simulation);
    }
  }

private:
  virtual void look(const Simulation& simulation) = 0;
  std::int64_t last_ = 0;
};

/// Pressure, friction and energies of a sheared packing, and the powers between them.
class Books : public Regular {
public:
  Books(const Packing& packing, const Material& material) : ledger_(packing, material) { gradient_(0, 1) = rate; }

  static std::string columns() {
    return "P_kd,P_error,mu,mu_error,kinetic_kd2,kinetic_error,box_kd2_tau,box_error,many_body_kd2_tau,many_body_error,"
           "damping_kd2_tau,damping_error,imbalance_kd2_tau,imbalance_error,momentum_a_node";
  }
  std::string row() const {
    std::string text;
    for (const std::vector<double>& values : series_) {
      const measure::BlockedMean mean = measure::blocked_mean(values);
      text += fmt::format("{:.8g},{:.3g},", mean.mean, mean.standard_error);
    }
    return text + fmt::format("{:.3e}", largest_momentum_);
  }

private:
  void look(const Simulation& simulation) override {
    const Snapshot snapshot = simulation.snapshot({.velocity = true});
    Vector3 momentum = Vector3::Zero();
    for (const Vector3& v : snapshot.velocity) {
      momentum += v;
    }
    largest_momentum_ = std::max(largest_momentum_, momentum.norm() / static_cast<double>(snapshot.velocity.size()));
    if (simulation.strain() < strain_at_first) {
      return;
    }
    const Powers p = ledger_.at(snapshot, gradient_);
    const double given = p.box - p.damping_box + p.many_body - p.damping;
    const double energy = p.kinetic + p.bonds + p.contacts;
    const Totals& totals = simulation.totals();
    if (time_ > 0.0) { // what was given to the packing since the last look, less what it has now more
      const double stored = (energy - energy_) / (simulation.time() - time_);
      const std::array<double, 7> now = {
          totals.pressure, totals.mu(), p.kinetic, p.box, p.many_body, p.damping, 0.5 * (given + given_) - stored};
      for (std::size_t k = 0; k < now.size(); ++k) {
        series_[k].push_back(now[k]);
      }
    }
    time_ = simulation.time();
    energy_ = energy;
    given_ = given;
  }

  Ledger ledger_;
  Matrix3 gradient_ = Matrix3::Zero();
  std::array<std::vector<double>, 7> series_;
  double largest_momentum_ = 0.0, time_ = 0.0, energy_ = 0.0, given_ = 0.0;
};

/// How far the centre of a lone grain is from where the cell's shear carries it.
class Drift : public Regular {
public:
  explicit Drift(const Packing& packing) : origin_(packing.box.origin()) {
    for (const Vector3& x : packing.position) {
      begin_ += x / static_cast<double>(packing.position.size());
    }
  }
  double largest() const { return largest_; }
  double last() const { return last_; }

private:
  void look(const Simulation& simulation) override {
    const Vector3 carried = begin_ + Vector3(simulation.strain() * (begin_[1] - origin_[1]), 0.0, 0.0);
    last_ = (simulation.snapshot().grain_centre[0] - carried).norm();
    largest_ = std::max(largest_, last_);
  }

  Vector3 origin_, begin_ = Vector3::Zero();
  double largest_ = 0.0, last_ = 0.0;
};

void run(const Packing& packing, const Material& material, Precision precision, Observer& observer) {
  Simulation simulation(packing, material, {.dt = 0.1, .precision = precision});
  Observer* observers[] = {&observer};
  simulation.run(0, ShearDriver({.rate = rate, .strain = strain}), observers);
}

} // namespace

void long_shear(const Folder& folder) {
  OutputFile file = csv(folder, "long_shear", "grains,nodes,alpha_kd,precision,steps," + Books::columns());
  OutputFile lone = csv(folder, "long_shear_lone", "nodes,alpha_kd,precision,steps,largest_drift_d,last_drift_d");
  for (const double alpha : {2.0, -0.8}) {
    const PackingSpec spec{.alpha = alpha};
    const Packing packing = compressed(spec);
    const auto grain = ball(100);
    Placement placement;
    placement.grain.alpha = alpha;
    const Packing one = make_packing(Box(Vector3(-6.0, -9.0, -6.0), Vector3(12.0, 12.0, 12.0)), {grain}, {placement});
    for (const Case& c : cases) {
      Packing begin = packing;
      if (c.disturbance > 0.0) {
        shake(begin, c.disturbance);
      }
      Books books(begin, Material{});
      run(begin, Material{}, c.precision, books);
      file.print("{},{},{},{},1000000,{}\n", spec.n_grains, spec.n_nodes, alpha, c.name, books.row());
      file.flush();
      if (c.disturbance == 0.0) { // the lone grain starts alike
        Drift drift(one);
        run(one, Material{}, c.precision, drift);
        lone.print("{},{},{},1000000,{:.3e},{:.3e}\n", grain->n_nodes(), alpha, c.name, drift.largest(), drift.last());
        lone.flush();
      }
    }
  }
  file.close();
  lone.close();
}

} // namespace boba::bench

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/io/input_error.h"
#include "bpm/io/lammps_dump.h"
#include "bpm/io/lammps_packing.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

struct ForcesArguments {
  std::filesystem::path reference, state, output;
  std::optional<std::int64_t> timestep, frame;
  double alpha = 0.0;
  Material material;
  int threads = 1;
  bool pressure = false;
  bool force = false;
};

void check_number(const char* name, double value, double lowest, double highest) {
  if (!std::isfinite(value) || value < lowest || value > highest) {
    throw InputError(fmt::format("{} = {}: must be from {:g} to {:g}", name, value, lowest, highest));
  }
}

void check_arguments(const ForcesArguments& a) {
  check_number("--alpha", a.alpha, -1e6, 1e6);
  check_number("--k", a.material.k, 1e-12, 1e12);
  check_number("--gamma", a.material.gamma, 0.0, 1e12);
  check_number("--k3", a.material.k3, 0.0, 1e12);
  if (a.output.empty() && !a.pressure) {
    throw InputError("forces: nothing to do; give --output FILE, --pressure, or both");
  }
  if (!a.output.empty()) {
    try {
      check_file_mode(a.output, a.force ? FileMode::overwrite : FileMode::create);
    } catch (const std::runtime_error& error) {
      throw InputError(std::string(error.what()) + "; --force replaces it");
    }
  }
}

/// Pressure is minus the stress, kinetic part included.
void print_pressure(const Totals& totals) {
  std::string line;
  for (const double stress : totals.stress) {
    line += fmt::format("{}{:.17g}", line.empty() ? "" : " ", -stress);
  }
  fmt::print("{}\n", line);
}

/// \throws std::runtime_error: numbers that are none do not leave the program as results.
void check_forces(const Topology& topology, const Snapshot& snapshot) {
  for (std::size_t node = 0; node < snapshot.force.size(); ++node) {
    if (!snapshot.force[node].allFinite()) {
      throw std::runtime_error(
          fmt::format("the force on node {} is not a finite number: two nodes lie at the same place, "
                      "or lengths or coefficients are beyond what numbers can hold",
                      topology.id[node]));
    }
  }
}

ExitCode compute(const ForcesArguments& a) {
  check_arguments(a);
  LammpsSource source{a.reference, std::nullopt, a.timestep, a.frame};
  if (!a.state.empty()) {
    source.state = a.state;
  }
  LammpsPacking read = read_lammps_packing(source);
  if (!read.warning.empty()) {
    fmt::print(stderr, "boba: warning: {}\n", read.warning);
  }
  Packing packing = std::move(read.packing);
  for (Grain& grain : packing.grains) {
    grain.alpha = a.alpha;
  }
  const Topology topology = packing.topology(false);
  SimulationOptions options;
  options.threads = a.threads;
  Simulation simulation(std::move(packing), a.material, options);
  simulation.evaluate();
  const Snapshot found = simulation.snapshot({.velocity = true, .force = true});
  check_forces(topology, found);
  if (!a.output.empty()) {
    LammpsDumpWriter writer(a.output, DumpLayout::forces, a.force ? FileMode::overwrite : FileMode::create);
    writer.write(topology, found);
    writer.close();
  }
  print_pressure(simulation.totals());
  return ExitCode::done;
}

} // namespace

CommandBody add_forces_command(CLI::App& app) {
  auto a = std::make_shared<ForcesArguments>();
  app.add_option("reference", a->reference, "LAMMPS data file of the undeformed grains: bonds and their rest lengths")
      ->required();
  app.add_option("--state", a->state,
                 "LAMMPS dump or data file with cell, positions, velocities (default: the reference)");
  CLI::Option* timestep =
      app.add_option("--timestep", a->timestep, "time step of the dump's frame (default: its last)");
  app.add_option("--frame", a->frame, "number of the dump's frame, from 0, or from the end when negative")
      ->excludes(timestep);
  app.add_option("--alpha", a->alpha, "many-body coefficient, k d")->required();
  app.add_option("--k", a->material.k, "stiffness")->capture_default_str();
  app.add_option("--gamma", a->material.gamma, "damping, sqrt(k m)")->capture_default_str();
  app.add_option("--k3", a->material.k3, "cubic contact repulsion, k/d^2")->capture_default_str();
  app.add_option("--threads", a->threads, "threads")->capture_default_str()->check(CLI::Range(1, 1024));
  app.add_flag("--pressure", a->pressure, "print the pressure tensor only, when no --output is given");
  app.add_option("--output", a->output, "dump to write: id x y z vx vy vz fx fy fz, 17 digits");
  app.add_flag("--force", a->force, "replace an existing output file");
  app.footer("Prints the pressure tensor pxx pyy pzz pxy pxz pyz (k/d, compression positive, kinetic part included).");
  return [a] { return compute(*a); };
}

} // namespace boba

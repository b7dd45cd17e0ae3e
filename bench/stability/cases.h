// SPDX-License-Identifier: GPL-3.0-or-later
// What the stability sweeps are run on, and the one way to call them.
#pragma once

#include "bpm/dynamics/stepper.h"
#include "bpm/io/output_file.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace boba::bench {

/// Many-body coefficients of the published calibration and the ends of the useful range, k d.
inline const std::vector<double> alphas = {-0.95, -0.8, -0.4, 0.0, 2.0, 5.0, 12.0, 20.0};

/// Spherical grain cut from a bulk arrangement, from the template cache.
std::shared_ptr<const GrainTemplate> ball(int n_nodes, std::uint64_t seed = 1);

/// A bulk network in a periodic cube, from the template cache.
std::shared_ptr<const GrainTemplate> periodic_cube(double edge);

/// One grain in an open cell, at rest but for random velocities of this size.
Packing lone_grain(std::shared_ptr<const GrainTemplate> grain, double alpha, double speed);

/// One periodic network in its own cell.
Packing bulk(std::shared_ptr<const GrainTemplate> grain, double alpha);

struct PackingSpec {
  int n_grains = 8;
  int n_nodes = 150;
  double alpha = 2.0;
  double pressure = 0.1;   ///< normalised, P~
  double tolerance = 1e-3; ///< kinetic over elastic energy at rest, and of the pressure
};

/// P = P~ E / (2 - 2 nu^2) with E and nu interpolated between the published pairs (k/d).
/// Source: Clemmer, Hackney & Grest, calibration.
double pressure_of(double normalised, double alpha);

/// Grains inserted at random and compressed until they rest at the pressure.
Packing compressed(const PackingSpec& spec);

/// The snapshot of a stepper as a packing to begin from.
Packing packing_of(const Packing& original, const Snapshot& snapshot);

/// Gives every node a random velocity of this size (uniform in a cube).
void shake(Packing& packing, double speed, std::uint64_t seed = 7);

using Folder = std::filesystem::path;

/// A CSV file with its header, overwritten.
OutputFile csv(const Folder& folder, const std::string& name, const std::string& header);

/// The sweeps; each writes its tables into the folder.
void time_step(const Folder& folder);
void contacts(const Folder& folder);
void spectrum(const Folder& folder);
void energy(const Folder& folder);
void cycles(const Folder& folder);
void conservation(const Folder& folder);
void rounding(const Folder& folder);
void rest(const Folder& folder);
void rest_mixed(const Folder& folder);
void long_shear(const Folder& folder);
void barostat(const Folder& folder);

} // namespace boba::bench

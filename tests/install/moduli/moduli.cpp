// SPDX-License-Identifier: GPL-3.0-or-later
// Uses boba::calibration and boba::continuum as a program outside the tree would: E and nu of a network, and the force
// on a sphere of that material between two plates.
#include <calibration/network/alpha_sweep.h>
#include <calibration/network/petsc_handle.h>
#include <continuum/sphere/hertz.h>
#include <cstdio>

int main() {
  const boba::calibration::PetscSession session;
  boba::calibration::SweepSettings settings;
  settings.box.n_nodes = 1000;
  settings.n_seeds = 1;
  settings.alphas = {0.0, 12.0};
  for (const auto& row : boba::calibration::run_sweep(settings).rows) {
    const double young = row.young().mean, poisson = row.poisson().mean;
    const auto contact = boba::continuum::hertz(10.0, {.young = young, .poisson = poisson}, 0.1);
    std::printf("alpha %g: E %g k/d, nu %g, force %g k d\n", row.alpha, young, poisson, contact.force);
  }
}

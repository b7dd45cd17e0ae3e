// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/network_stiffness.h"
#include "tests/calibration/test_boxes.h"
#include "tests/continuum/verification_row.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

using continuum::testing::verify;

struct Pair {
  double alpha, poisson, young;
};

void expect_pairs(const std::vector<Pair>& pairs, const GrainTemplate& box, double poisson_tolerance,
                  double young_tolerance, const std::string& source) {
  std::vector<double> alphas;
  for (const Pair& pair : pairs) {
    alphas.push_back(pair.alpha);
  }
  const auto solutions = relaxed_stiffness(LinearNetwork(box), alphas);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const ElasticConstants constants = isotropic_part(solutions[p].stiffness);
    verify({fmt::format("periodic network of {} nodes, alpha = {}: nu", box.n_nodes(), pairs[p].alpha),
            constants.poisson(), pairs[p].poisson, poisson_tolerance, source, true});
    verify({fmt::format("the same: E d/k"), constants.young(), pairs[p].young, young_tolerance, source});
  }
}

TEST(PublishedPairs, AreReproducedByThePeriodicNetwork) {
  const std::vector<Pair> pairs = {
      {-0.8, 0.40, 0.58}, {0.0, 0.25, 1.84}, {2.0, -0.01, 4.05}, {5.0, -0.25, 6.04}, {12.0, -0.52, 8.30}};
  expect_pairs(pairs, test_box(2048), 0.01, 0.02, "Clemmer, Hackney & Grest, calibration of the bonds");
}

TEST(PublishedPairs, LammpsOnACubeOfTheSameDensityAgrees) {
  // Periodic cube of 10976 nodes at 1.2264 / d^3, uniaxial strain 5e-4 along each axis and shear in each plane,
  // relaxed.
  const std::vector<Pair> pairs = {{-0.8, 0.4038, 0.5828},
                                   {0.0, 0.2506, 1.8652},
                                   {2.0, -0.0118, 4.0689},
                                   {5.0, -0.2478, 6.0519},
                                   {12.0, -0.5169, 8.3132}};
  expect_pairs(pairs, test_box(2048, 2), 0.002, 0.01, "LAMMPS (the authors' BPM branch), periodic cube of 10976 nodes");
}

} // namespace
} // namespace boba::calibration

// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/network_stiffness.h"
#include "tests/calibration/test_boxes.h"

#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

struct Pair {
  double alpha, poisson, young;
};

void expect_pairs(const std::vector<Pair>& pairs, const GrainTemplate& box, double poisson_tolerance,
                  double young_tolerance) {
  std::vector<double> alphas;
  for (const Pair& pair : pairs) {
    alphas.push_back(pair.alpha);
  }
  const auto solutions = relaxed_stiffness(LinearNetwork(box), alphas);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const ElasticConstants constants = isotropic_part(solutions[p].stiffness);
    EXPECT_NEAR(constants.poisson(), pairs[p].poisson, poisson_tolerance) << "alpha = " << pairs[p].alpha;
    EXPECT_NEAR(constants.young() / pairs[p].young, 1.0, young_tolerance) << "alpha = " << pairs[p].alpha;
  }
}

TEST(PublishedPairs, AreReproducedByThePeriodicNetwork) {
  // Clemmer, Hackney & Grest: alpha -> (nu, E d/k).
  const std::vector<Pair> pairs = {
      {-0.8, 0.40, 0.58}, {0.0, 0.25, 1.84}, {2.0, -0.01, 4.05}, {5.0, -0.25, 6.04}, {12.0, -0.52, 8.30}};
  expect_pairs(pairs, test_box(2048), 0.01, 0.02);
}

TEST(PublishedPairs, LammpsOnACubeOfTheSameDensityAgrees) {
  // LAMMPS (the authors' BPM branch): periodic cube of 10976 nodes at 1.2264 / d^3, uniaxial strain 5e-4 and shear,
  // relaxed.
  const std::vector<Pair> pairs = {{-0.8, 0.4038, 0.5828},
                                   {0.0, 0.2506, 1.8652},
                                   {2.0, -0.0118, 4.0689},
                                   {5.0, -0.2478, 6.0519},
                                   {12.0, -0.5169, 8.3132}};
  expect_pairs(pairs, test_box(2048, 2), 0.002, 0.01);
}

} // namespace
} // namespace boba::calibration

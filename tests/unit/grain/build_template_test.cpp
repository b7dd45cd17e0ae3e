// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/bond_network.h"
#include "bpm/grain/build_template.h"
#include "bpm/grain/near_pairs.h"
#include "bpm/grain/outline.h"
#include "bpm/measure/convex_hull.h"
#include "bpm/measure/hull_facets.h"

#include <cmath>
#include <complex>
#include <gtest/gtest.h>

namespace boba {
namespace {

using Eigen::Vector3d;
using Shape = TemplateSpec::Shape;
using Surface = TemplateSpec::Surface;

/// Largest net force of the undeformed grain by the published bond and contact laws, every pair visited.
double largest_force_at_rest(const GrainTemplate& grain, double alpha) {
  const int n = grain.n_nodes();
  std::vector<std::vector<char>> bonded(n, std::vector<char>(n, 0));
  std::vector<double> volume(n, 0.0), volume0(n, 0.0);
  const auto length = [&](const Bond& b) { return (grain.position[b.i] - grain.position[b.j]).norm(); };
  for (const Bond& b : grain.bonds) {
    bonded[b.i][b.j] = 1;
    for (const int node : {b.i, b.j}) {
      volume[node] += std::pow(length(b), 3);
      volume0[node] += std::pow(b.r0, 3);
    }
  }
  std::vector<Vector3d> force(n, Vector3d::Zero());
  const auto push = [&](int i, int j, double f) {
    const Vector3d e = (grain.position[i] - grain.position[j]).normalized();
    force[i] += f * e;
    force[j] -= f * e;
  };
  for (const Bond& b : grain.bonds) {
    const double r = length(b);
    const double swelling = std::cbrt((volume[b.i] + volume[b.j]) / (volume0[b.i] + volume0[b.j]));
    push(b.i, b.j, b.r0 - r + alpha * (swelling - r / b.r0));
  }
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      const double r = (grain.position[i] - grain.position[j]).norm();
      if (!bonded[i][j] && r < 1.0) {
        push(i, j, 1.0 - r);
      }
    }
  }
  double largest = 0.0;
  for (const Vector3d& f : force) {
    largest = std::max(largest, f.norm());
  }
  return largest;
}

double largest_radius(const GrainTemplate& grain) {
  double largest = 0.0;
  for (const Vector3d& x : grain.position) {
    largest = std::max(largest, x.norm());
  }
  return largest;
}

TEST(BuildTemplate, SphereOfRadiusTenHasThePublishedCount) {
  const GrainTemplate grain = build_template({.radius = 10.0});
  EXPECT_NEAR(grain.n_nodes(), 5137, 51);
  EXPECT_NEAR(grain.reference_volume, 4.0 / 3.0 * M_PI * 1000.0, 0.01 * 4189.0);
  int core = 0;
  for (const Vector3d& x : grain.position) {
    core += x.norm() < 8.0;
  }
  EXPECT_NEAR(core / (4.0 / 3.0 * M_PI * 512.0), 1.226, 0.02);
  EXPECT_NEAR(static_cast<double>(grain.bonds.size()) / grain.n_nodes(), 7.0, 0.3);
  EXPECT_LT(largest_radius(grain), 10.2); // centred on the mean of its nodes, not on the point of the cut
  // By the literal published rule a cut grain has several tens of facets before anything deforms it.
  const measure::ConvexHull hull = measure::convex_hull(grain.position);
  const measure::Facets facets = measure::transitive_facets(hull);
  EXPECT_GE(facets.n_facets(), 50);
  EXPECT_LE(facets.n_facets(), 90);
  RecordProperty("transitive_facets", facets.n_facets());
  RecordProperty("robust_facets", measure::grown_facets(hull).n_facets());
}

TEST(BuildTemplate, WalledSphereOfRadiusTenIsOneSingleFacetByThePublishedRule) {
  const GrainTemplate grain = build_template({.surface = Surface::wall, .radius = 10.0});
  EXPECT_NEAR(grain.n_nodes(), 5140, 51);
  EXPECT_NEAR(largest_radius(grain), 9.57, 0.05);
  const measure::ConvexHull hull = measure::convex_hull(grain.position);
  const measure::Facets facets = measure::transitive_facets(hull);
  EXPECT_EQ(facets.n_facets(), 1);
  EXPECT_GT(facets.faceted_share(), 0.999);
  EXPECT_EQ(measure::grown_facets(hull).n_facets(), 0); // the robust rule sees the ball
}

TEST(BuildTemplate, SmallCutSphereIsBondedAndForceFree) {
  const GrainTemplate grain = build_template({.n_nodes = 300});
  ASSERT_EQ(grain.n_nodes(), 300);
  EXPECT_EQ(grain.bonds.size(), near_pairs(grain.position, 1.5, std::nullopt).size());
  EXPECT_LT(largest_force_at_rest(grain, 12.0), 1e-13);
  EXPECT_FALSE(floating_part(grain));
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& x : grain.position) {
    mean += x / 300.0;
  }
  EXPECT_LT(mean.norm(), 1e-13);
}

TEST(BuildTemplate, WalledSphereIsLikeThePublishedGrainOf303Nodes) {
  const GrainTemplate grain = build_template({.surface = Surface::wall, .n_nodes = 303});
  // A grain of the authors' published example: 303 nodes, 1651 bonds, largest radius 3.714.
  EXPECT_NEAR(grain.bonds.size(), 1651.0, 0.03 * 1651.0);
  EXPECT_NEAR(largest_radius(grain), 3.714, 0.02 * 3.714);
  EXPECT_LT(largest_force_at_rest(grain, 12.0), 1e-13);
  int outer_layer = 0;
  for (const Vector3d& x : grain.position) {
    outer_layer += x.norm() > 3.5;
  }
  EXPECT_GT(outer_layer, 303 / 3) << "no layer of nodes at the wall";
}

TEST(BuildTemplate, EveryShapeHoldsExactlyTheNumberAskedFor) {
  for (const Surface surface : {Surface::cut, Surface::wall}) {
    for (const Shape shape : {Shape::sphere, Shape::cylinder, Shape::box}) {
      TemplateSpec spec{
          .shape = shape, .surface = surface, .radius = 1.0, .height = 3.0, .size = {1, 1.5, 2}, .n_nodes = 217};
      const GrainTemplate grain = build_template(spec);
      EXPECT_EQ(grain.n_nodes(), 217) << canonical_text(spec);
      EXPECT_FALSE(grain.period);
      const Outline outline = Outline::with_volume(spec, 217 / 1.226);
      for (const Vector3d& x : grain.position) {
        EXPECT_LT(outline.reach(x), 1.2) << canonical_text(spec);
      }
    }
  }
}

TEST(BuildTemplate, CylinderAndBoxBySizeFillTheirVolume) {
  const GrainTemplate cylinder = build_template({.shape = Shape::cylinder, .radius = 4.0, .height = 9.0});
  EXPECT_NEAR(cylinder.n_nodes(), 1.226 * M_PI * 16.0 * 9.0, 0.04 * 555.0);
  const GrainTemplate box = build_template({.shape = Shape::box, .size = {6, 8, 10}});
  EXPECT_NEAR(box.n_nodes(), 1.226 * 480.0, 0.04 * 588.0);
}

TEST(BuildTemplate, SameSeedSameGrainOtherSeedOther) {
  const TemplateSpec spec{.surface = Surface::wall, .n_nodes = 100, .seed = 5};
  const GrainTemplate one = build_template(spec), again = build_template(spec);
  EXPECT_EQ(one.position, again.position);
  TemplateSpec other = spec;
  other.seed = 6;
  EXPECT_NE(build_template(other).position, one.position);
}

/// |sum exp(i q.x)|^2 / N averaged over the shortest reciprocal vectors of an fcc lattice with m cells a side.
double fcc_peak(const std::vector<Vector3d>& x, const Vector3d& period, int m) {
  double sum = 0.0;
  int count = 0;
  for (int h = -2; h <= 2; ++h) {
    for (int k = -2; k <= 2; ++k) {
      for (int l = -2; l <= 2; ++l) {
        const int square = h * h + k * k + l * l;
        const bool all_odd = h % 2 && k % 2 && l % 2, all_even = !(h % 2) && !(k % 2) && !(l % 2);
        if ((all_odd && square == 3) || (all_even && (square == 4 || square == 8))) {
          const Vector3d q = 2.0 * M_PI * m * Vector3d(h, k, l).cwiseQuotient(period);
          std::complex<double> amplitude = 0.0;
          for (const Vector3d& position : x) {
            amplitude += std::polar(1.0, q.dot(position));
          }
          sum += std::norm(amplitude) / static_cast<double>(x.size());
          ++count;
        }
      }
    }
  }
  return sum / count;
}

/// Share of pairs within 5 % of the second fcc distance, sqrt(2) times the nearest one, relative to a uniform fluid.
double pairs_at_second_fcc_distance(const std::vector<Vector3d>& x, const Vector3d& period) {
  const double a = std::cbrt(4.0 * period.prod() / x.size()), low = 0.97 * a, high = 1.03 * a;
  const auto pairs = near_pairs(x, high, period).size() - near_pairs(x, low, period).size();
  const double shell = 4.0 / 3.0 * M_PI * (std::pow(high, 3) - std::pow(low, 3));
  return pairs / (0.5 * x.size() * x.size() / period.prod() * shell);
}

TEST(BuildTemplate, PeriodicBulkIsDisordered) {
  constexpr int m = 7;
  const GrainTemplate box = build_template({.shape = Shape::periodic_box, .size = {1, 1, 1}, .n_nodes = 4 * m * m * m});
  ASSERT_TRUE(box.period);
  EXPECT_NEAR(box.n_nodes() / box.period->prod(), 1.226, 1e-12);
  EXPECT_NEAR(box.bonds.size() / (4.0 * m * m * m), 7.45, 0.1); // no surface: more than the grain's 7

  std::vector<Vector3d> crystal; // the same box as a real fcc lattice
  for (int ix = 0; ix < 2 * m; ++ix) {
    for (int iy = 0; iy < 2 * m; ++iy) {
      for (int iz = 0; iz < 2 * m; ++iz) {
        if ((ix + iy + iz) % 2 == 0) {
          crystal.push_back(wrapped(box.period->cwiseProduct(Vector3d(ix, iy, iz)) / (2.0 * m), *box.period));
        }
      }
    }
  }
  ASSERT_EQ(crystal.size(), box.position.size());
  EXPECT_NEAR(fcc_peak(crystal, *box.period, m), crystal.size(), 1e-6); // the measure sees a crystal
  EXPECT_LT(fcc_peak(box.position, *box.period, m), 5.0);               // a liquid's S(q) there, out of 1372
  // Six neighbours in a shell that holds 1.226 * 4 pi / 3 * a^3 (1.03^3 - 0.97^3) = 3.02 on average.
  EXPECT_NEAR(pairs_at_second_fcc_distance(crystal, *box.period), 6.0 / 3.02, 0.02);
  EXPECT_LT(pairs_at_second_fcc_distance(box.position, *box.period), 0.8);
}

TEST(BuildTemplate, OneNodeIsASphereOfDiameterD) {
  const GrainTemplate grain = build_template({.n_nodes = 1});
  ASSERT_EQ(grain.n_nodes(), 1);
  EXPECT_EQ(grain.position[0], Vector3d::Zero());
  EXPECT_TRUE(grain.bonds.empty());
  EXPECT_NEAR(grain.reference_volume, 4.0 / 3.0 * std::acos(-1.0) * 0.125, 1e-15);
  EXPECT_THROW(build_template({.shape = Shape::box, .n_nodes = 1}), std::invalid_argument);
}

} // namespace
} // namespace boba

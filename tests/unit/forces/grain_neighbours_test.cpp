// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbouring grains against a loop over all grains and a fixed block of images; the gap between two grains against
// the distances of all their places.
#include "bpm/forces/contact_search.h"
#include "bpm/forces/grain_neighbours.h"

#include <gtest/gtest.h>
#include <random>

namespace boba::test {
namespace {

std::vector<Bounds> random_bounds(const Box& box, int n, double largest, std::mt19937& random) {
  std::uniform_real_distribution<double> anywhere(-0.5, 1.5), edge(0.2, 1.0);
  std::vector<Bounds> bounds;
  for (int g = 0; g < n; ++g) {
    const Vector3 centre = box.to_position({anywhere(random), anywhere(random), anywhere(random)});
    const Vector3 half = 0.5 * largest * Vector3(edge(random), edge(random), edge(random));
    bounds.push_back({centre - half, centre + half});
  }
  return bounds;
}

bool within(const Bounds& a, const Bounds& b, double reach) {
  return (b.low - a.high).cwiseMax(a.low - b.high).cwiseMax(Vector3::Zero()).norm() <= reach;
}

void expect_all_found(const Box& box, int n, double largest, double reach) {
  std::mt19937 random(7);
  const std::vector<Bounds> bounds = random_bounds(box, n, largest, random);
  const GrainNeighbours neighbours(bounds, box, reach);
  constexpr int most = 7; // images: centres are up to two cells apart, and the grains reach beyond
  std::size_t n_found = 0;
  for (int g = 0; g < n; ++g) {
    std::vector<std::tuple<int, ImageVector>> expected, found;
    for (int other = 0; other < n; ++other) {
      for (int a = -most; a <= most; ++a) {
        for (int b = -most; b <= most; ++b) {
          for (int c = -most; c <= most; ++c) {
            const bool allowed = (a == 0 || box.periodic()[0]) && (b == 0 || box.periodic()[1]) &&
                                 (c == 0 || box.periodic()[2]) && (other != g || a != 0 || b != 0 || c != 0);
            const Vector3 shift = box.h() * Vector3(a, b, c);
            if (allowed && within(bounds[g], {bounds[other].low + shift, bounds[other].high + shift}, reach)) {
              expected.emplace_back(other, ImageVector{a, b, c});
            }
          }
        }
      }
    }
    for (const NeighbourGrain& neighbour : neighbours.of(g)) {
      found.emplace_back(neighbour.other, neighbour.image);
    }
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected) << "grain " << g;
    n_found += found.size();
  }
  EXPECT_GT(n_found, 0u);
}

TEST(GrainNeighbours, AreThoseOfAllGrainsAndImages) {
  const Vector3 origin(0.3, -1.0, 2.0), lengths(40.0, 44.0, 37.0), tilts(18.0, -17.0, 20.0);
  expect_all_found(Box(origin, lengths), 60, 6.0, 1.5);
  expect_all_found(Box(origin, lengths, tilts), 60, 6.0, 1.5);
  expect_all_found(Box(origin, lengths, tilts, {true, false, true}), 60, 6.0, 1.5);
  expect_all_found(Box(origin, lengths, tilts, {false, false, false}), 60, 8.0, 4.0);
}

TEST(GrainNeighbours, AreFoundInCellsSmallerThanAGrain) {
  expect_all_found(Box({0.3, -1.0, 2.0}, {9.0, 11.0, 30.0}, {4.0, -4.0, 5.0}), 12, 12.0, 1.5);
}

TEST(Gap, IsKeptByAllPlacesInsertedOnesIncluded) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-4.0, 4.0), small(-0.1, 0.1);
  const auto grain = [&] {
    std::vector<Vector3> places;
    Bounds bounds;
    while (places.size() < 200) {
      if (const Vector3 x(anywhere(random), anywhere(random), anywhere(random)); x.norm() < 4.0) {
        places.push_back(x);
        bounds.include(x);
      }
    }
    return std::pair(GrainGrid(places, bounds, 1.5), places);
  };
  int n_apart = 0, n_overlapping = 0;
  for (int k = 0; k < 200; ++k) {
    auto [a, places_a] = grain();
    auto [b, places_b] = grain();
    places_a.push_back({4.3, 0.0, 0.0});
    a.insert(0, places_a.back());
    const auto frame = [&](const Vector3& centre) {
      return GrainFrame{Matrix3::Identity() + Matrix3::NullaryExpr([&] { return small(random); }), centre};
    };
    const GrainFrame frame_a = frame(Vector3::Zero());
    const GrainFrame frame_b = frame({2.0 * anywhere(random), 2.0 * anywhere(random), 7.0 + 0.5 * anywhere(random)});
    const Gap gap = gap_between(a, frame_a, b, frame_b);
    double closest = 1e300, last = -1e300, first = 1e300;
    for (const Vector3& x : places_a) {
      last = std::max(last, gap.normal.dot(frame_a(x)));
      for (const Vector3& y : places_b) {
        closest = std::min(closest, (frame_a(x) - frame_b(y)).norm());
      }
    }
    for (const Vector3& y : places_b) {
      first = std::min(first, gap.normal.dot(frame_b(y)));
    }
    // Both planes touch their grain, within single precision.
    EXPECT_GE(gap.last_of_a, last);
    EXPECT_LE(gap.first_of_b, first);
    EXPECT_NEAR(gap.last_of_a, last, 3e-4);
    EXPECT_NEAR(gap.first_of_b, first, 3e-4);
    EXPECT_LE(gap.width(), closest);
    ++(gap.width() > 0.0 ? n_apart : n_overlapping);
  }
  EXPECT_GT(n_apart, 20);
  EXPECT_GT(n_overlapping, 20);
  const auto [a, places] = grain();
  EXPECT_LE(gap_between(a, {}, a, {}).width(), 0.0); // the same centre: no line to look along
}

} // namespace
} // namespace boba::test

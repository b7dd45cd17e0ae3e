// SPDX-License-Identifier: GPL-3.0-or-later
// Contact lists in whole runs: those that are kept as long as they hold find what lists made again at every step find.
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "tests/physics/dynamics/nine_grains.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace boba::test {
namespace {

// A list that lives for many steps and one that is made again at every step find the same contacts: the same bits come
// out, while grains are sheared, squeezed and turned, the cell flips and single nodes are shot through the packing.
TEST(ContactLists, ThatLiveLongMissNothing) {
  const std::pair<Remap, Material> cases[] = {
      {Remap::positions, {}}, {Remap::positions, {.contact_diameter = 1.3}}, {Remap::velocities, {}}};
  for (const auto& [remap, material] : cases) {
    const Precision precision = remap == Remap::positions ? Precision::full : Precision::mixed;
    Stepper lasting(nine_grains(), material, {.precision = precision});
    Stepper fresh(nine_grains(), material, {.precision = precision});
    Snapshot end[2];
    for (Stepper* stepper : {&lasting, &fresh}) {
      stepper->start();
      for (int step = 0; step < 600; ++step) {
        if (stepper == &fresh) {
          stepper->forces().forget_contacts();
        }
        stepper->advance(step + 1 < 600 ? Virial::trace : Virial::full);
        stepper->move_cell({.shear = 0.02, .remap = remap, .dilation = 0.05 * (stepper->pressure() - 0.2)});
      }
      end[stepper == &fresh] = take_snapshot(stepper->moving(), all_parts);
    }
    EXPECT_GT(lasting.forces().contact_totals().n_touching, 100);
    EXPECT_LT(lasting.forces().contact_list().counts().grains, 300 * 9);
    expect_same_bits(end[0], end[1]);
  }
}

// A node that leaves its grain, which stays where it is, meets a grain that was nobody's neighbour.
TEST(ContactLists, KnowANodeFarFromItsGrain) {
  Packing packing = small_packing({.box = Box({0, 0, 0}, {60, 60, 60}),
                                   .n_grains = 2,
                                   .radius = 5.0,
                                   .alpha = 0.0,
                                   .jitter = 0.0,
                                   .speed = 0.0,
                                   .least_distance = 12.0});
  const std::vector<std::int64_t> first_node = packing.first_nodes();
  for (int g = 0; g < 2; ++g) {
    const auto first = packing.position.begin() + first_node[g];
    const auto last = packing.position.begin() + first_node[g + 1];
    const Vector3 mean = std::accumulate(first, last, Vector3(0, 0, 0)) / static_cast<double>(last - first);
    std::for_each(first, last, [&](Vector3& x) { x += Vector3(20.0 + 17.0 * g, 30.0, 30.0) - mean; });
  }
  const auto end = packing.position.begin() + first_node[1];
  const auto shot =
      std::max_element(packing.position.begin(), end, [](const Vector3& x, const Vector3& y) { return x[0] < y[0]; });
  packing.velocity[shot - packing.position.begin()] = {1.5, 0.0, 0.0};
  const Material weak = {.k = 1e-3, .gamma = 0.0, .k3 = 0.0}; // of bonds that let it go
  Stepper lasting(packing, weak, {}), fresh(packing, weak, {});
  lasting.start();
  fresh.start();
  std::int64_t most = 0;
  for (int step = 0; step < 400; ++step) {
    fresh.forces().forget_contacts();
    lasting.advance(Virial::trace);
    fresh.advance(Virial::trace);
    ASSERT_EQ(lasting.forces().contact_totals().n_touching, fresh.forces().contact_totals().n_touching) << step;
    most = std::max(most, fresh.forces().contact_totals().n_touching);
  }
  EXPECT_GT(most, 0);
  EXPECT_LT(lasting.forces().contact_list().counts().grains, 100);
}

} // namespace
} // namespace boba::test

// SPDX-License-Identifier: GPL-3.0-or-later
// What the search for contacts need not do: lists that outlive motion, grains and nodes that cannot touch.
#include "bench/engine/count_node_steps.h"
#include "bench/engine/dense_packing.h"
#include "bench/engine/skips.h"
#include "bpm/dynamics/take_snapshot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boba::bench {
namespace {

constexpr int never = std::numeric_limits<int>::max();

/// Steps in which the fastest node moves half the skin: how long a list lasts by the usual rule.
int steps_of_a_common_list(const Packing& packing, const SimulationOptions& options) {
  double speed2 = 0.0;
  for (const Vector3& v : packing.velocity) {
    speed2 = std::max(speed2, v.squaredNorm());
  }
  return std::max(1, static_cast<int>(0.5 * options.skin / (options.dt * std::sqrt(speed2))));
}

struct Steps {
  CellRates cell;
  bool common_lists = false; ///< all is searched again by the usual rule
  double gamma = Material{}.gamma;
};

void step(benchmark::State& state, const Packing& packing, const Steps& steps) {
  const SimulationOptions options;
  const int interval = steps.common_lists ? steps_of_a_common_list(packing, options) : never;
  Material material;
  material.gamma = steps.gamma;
  Stepper stepper(packing, material, options);
  stepper.start();
  for (auto _ : state) {
    if ((stepper.step() + 1) % interval == 0) {
      stepper.forces().forget_contacts();
    }
    stepper.advance(Virial::trace);
    stepper.move_cell(steps.cell);
  }
  count_node_steps(state, stepper);
  const ContactList& list = stepper.forces().contact_list();
  const auto pairs = static_cast<double>(list.pairs().size());
  state.counters["pairs"] = pairs;
  state.counters["candidates"] = static_cast<double>(list.n_candidates());
  state.counters["searches/step"] = static_cast<double>(list.counts().pairs) / static_cast<double>(stepper.step());
}

const Steps undamped{.gamma = 0.0};

void add(const char* name, const Lattice& lattice, const Steps& steps = undamped) {
  register_skip(name, 300, [=](benchmark::State& state) { step(state, swinging_grains(lattice), steps); });
}

void add_dense(const char* name, const Steps& steps) {
  register_skip(name, 200, [steps](benchmark::State& state) { step(state, dense_packing(16, 5137, 2.0), steps); });
}

/// Which nodes and which candidates an evaluation of the contacts goes through.
enum class Looked { near, listed, all };

kernels::ContactNode contact_node(const Vector3& x, const Vector3& v) {
  return {{x[0], x[1], x[2]}, {v[0], v[1], v[2]}, {}};
}

/// The copies of the nodes and the contact pass of a dense packing, outside the engine: of the nodes and candidates
/// that may touch before the list's next update, of all that are listed, or of all nodes.
void contacts(benchmark::State& state, Looked looked) {
  Stepper stepper(dense_packing(16, 5137, 2.0), Material{}, SimulationOptions{});
  stepper.start();
  const Snapshot now = take_snapshot(stepper.moving(), {.velocity = true});
  const std::vector<std::int64_t> first = stepper.packing().first_nodes();
  const ContactList& list = stepper.forces().contact_list();
  const kernels::KernelTable& table = stepper.forces().kernel_table();
  const ContactLaw law;
  std::vector<kernels::ContactNode> node(now.position.size());
  std::vector<kernels::Touch> touches;
  std::vector<kernels::ContactNode> rows;
  double looked_at = 0.0, touching = 0.0;
  const auto copy = [&](std::int64_t i) { node[i] = contact_node(now.position[i], now.velocity[i]); };
  for (auto _ : state) {
    looked_at = touching = 0.0;
    if (looked == Looked::all) {
      for (std::size_t i = 0; i < node.size(); ++i) {
        copy(static_cast<std::int64_t>(i));
      }
    } else {
      for (int g = 0; g < stepper.layout().n_grains(); ++g) {
        for (const std::int32_t i : looked == Looked::near ? list.near(g) : list.listed(g)) {
          copy(first[g] + i);
        }
      }
    }
    for (const ContactPair& pair : list.pairs()) {
      const std::vector<kernels::NodePair>& candidates = looked == Looked::near ? pair.near : pair.candidates;
      const auto n = static_cast<std::int64_t>(candidates.size());
      const auto capacity = static_cast<std::size_t>(kernels::touch_capacity(n));
      touches.resize(std::max(touches.size(), capacity));
      rows.resize(touches.size());
      const Vector3 shift = now.box.h() * Vector3(pair.image.a, pair.image.b, pair.image.c);
      kernels::ContactSums sums = no_contacts;
      touching += static_cast<double>(table.contacts(
          {candidates.data(), n, &node[first[pair.a]], &node[first[pair.b]], {shift[0], shift[1], shift[2]}, {}}, law,
          rows.data(), touches.data(), sums));
      looked_at += static_cast<double>(n);
    }
    benchmark::DoNotOptimize(touches.data());
  }
  state.counters["candidates"] = looked_at;
  state.counters["touching"] = touching;
}

void add_contacts(const char* name, Looked looked) {
  register_skip(name, 300, [looked](benchmark::State& state) { contacts(state, looked); });
}

/// Between the boxes of grains that are looked at together though none of their nodes come near, d.
constexpr double close_gap = 2.5, wide_gap = 12.0;

const bool added = [] {
  const Steps sheared{.cell = dense_shear_rates(0.0)};
  Steps common = sheared;
  common.common_lists = true;
  add_dense("list_by_absolute_motion/with", common);
  add_dense("list_by_absolute_motion/without", sheared);
  common = undamped;
  common.common_lists = true;
  add("search_inside_grains/with", {.alone = true, .gap = wide_gap}, common);
  add("search_inside_grains/without", {.alone = true, .gap = wide_gap});
  add("images_of_a_lone_grain/with", {.alone = true, .gap = close_gap});
  add("images_of_a_lone_grain/without", {.alone = true, .gap = wide_gap});
  add("pairs_whose_boxes_do_not_touch/with", {.gap = close_gap});
  add("pairs_whose_boxes_do_not_touch/without", {.gap = wide_gap});
  add("images_in_a_free_cell/with", {.gap = wide_gap});
  add("images_in_a_free_cell/without", {.gap = wide_gap, .periodic = false});
  add_contacts("nodes_that_cannot_touch/all", Looked::all);
  add_contacts("nodes_that_cannot_touch/listed", Looked::listed);
  add_contacts("nodes_that_cannot_touch/without", Looked::near);
  return true;
}();

} // namespace
} // namespace boba::bench

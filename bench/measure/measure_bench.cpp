// SPDX-License-Identifier: GPL-3.0-or-later
// What a frame costs to measure. Grains: a deformed grain of 5141 nodes (tests/data/measure), turned at random and put
// on a cubic lattice so close that neighbours touch.
#include "bpm/measure/bond_order.h"
#include "bpm/measure/contact_network.h"
#include "bpm/measure/convex_hull.h"
#include "bpm/measure/hull_facets.h"
#include "bpm/measure/hull_shape.h"
#include "bpm/measure/packing_fraction.h"
#include "bpm/measure/parallel_loop.h"
#include "bpm/measure/philox.h"
#include "bpm/measure/scattering.h"
#include "tests/unit/measure/grain_file.h"

#include <Eigen/Geometry>
#include <benchmark/benchmark.h>
#include <cmath>

namespace {

using namespace boba;
using namespace boba::measure;

/// n1 n2 n3 grains of 5141 or 303 nodes with their hulls.
struct LatticePacking {
  Box box;
  std::vector<Vector3> nodes;
  std::vector<std::int64_t> first_node{0};
  std::vector<ConvexHull> hulls;

  LatticePacking(int n1, int n2, int n3, int n_nodes) {
    const auto source = test_data::read_grains(n_nodes > 303 ? "deformed_grain_5141.csv" : "deformed_grains_303.csv");
    const auto grain = source.nodes_of(0);
    const Vector3 centre = mean_position(grain);
    const double spacing = n_nodes > 303 ? 18.5 : 7.0;
    box = Box(Vector3::Zero(), spacing * Vector3(n1, n2, n3), {0.3 * spacing * n1, 0.0, 0.0});
    for (int g = 0; g < n1 * n2 * n3; ++g) {
      const auto u = random_point(1, g);
      const Eigen::Quaterniond turn = Eigen::Quaterniond(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5, 0.3).normalized();
      const Vector3 at =
          box.to_position((Eigen::Vector3i(g % n1, g / n1 % n2, g / (n1 * n2)).cast<double>() + Vector3::Constant(0.5))
                              .cwiseQuotient(Vector3(n1, n2, n3)));
      for (const Vector3& x : grain) {
        nodes.push_back(at + turn * (x - centre));
      }
      first_node.push_back(static_cast<std::int64_t>(nodes.size()));
    }
    hulls.resize(n1 * n2 * n3);
    parallel_loop(n1 * n2 * n3,
                  [&](std::int64_t g) { hulls[g] = convex_hull(grains().nodes_of(static_cast<int>(g))); });
  }
  GrainNodes grains() const { return {nodes, first_node}; }
};

const LatticePacking& large() {
  static const LatticePacking packing(8, 8, 16, 5141);
  return packing;
}

const LatticePacking& small() {
  static const LatticePacking packing(4, 4, 4, 303);
  return packing;
}

/// Hull, shape and facets by both rules of each of 1024 grains.
void hulls_of_a_frame(benchmark::State& state) {
  const LatticePacking& packing = large();
  for (auto _ : state) {
    std::vector<double> kept(packing.grains().n_grains());
    parallel_loop(packing.grains().n_grains(), [&](std::int64_t g) {
      const ConvexHull hull = convex_hull(packing.grains().nodes_of(static_cast<int>(g)));
      kept[g] = hull_shape(hull).volume + transitive_facets(hull).n_facets() + grown_facets(hull).n_facets();
    });
    benchmark::DoNotOptimize(kept.data());
  }
}
BENCHMARK(hulls_of_a_frame)->Unit(benchmark::kSecond)->Iterations(1)->MeasureProcessCPUTime()->UseRealTime();

/// The parts of one grain's share of it.
void one_hull(benchmark::State& state) {
  const auto nodes = large().grains().nodes_of(0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(convex_hull(nodes).n_triangles());
  }
  state.counters["candidates"] = static_cast<double>(hull_candidates(nodes).size());
}
BENCHMARK(one_hull)->Unit(benchmark::kMillisecond);

/// Nodes of a disordered crystal at the bulk's density within 10 d of a point: a grain with a cut surface has far fewer
/// hull vertices than the smooth ones of the file.
std::vector<Vector3> cut_grain() {
  constexpr double edge = 1.4833; // of the fcc cube at 1.226 / d^3
  std::vector<Vector3> nodes;
  for (int i = 0; i < 24 * 24 * 24 * 4; ++i) {
    const int site = i % 4, cell = i / 4;
    const Vector3 basis(site == 1 || site == 2 ? 0.5 : 0.0, site == 1 || site == 3 ? 0.5 : 0.0, site >= 2 ? 0.5 : 0.0);
    const auto u = random_point(2, i);
    const Vector3 x = edge * (Eigen::Vector3i(cell % 24, cell / 24 % 24, cell / 576).cast<double>() -
                              Vector3(12.1, 12.2, 12.3) + basis) +
                      0.4 * Vector3(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5);
    if (x.norm() < 10.0) {
      nodes.push_back(x);
    }
  }
  return nodes;
}

void one_cut_grain_hull_shape_and_facets(benchmark::State& state) {
  const std::vector<Vector3> nodes = cut_grain();
  int vertices = 0;
  for (auto _ : state) {
    const ConvexHull hull = convex_hull(nodes);
    vertices = static_cast<int>(hull.vertex.size());
    benchmark::DoNotOptimize(hull_shape(hull).volume + transitive_facets(hull).n_facets() +
                             grown_facets(hull).n_facets());
  }
  state.counters["nodes"] = static_cast<double>(nodes.size());
  state.counters["hull_vertices"] = vertices;
}
BENCHMARK(one_cut_grain_hull_shape_and_facets)->Unit(benchmark::kMillisecond);

void one_hull_without_skipping_nodes(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(convex_hull_of_all(large().grains().nodes_of(0)).n_triangles());
  }
}
BENCHMARK(one_hull_without_skipping_nodes)->Unit(benchmark::kMillisecond);

void facets_of_one_hull(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(grown_facets(large().hulls[0]).n_facets());
    benchmark::DoNotOptimize(transitive_facets(large().hulls[0]).n_facets());
  }
}
BENCHMARK(facets_of_one_hull)->Unit(benchmark::kMillisecond);

/// phi of 5.3 million nodes to 1e-3, the hulls given.
void packing_fraction_to_a_thousandth(benchmark::State& state) {
  PackingFraction phi;
  for (auto _ : state) {
    phi = packing_fraction(large().box, large().grains(), large().hulls, {.target_error = 1e-3});
  }
  state.counters["phi"] = phi.both.value;
  state.counters["error"] = phi.both.standard_error;
  state.counters["points"] = static_cast<double>(phi.n_points);
}
BENCHMARK(packing_fraction_to_a_thousandth)
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// S(q) of 64 grains of 303 nodes up to q = 3 / d.
void scattering_of_64_small_grains(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(scattering(small().box, small().grains(), {.q_max = 3.0}).size());
  }
  const double work =
      static_cast<double>(small().nodes.size()) * static_cast<double>(ReciprocalLattice(small().box, 3.0).n_vectors());
  state.counters["node_vectors_per_s"] = benchmark::Counter(work, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(scattering_of_64_small_grains)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime();

/// S(q) of 5.3 million nodes: the cost is nodes x wave vectors, and those grow as q_max^3; argument: q_max in 0.01 / d.
void scattering_of_1024_grains(benchmark::State& state) {
  const double q_max = 0.01 * static_cast<double>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(scattering(large().box, large().grains(), {.q_max = q_max}).size());
  }
  const double vectors = static_cast<double>(ReciprocalLattice(large().box, q_max).n_vectors());
  const double work = static_cast<double>(large().nodes.size()) * vectors;
  state.counters["vectors"] = vectors;
  state.counters["node_vectors_per_s"] = benchmark::Counter(work, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(scattering_of_1024_grains)
    ->Arg(20)
    ->Arg(40)
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// Both ways to the same amplitudes, by size: range(0) 0: 64 grains of 303 nodes, 1: 64 of 5141, 2: 1024 of 5141;
/// range(1): q_max in 0.01 / d. Counters: the other way's largest difference, relative to the root mean square.
void scattering_both_ways(benchmark::State& state, bool transform) {
  static const LatticePacking medium(4, 4, 4, 5141);
  const LatticePacking& packing = state.range(0) == 0 ? small() : state.range(0) == 1 ? medium : large();
  const ReciprocalLattice lattice(packing.box, 0.01 * static_cast<double>(state.range(1)));
  ScatteringAmplitudes found;
  for (auto _ : state) {
    found = transform ? transformed_amplitudes(packing.box, packing.grains(), lattice)
                      : summed_amplitudes(packing.box, packing.grains(), lattice);
  }
  state.counters["vectors"] = static_cast<double>(lattice.n_vectors());
  if (transform && static_cast<double>(packing.nodes.size()) * static_cast<double>(lattice.n_vectors()) < 2e10) {
    const ScatteringAmplitudes exact = summed_amplitudes(packing.box, packing.grains(), lattice);
    double difference = 0.0, size = 0.0;
    for (std::size_t v = 0; v < exact.intensity.size(); ++v) {
      difference = std::max(difference, std::abs(std::sqrt(found.intensity[v]) - std::sqrt(exact.intensity[v])));
      size += exact.intensity[v] / static_cast<double>(exact.intensity.size());
    }
    state.counters["error"] = difference / std::sqrt(size);
  }
}
void scattering_by_transform(benchmark::State& state) {
  scattering_both_ways(state, true);
}
void scattering_by_sums(benchmark::State& state) {
  scattering_both_ways(state, false);
}
BENCHMARK(scattering_by_transform)
    ->Args({0, 100})
    ->Args({0, 300})
    ->Args({1, 40})
    ->Args({1, 100})
    ->Args({1, 300})
    ->Args({2, 40})
    ->Args({2, 100})
    ->Args({2, 300})
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(scattering_by_sums)
    ->Args({0, 100})
    ->Args({0, 300})
    ->Args({1, 40})
    ->Args({1, 100})
    ->Args({2, 40})
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void order_of_1024_grains(benchmark::State& state) {
  const auto centres = grain_centres(large().grains());
  for (auto _ : state) {
    benchmark::DoNotOptimize(bond_order(solid_angle_neighbours(large().box, centres)).data());
  }
}
BENCHMARK(order_of_1024_grains)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void contact_network_of_1024_grains(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(contact_network(large().box, large().grains()).size());
  }
}
BENCHMARK(contact_network_of_1024_grains)
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

} // namespace

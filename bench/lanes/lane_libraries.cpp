// SPDX-License-Identifier: GPL-3.0-or-later
// What the bond kernel costs most, roots and divisions, by lanes.h and by two SIMD libraries
// (docs/decisions/libraries.md). Each reads squared lengths and volume ratios near 1 and writes 1 / r and the cube root
// of the ratio.
#include "bpm/forces/kernels/lanes.h"

#include <benchmark/benchmark.h>
#include <hwy/highway.h>
#include <random>
#include <vector>
#include <xsimd/xsimd.hpp>

namespace kernels = boba::kernels;

namespace {

constexpr std::size_t n_numbers = 2048; // of each kind: all in the first level of the cache

struct Numbers {
  std::vector<double> squared, ratio, inverse = std::vector<double>(n_numbers), root = std::vector<double>(n_numbers);
  Numbers() {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> near_one(0.8, 1.25);
    for (std::size_t i = 0; i < n_numbers; ++i) {
      squared.push_back(near_one(random));
      ratio.push_back(near_one(random));
    }
  }
};

void report(benchmark::State& state, const Numbers& numbers) {
  double worst_inverse = 0.0, worst_root = 0.0; // relative, in units of the last place of 1
  for (std::size_t i = 0; i < n_numbers; ++i) {
    worst_inverse = std::max(worst_inverse, std::abs(numbers.inverse[i] * std::sqrt(numbers.squared[i]) - 1.0));
    worst_root = std::max(worst_root, std::abs(numbers.root[i] / std::cbrt(numbers.ratio[i]) - 1.0));
  }
  state.counters["error_inverse"] = worst_inverse;
  state.counters["error_root"] = worst_root;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n_numbers));
}

void own(benchmark::State& state) {
  Numbers numbers;
  for (auto _ : state) {
    for (std::size_t i = 0; i < n_numbers; i += kernels::native_lanes) {
      kernels::store(&numbers.inverse[i], kernels::inverse_sqrt(kernels::load<kernels::Wide>(&numbers.squared[i])));
      kernels::store(&numbers.root[i], kernels::cube_root(kernels::load<kernels::Wide>(&numbers.ratio[i])));
    }
    benchmark::ClobberMemory();
  }
  report(state, numbers);
}
BENCHMARK(own);

void with_xsimd(benchmark::State& state) {
  using Batch = xsimd::batch<double>;
  Numbers numbers;
  for (auto _ : state) {
    for (std::size_t i = 0; i < n_numbers; i += Batch::size) {
      (1.0 / xsimd::sqrt(Batch::load_unaligned(&numbers.squared[i]))).store_unaligned(&numbers.inverse[i]);
      xsimd::cbrt(Batch::load_unaligned(&numbers.ratio[i])).store_unaligned(&numbers.root[i]);
    }
    benchmark::ClobberMemory();
  }
  report(state, numbers);
}
BENCHMARK(with_xsimd);

// Highway has no cube root: the exponential and logarithm of its mathematics take too long, so lanes.h's formula is
// written with its operations.
namespace hw = hwy::HWY_NAMESPACE;
template <class D, class V> V highway_cube_root(D d, V x) {
  const V t = hw::Sub(x, hw::Set(d, 1.0));
  V y = hw::Set(d, -0.07066835568187121);
  for (const double c :
       {0.17781975688620016, -0.20453628969115334, 0.22143791401899482, -0.33058278061251845, 0.9999736554168059}) {
    y = hw::MulAdd(y, t, hw::Set(d, c));
  }
  const V xyy = hw::Mul(hw::Mul(x, y), y);
  const V h = hw::NegMulAdd(xyy, y, hw::Set(d, 1.0));
  V sum = hw::Set(d, 110.0 / 243.0);
  for (const double c : {40.0 / 81.0, 5.0 / 9.0, 2.0 / 3.0}) {
    sum = hw::MulAdd(sum, h, hw::Set(d, c));
  }
  return hw::MulAdd(xyy, hw::Mul(h, sum), xyy);
}

void with_highway(benchmark::State& state) {
  const hw::ScalableTag<double> d;
  Numbers numbers;
  for (auto _ : state) {
    for (std::size_t i = 0; i < n_numbers; i += hw::Lanes(d)) {
      hw::StoreU(hw::Div(hw::Set(d, 1.0), hw::Sqrt(hw::LoadU(d, &numbers.squared[i]))), d, &numbers.inverse[i]);
      hw::StoreU(highway_cube_root(d, hw::LoadU(d, &numbers.ratio[i])), d, &numbers.root[i]);
    }
    benchmark::ClobberMemory();
  }
  report(state, numbers);
}
BENCHMARK(with_highway);

} // namespace

BENCHMARK_MAIN();

// SPDX-License-Identifier: GPL-3.0-or-later
// What the machine can do at most, measured beside the kernels: bytes from memory and caches, fused multiply-adds.
#include <benchmark/benchmark.h>
#include <cstdint>
#include <vector>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace boba::bench {
namespace {

/// a <- b + s c over three arrays of the given size in KiB together: 24 bytes a number (and as much again that the
/// cache reads before it writes a, not counted here).
void triad(benchmark::State& state) {
  const std::int64_t n = state.range(0) * 1024 / 24;
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  for (auto _ : state) {
#pragma GCC ivdep
    for (std::int64_t i = 0; i < n; ++i) {
      a[i] = b[i] + 0.5 * c[i];
    }
    benchmark::DoNotOptimize(a.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * n * 24);
}
BENCHMARK(triad)->Arg(24)->Arg(1024)->Arg(16 * 1024)->Arg(512 * 1024);

#if defined(__x86_64__)
/// Sixteen independent chains of 512-bit fused multiply-adds; counted as instructions.
__attribute__((target("avx512f"))) double fma_chains(std::int64_t n) {
  __m512d sum[16];
  for (auto& s : sum) {
    s = _mm512_set1_pd(1.0);
  }
  const __m512d factor = _mm512_set1_pd(0.999999), term = _mm512_set1_pd(1e-9);
  for (std::int64_t i = 0; i < n; ++i) {
    for (auto& s : sum) {
      s = _mm512_fmadd_pd(s, factor, term);
    }
  }
  double total = 0.0;
  for (const auto& s : sum) {
    total += _mm512_reduce_add_pd(s);
  }
  return total;
}

void vector_multiply_adds(benchmark::State& state) {
  if (!__builtin_cpu_supports("avx512f")) {
    state.SkipWithError("this machine has no AVX-512");
    return;
  }
  std::int64_t n = 10000;
  for (auto _ : state) {
    benchmark::DoNotOptimize(n); // or the compiler takes the call out of the loop
    benchmark::DoNotOptimize(fma_chains(n));
  }
  state.counters["instructions"] =
      benchmark::Counter(static_cast<double>(state.iterations() * n * 16), benchmark::Counter::kIsRate);
}
BENCHMARK(vector_multiply_adds);
#endif

} // namespace
} // namespace boba::bench

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/kernels/kernels.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace boba::kernels {

namespace {

bool runs(const std::string& name) {
  if (name == "avx512") {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
  }
  if (name == "avx2") {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  }
  return name == "baseline";
}

const KernelTable& choose() {
  const KernelTable* const tables[] = {&avx512_table, &avx2_table, &baseline_table};
  const char* wanted = std::getenv("BOBA_ISA");
  for (const KernelTable* table : tables) {
    if ((wanted == nullptr || std::string(wanted) == table->name) && runs(table->name)) {
      return *table;
    }
  }
  throw std::invalid_argument("BOBA_ISA=" + std::string(wanted ? wanted : "") +
                              ": not an instruction set of this machine; allowed are avx512, avx2 and baseline, as far "
                              "as the machine has them");
}

} // namespace

const KernelTable& best_table() {
  static const KernelTable& table = choose();
  return table;
}

} // namespace boba::kernels

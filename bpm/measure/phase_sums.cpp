// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/phase_sums.h"

#include "bpm/measure/vector_clones.h"

#include <cassert>
#include <cmath>
#include <cstring>
#include <numbers>

namespace boba::measure {

namespace {

constexpr int lanes = 8;     ///< doubles of one 512-bit register
constexpr int registers = 4; ///< groups held in registers at once, to hide the latency of the products
constexpr int group = lanes * registers;

/// Loaded and stored by copies: rows begin at any number.
typedef double Lanes __attribute__((vector_size(lanes * sizeof(double))));

/// Adds exp(i q.r) of all nodes to `sums` ([n3][re, im][lane]) for n3 = 0 .. n_q - 1 steps beyond the phases given.
BOBA_VECTOR_CLONES void add_phases(const double* phase_re, const double* phase_im, const double* step_re,
                                   const double* step_im, std::size_t n_nodes, int n_q, double* sums) {
  for (std::size_t node = 0; node < n_nodes; node += group) {
    Lanes pr[registers], pi[registers], sr[registers], si[registers];
    for (int k = 0; k < registers; ++k) {
      const std::size_t at = node + static_cast<std::size_t>(k) * lanes;
      std::memcpy(&pr[k], phase_re + at, sizeof pr[k]);
      std::memcpy(&pi[k], phase_im + at, sizeof pi[k]);
      std::memcpy(&sr[k], step_re + at, sizeof sr[k]);
      std::memcpy(&si[k], step_im + at, sizeof si[k]);
    }
    double* out = sums;
    for (int q = 0; q < n_q; ++q, out += 2 * lanes) {
      Lanes re_sum, im_sum;
      std::memcpy(&re_sum, out, sizeof re_sum);
      std::memcpy(&im_sum, out + lanes, sizeof im_sum);
      re_sum += (pr[0] + pr[1]) + (pr[2] + pr[3]);
      im_sum += (pi[0] + pi[1]) + (pi[2] + pi[3]);
      std::memcpy(out, &re_sum, sizeof re_sum);
      std::memcpy(out + lanes, &im_sum, sizeof im_sum);
#pragma GCC unroll 4
      for (int k = 0; k < registers; ++k) {
        const Lanes re = pr[k] * sr[k] - pi[k] * si[k];
        pi[k] = pr[k] * si[k] + pi[k] * sr[k];
        pr[k] = re;
      }
    }
  }
}

/// phase *= step, or its conjugate, node by node.
BOBA_VECTOR_CLONES void multiply(double* phase_re, double* phase_im, const double* step_re, const double* step_im,
                                 double sign, std::size_t n_nodes) {
  for (std::size_t i = 0; i < n_nodes; ++i) {
    const double re = phase_re[i] * step_re[i] - sign * phase_im[i] * step_im[i];
    phase_im[i] = sign * phase_re[i] * step_im[i] + phase_im[i] * step_re[i];
    phase_re[i] = re;
  }
}

} // namespace

void PhaseSums::start(const Box& box, std::span<const Vector3> nodes, const ReciprocalRow& first) {
  const std::size_t padded = (nodes.size() + group - 1) / group * group;
  for (auto* part : {&phase_re_, &phase_im_, &step2_re_, &step2_im_, &step3_re_, &step3_im_}) {
    part->assign(padded, 0.0);
  }
  constexpr double two_pi = 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    // q.r = 2 pi n.s; whole numbers in s change nothing and would only cost digits.
    Vector3 s = box.to_fractional(nodes[i]);
    s -= Vector3(std::floor(s[0]), std::floor(s[1]), std::floor(s[2]));
    const double turns = first.n1 * s[0] + first.n2 * s[1] + first.low * s[2];
    phase_re_[i] = std::cos(two_pi * turns);
    phase_im_[i] = std::sin(two_pi * turns);
    step2_re_[i] = std::cos(two_pi * s[1]);
    step2_im_[i] = std::sin(two_pi * s[1]);
    step3_re_[i] = std::cos(two_pi * s[2]);
    step3_im_[i] = std::sin(two_pi * s[2]);
  }
  present_ = first;
}

void PhaseSums::move_to(const ReciprocalRow& row) {
  assert(row.n1 == present_.n1 && row.n2 >= present_.n2);
  const std::size_t n = phase_re_.size();
  for (; present_.n2 < row.n2; ++present_.n2) {
    multiply(phase_re_.data(), phase_im_.data(), step2_re_.data(), step2_im_.data(), 1.0, n);
  }
  for (; present_.low < row.low; ++present_.low) {
    multiply(phase_re_.data(), phase_im_.data(), step3_re_.data(), step3_im_.data(), 1.0, n);
  }
  for (; present_.low > row.low; --present_.low) {
    multiply(phase_re_.data(), phase_im_.data(), step3_re_.data(), step3_im_.data(), -1.0, n);
  }
}

void PhaseSums::sum_row(const ReciprocalRow& row, std::span<std::complex<double>> sums) {
  assert(static_cast<int>(sums.size()) == row.size());
  move_to(row);
  lanes_.assign(static_cast<std::size_t>(row.size()) * 2 * lanes, 0.0);
  add_phases(phase_re_.data(), phase_im_.data(), step3_re_.data(), step3_im_.data(), phase_re_.size(), row.size(),
             lanes_.data());
  const double* lane = lanes_.data();
  for (std::complex<double>& sum : sums) {
    double re = 0.0, im = 0.0;
    for (int k = 0; k < lanes; ++k) {
      re += lane[k];
      im += lane[lanes + k];
    }
    sum = {re, im};
    lane += 2 * lanes;
  }
}

} // namespace boba::measure

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/lane_products.h"

#include "bpm/measure/vector_clones.h"

#include <cstring>

namespace boba::measure {

namespace {

constexpr int lanes = 8;     ///< doubles of one 512-bit register
constexpr int registers = 4; ///< sums held at once, to hide the latency of the products

/// Loaded and stored by copies: rows begin at any number.
typedef double Lanes __attribute__((vector_size(lanes * sizeof(double))));

} // namespace

BOBA_VECTOR_CLONES
void multiply_row(const double* c_re, const double* c_im, int n_terms, const ComplexRows& m, int n_columns,
                  double* out_re, double* out_im) {
  constexpr int group = lanes * registers;
  int column = 0;
  for (; column + group <= n_columns; column += group) {
    Lanes re[registers] = {}, im[registers] = {};
    const double* row_re = m.re + column;
    if (m.im == nullptr) {
      for (int k = 0; k < n_terms; ++k, row_re += m.stride) {
        for (int r = 0; r < registers; ++r) {
          Lanes a;
          std::memcpy(&a, row_re + r * lanes, sizeof a);
          re[r] += c_re[k] * a;
          im[r] += c_im[k] * a;
        }
      }
    } else {
      const double* row_im = m.im + column;
      for (int k = 0; k < n_terms; ++k, row_re += m.stride, row_im += m.stride) {
        for (int r = 0; r < registers; ++r) {
          Lanes a, b;
          std::memcpy(&a, row_re + r * lanes, sizeof a);
          std::memcpy(&b, row_im + r * lanes, sizeof b);
          re[r] += c_re[k] * a;
          im[r] += c_re[k] * b;
          re[r] -= c_im[k] * b;
          im[r] += c_im[k] * a;
        }
      }
    }
    for (int r = 0; r < registers; ++r) {
      std::memcpy(out_re + column + r * lanes, &re[r], sizeof re[r]);
      std::memcpy(out_im + column + r * lanes, &im[r], sizeof im[r]);
    }
  }
  // What is left: fewer than `group` columns, the compiler's vectors serve.
  const int left = n_columns - column;
  if (left > 0) {
    double re[group] = {}, im[group] = {};
    for (int k = 0; k < n_terms; ++k) {
      const double* row_re = m.re + static_cast<long>(k) * m.stride + column;
      const double* row_im = m.im == nullptr ? nullptr : m.im + static_cast<long>(k) * m.stride + column;
      if (row_im == nullptr) {
        for (int j = 0; j < left; ++j) {
          re[j] += c_re[k] * row_re[j];
          im[j] += c_im[k] * row_re[j];
        }
      } else {
        for (int j = 0; j < left; ++j) {
          re[j] += c_re[k] * row_re[j] - c_im[k] * row_im[j];
          im[j] += c_re[k] * row_im[j] + c_im[k] * row_re[j];
        }
      }
    }
    for (int j = 0; j < left; ++j) {
      out_re[column + j] = re[j];
      out_im[column + j] = im[j];
    }
  }
}

} // namespace boba::measure

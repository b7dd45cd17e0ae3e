// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba::measure {

/// A complex matrix in two arrays, rows one after the other.
struct ComplexRows {
  const double* re = nullptr;
  const double* im = nullptr; ///< null: the matrix is real
  int stride = 0;             ///< numbers from one row to the next
};

/// out_j = sum_k c_k m_kj for columns 0 .. n_columns - 1: a row of complex numbers times a complex matrix.
///
/// The vector unit runs along the columns, with the sums in registers.
void multiply_row(const double* c_re, const double* c_im, int n_terms, const ComplexRows& m, int n_columns,
                  double* out_re, double* out_im);

} // namespace boba::measure

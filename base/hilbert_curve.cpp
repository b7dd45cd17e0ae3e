// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/hilbert_curve.h"

#include <bit>

namespace boba {

namespace {

unsigned rotate_right(unsigned b, int by) {
  return ((b >> by) | (b << (3 - by))) & 7u;
}
unsigned rotate_left(unsigned b, int by) {
  return ((b << by) | (b >> (3 - by))) & 7u;
}
unsigned gray(unsigned i) {
  return i ^ (i >> 1);
}
unsigned inverse_gray(unsigned g) {
  return g ^ (g >> 1) ^ (g >> 2);
}
/// Corner of octant i (in curve order) where the curve enters it.
unsigned entry_corner(unsigned i) {
  return i == 0 ? 0 : gray((i - 1) & ~1u);
}
/// Axis along which the curve runs inside octant i, relative to its parent's.
int inner_axis(unsigned i) {
  return i == 0 ? 0 : std::countr_one(i % 2 == 0 ? i - 1 : i) % 3;
}

} // namespace

std::uint64_t hilbert_index(const std::array<std::uint32_t, 3>& cell, int levels) {
  std::uint64_t index = 0;
  unsigned entry = 0;
  int axis = 0;
  for (int level = levels - 1; level >= 0; --level) {
    const unsigned octant = (cell[0] >> level & 1u) | (cell[1] >> level & 1u) << 1 | (cell[2] >> level & 1u) << 2;
    const int turn = (axis + 1) % 3;
    const unsigned i = inverse_gray(rotate_right(octant ^ entry, turn));
    index = index << 3 | i;
    entry ^= rotate_left(entry_corner(i), turn);
    axis = (axis + inner_axis(i) + 1) % 3;
  }
  return index;
}

} // namespace boba

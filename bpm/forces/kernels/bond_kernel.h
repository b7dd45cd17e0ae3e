// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only. The law itself is in bpm/laws/bond.h.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"
#include "bpm/laws/bond.h"

namespace {

using boba::kernels::BlockArraysOf;
using boba::kernels::BondParameters;
using boba::kernels::BondRecordOf;
using boba::kernels::LaneSums;
using boba::kernels::NetworkOf;
using boba::kernels::Virial;

template <class V> struct Triple { V c[3]; };

template <class V, class T> inline Triple<V> load3(const T* from, std::int64_t node, std::int64_t stride) {
  const T* at = from + 3 * node * stride;
  return {{load<V>(at), load<V>(at + stride), load<V>(at + 2 * stride)}};
}
template <class V, class T> inline void store3(T* to, std::int64_t node, std::int64_t stride, const Triple<V>& value) {
  T* at = to + 3 * node * stride;
  store<V>(at, value.c[0]);
  store<V>(at + stride, value.c[1]);
  store<V>(at + 2 * stride, value.c[2]);
}
template <class V> inline Triple<V> difference(const Triple<V>& a, const Triple<V>& b) {
  return {{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}};
}
template <class S, class P = typename S::P, class V = typename S::V>
inline Triple<V> separation(const Triple<P>& a, const Triple<P>& b, V quantum) {
  return {{S::distance(a.c[0], b.c[0], quantum), S::distance(a.c[1], b.c[1], quantum),
           S::distance(a.c[2], b.c[2], quantum)}};
}
template <class V> inline V dot(const Triple<V>& a, const Triple<V>& b) {
  return multiply_add(a.c[2], b.c[2], multiply_add(a.c[1], b.c[1], a.c[0] * b.c[0]));
}

/// Adds r^3 of the bonds of the nodes [begin, end) to the volumes of both of their nodes. Pointers start at the first
/// lane.
template <class S, class Coordinate = typename S::Coordinate, class Real = typename S::Real>
void node_volumes(const NetworkOf<Real>& network, const Coordinate* x, Real* volume, double quantum, std::int64_t begin,
                  std::int64_t end) {
  using V = typename S::V;
  using P = typename S::P;
  constexpr std::int64_t stride = S::stride;
  const V q = splat<V>(quantum);
  for (std::int64_t i = begin; i < end; ++i) {
    const Triple<P> xi = load3<P>(x, i, stride);
    V sum = load<V>(volume + i * stride);
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      const std::int64_t j = network.bonds[b].other;
      const Triple<V> d = separation<S>(xi, load3<P>(x, j, stride), q);
      const V r2 = dot(d, d);
      const V cube = r2 * r2 * inverse_sqrt(r2);
      sum += cube;
      store<V>(volume + j * stride, load<V>(volume + j * stride) + cube);
    }
    store<V>(volume + i * stride, sum);
  }
}

template <class Coordinate, class Real>
void volumes_of_nodes(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a) {
  for_lanes<Coordinate>(a.n_lanes, [&](int lane, auto storage) {
    node_volumes<decltype(storage)>(network, a.x + lane, a.volume + lane, a.quantum, 0, network.n_nodes);
  });
}

/// xx yy zz xy xz yz and the trace. The trace is summed apart, so that the barostat sees the same number whether
/// somebody reads the whole tensor at this step or not.
template <class V> struct Tensor { V c[7]; };

/// Adds s * a (x) a with a . a = a2, or only its trace.
template <Virial virial, class V> inline void add_dyad(Tensor<V>& sum, V s, const Triple<V>& a, V a2) {
  if constexpr (virial != Virial::none) {
    sum.c[6] = multiply_add(s, a2, sum.c[6]);
  }
  if constexpr (virial == Virial::full) {
    const Triple<V> b = {{s * a.c[0], s * a.c[1], s * a.c[2]}};
    sum.c[0] = multiply_add(b.c[0], a.c[0], sum.c[0]);
    sum.c[1] = multiply_add(b.c[1], a.c[1], sum.c[1]);
    sum.c[2] = multiply_add(b.c[2], a.c[2], sum.c[2]);
    sum.c[3] = multiply_add(b.c[0], a.c[1], sum.c[3]);
    sum.c[4] = multiply_add(b.c[0], a.c[2], sum.c[4]);
    sum.c[5] = multiply_add(b.c[1], a.c[2], sum.c[5]);
  }
}

/// What one node adds goes to sums in double, whatever it was computed in.
template <Virial virial, class V> inline void add_to(Tensor<DoublesOf<V>>& sum, const Tensor<V>& node) {
  if constexpr (virial != Virial::none) {
    sum.c[6] += converted<DoublesOf<V>>(node.c[6]);
  }
  if constexpr (virial == Virial::full) {
    for (int c = 0; c < 6; ++c) {
      sum.c[c] += converted<DoublesOf<V>>(node.c[c]);
    }
  }
}

template <class D> void store_tensor(const Tensor<D>& sum, double (*to)[boba::max_lanes], int lane) {
  for (int c = 0; c < 7; ++c) {
    store<D>(&to[c][lane], sum.c[c]);
  }
}

/// One pass over the nodes. A node's force is complete when its own bonds are done, since bonds to earlier nodes were
/// added when those were visited; nobody needs its velocity any more, so it is kicked on the spot.
template <class S, bool many_body, bool damped, Virial virial, class Coordinate = typename S::Coordinate,
          class Real = typename S::Real>
void bond_lanes(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a, const BondParameters& p,
                int lane, LaneSums& sums) {
  using V = typename S::V;
  using P = typename S::P;
  constexpr std::int64_t stride = S::stride;
  const Coordinate* x = a.x + lane;
  Real* v = a.v + lane;
  Real* f = a.f + lane;
  Real* volume = a.volume + lane;
  const V alpha = load_doubles<V>(a.alpha + lane);
  const V q = splat<V>(a.quantum), kick = splat<V>(p.kick), half_kick = splat<V>(p.half_kick), mass = splat<V>(p.mass);
  const V residual_shift = load_doubles<V>(a.residual_shift + lane);
  const auto k = static_cast<Real>(p.k), gamma = static_cast<Real>(p.gamma);
  Tensor<DoublesOf<V>> stress{}, kinetic{};
  std::int64_t volumes_done = 0;
  for (std::int64_t i = 0; i < network.n_nodes; ++i) {
    if constexpr (many_body) {
      // Volumes run ahead of forces just as far as the bonds of the nodes up to here reach: what one pass reads is
      // still in the cache for the other.
      if (network.reach[i] > volumes_done) {
        const std::int64_t ahead = boba::kernels::volume_chunk;
        const std::int64_t end =
            network.reach[i] + ahead < network.n_nodes ? network.reach[i] + ahead : network.n_nodes;
        node_volumes<S>(network, x, volume, a.quantum, volumes_done, end);
        volumes_done = end;
      }
    }
    const Triple<P> xi = load3<P>(x, i, stride);
    const Triple<V> vi = load3<V>(v, i, stride);
    Triple<V> fi = load3<V>(f, i, stride);
    Tensor<V> node_stress{};
    V volume_i{};
    if constexpr (many_body) {
      volume_i = load<V>(volume + i * stride);
    }
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      const BondRecordOf<Real>& bond = network.bonds[b];
      const std::int64_t j = bond.other;
      const Triple<V> d = separation<S>(xi, load3<P>(x, j, stride), q);
      const V r2 = dot(d, d);
      const V inverse_r = inverse_sqrt(r2);
      const V r = r2 * inverse_r;
      V normal_velocity{};
      if constexpr (damped) {
        normal_velocity = dot(d, difference(vi, load3<V>(v, j, stride))) * inverse_r;
      }
      V force;
      if constexpr (many_body) {
        const V ratio = (volume_i + load<V>(volume + j * stride)) * bond.inverse_volume;
        force = boba::bond_force(k, alpha, gamma, r, bond.r0, bond.inverse_r0, cube_root(ratio), normal_velocity);
      } else {
        force = boba::bond_force_pairwise(k, gamma, r, bond.r0, normal_velocity);
      }
      const V s = force * inverse_r;
      Triple<V> fj = load3<V>(f, j, stride);
      for (int c = 0; c < 3; ++c) {
        fi.c[c] = multiply_add(s, d.c[c], fi.c[c]);
        fj.c[c] = subtract_product(fj.c[c], s, d.c[c]);
      }
      store3<V>(f, j, stride, fj);
      add_dyad<virial>(node_stress, s, d, r2);
    }
    add_to<virial>(stress, node_stress);
    store3<V>(f, i, stride, fi);
    Triple<V> kicked, full;
    for (int c = 0; c < 3; ++c) {
      full.c[c] = multiply_add(half_kick, fi.c[c], vi.c[c]);
      kicked.c[c] = multiply_add(kick, fi.c[c], vi.c[c]);
    }
    store3<V>(v, i, stride, kicked);
    if constexpr (virial != Virial::none) {
      V streaming = residual_shift;
      for (int c = 0; c < 3; ++c) {
        streaming = multiply_add(splat<V>(p.residual[c]), S::value(xi.c[c], q), streaming);
      }
      full.c[0] -= streaming;
    }
    Tensor<V> node_kinetic{};
    add_dyad<virial>(node_kinetic, mass, full, dot(full, full));
    add_to<virial>(kinetic, node_kinetic);
  }
  store_tensor(stress, sums.virial, lane);
  store_tensor(kinetic, sums.kinetic, lane);
}

template <bool many_body, bool damped, class Coordinate, class Real>
void bond_block(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a, const BondParameters& p,
                Virial virial, LaneSums& sums) {
  for_lanes<Coordinate>(a.n_lanes, [&](int lane, auto storage) {
    using S = decltype(storage);
    switch (virial) {
    case Virial::none:
      bond_lanes<S, many_body, damped, Virial::none>(network, a, p, lane, sums);
      break;
    case Virial::trace:
      bond_lanes<S, many_body, damped, Virial::trace>(network, a, p, lane, sums);
      break;
    case Virial::full:
      bond_lanes<S, many_body, damped, Virial::full>(network, a, p, lane, sums);
      break;
    }
  });
}

template <class Coordinate, class Real>
void bond_forces(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& arrays,
                 const BondParameters& parameters, bool many_body, Virial virial, LaneSums& sums) {
  const bool damped = parameters.gamma != 0.0;
  if (many_body) {
    damped ? bond_block<true, true>(network, arrays, parameters, virial, sums)
           : bond_block<true, false>(network, arrays, parameters, virial, sums);
  } else {
    damped ? bond_block<false, true>(network, arrays, parameters, virial, sums)
           : bond_block<false, false>(network, arrays, parameters, virial, sums);
  }
}

} // namespace

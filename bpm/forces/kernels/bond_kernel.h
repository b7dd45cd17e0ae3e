// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only. The law itself is in bpm/laws/bond.h.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"
#include "bpm/laws/bond.h"

namespace {

using boba::kernels::BlockArrays;
using boba::kernels::BondParameters;
using boba::kernels::BondRecord;
using boba::kernels::LaneSums;
using boba::kernels::Network;
using boba::kernels::Virial;

template <class V> struct Triple {
  V c[3];
};

template <class V> inline Triple<V> load3(const double* from, std::int64_t node, int stride) {
  const double* at = from + 3 * node * stride;
  return {{load<V>(at), load<V>(at + stride), load<V>(at + 2 * stride)}};
}
template <class V> inline void store3(double* to, std::int64_t node, int stride, const Triple<V>& value) {
  double* at = to + 3 * node * stride;
  store<V>(at, value.c[0]);
  store<V>(at + stride, value.c[1]);
  store<V>(at + 2 * stride, value.c[2]);
}
template <class V> inline Triple<V> difference(const Triple<V>& a, const Triple<V>& b) {
  return {{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}};
}
template <class V> inline V dot(const Triple<V>& a, const Triple<V>& b) {
  return multiply_add(a.c[2], b.c[2], multiply_add(a.c[1], b.c[1], a.c[0] * b.c[0]));
}

/// Adds r^3 of the bonds of the nodes [begin, end) to the volumes of both of their nodes.
template <class V>
void node_volumes(const Network& network, const double* x, double* volume, int stride, std::int64_t begin,
                  std::int64_t end) {
  for (std::int64_t i = begin; i < end; ++i) {
    const Triple<V> xi = load3<V>(x, i, stride);
    V sum = load<V>(volume + i * stride);
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      const std::int64_t j = network.bonds[b].other;
      const Triple<V> d = difference(xi, load3<V>(x, j, stride));
      const V r2 = dot(d, d);
      const V cube = r2 * r2 * inverse_sqrt(r2);
      sum += cube;
      store<V>(volume + j * stride, load<V>(volume + j * stride) + cube);
    }
    store<V>(volume + i * stride, sum);
  }
}

void volumes_of_nodes(const Network& network, const double* x, double* volume, int n_lanes) {
  if (n_lanes == 1) {
    node_volumes<double>(network, x, volume, 1, 0, network.n_nodes);
    return;
  }
  for (int lane = 0; lane < n_lanes; lane += native_lanes) {
    node_volumes<Wide>(network, x + lane, volume + lane, n_lanes, 0, network.n_nodes);
  }
}

/// xx yy zz xy xz yz and the trace. The trace is summed apart, so that the barostat sees the same number whether
/// somebody reads the whole tensor at this step or not.
template <class V> struct Tensor {
  V c[7];
};

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

template <class V> void store_tensor(const Tensor<V>& sum, double (*to)[8], int lane) {
  for (int c = 0; c < 7; ++c) {
    store<V>(&to[c][lane], sum.c[c]);
  }
}

/// One pass over the nodes. A node's force is complete when its own bonds are done, since bonds to earlier nodes were
/// added when those were visited; nobody needs its velocity any more, so it is kicked on the spot.
template <class V, bool many_body, bool damped, Virial virial>
void bond_lanes(const Network& network, const BlockArrays& a, const BondParameters& p, int lane, LaneSums& sums) {
  const int stride = a.n_lanes;
  const double* x = a.x + lane;
  double* v = a.v + lane;
  double* f = a.f + lane;
  double* volume = a.volume + lane;
  const V alpha = load<V>(a.alpha + lane);
  Tensor<V> stress{}, kinetic{};
  std::int64_t volumes_done = 0;
  for (std::int64_t i = 0; i < network.n_nodes; ++i) {
    if constexpr (many_body) {
      // Volumes run ahead of forces just as far as the bonds of the nodes up to here reach: what one pass reads is
      // still in the cache for the other.
      if (network.reach[i] > volumes_done) {
        const std::int64_t ahead = boba::kernels::volume_chunk;
        const std::int64_t end = network.reach[i] + ahead < network.n_nodes ? network.reach[i] + ahead : network.n_nodes;
        node_volumes<V>(network, x, volume, stride, volumes_done, end);
        volumes_done = end;
      }
    }
    const Triple<V> xi = load3<V>(x, i, stride);
    const Triple<V> vi = load3<V>(v, i, stride);
    Triple<V> fi = load3<V>(f, i, stride);
    V volume_i{};
    if constexpr (many_body) {
      volume_i = load<V>(volume + i * stride);
    }
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      const BondRecord& bond = network.bonds[b];
      const std::int64_t j = bond.other;
      const Triple<V> d = difference(xi, load3<V>(x, j, stride));
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
        force = boba::bond_force(p.k, alpha, p.gamma, r, bond.r0, bond.inverse_r0, cube_root(ratio), normal_velocity);
      } else {
        force = boba::bond_force_pairwise(p.k, p.gamma, r, bond.r0, normal_velocity);
      }
      const V s = force * inverse_r;
      Triple<V> fj = load3<V>(f, j, stride);
      for (int c = 0; c < 3; ++c) {
        fi.c[c] = multiply_add(s, d.c[c], fi.c[c]);
        fj.c[c] = subtract_product(fj.c[c], s, d.c[c]);
      }
      store3<V>(f, j, stride, fj);
      add_dyad<virial>(stress, s, d, r2);
    }
    store3<V>(f, i, stride, fi);
    Triple<V> kicked, full;
    for (int c = 0; c < 3; ++c) {
      full.c[c] = multiply_add(splat<V>(p.half_kick), fi.c[c], vi.c[c]);
      kicked.c[c] = multiply_add(splat<V>(p.kick), fi.c[c], vi.c[c]);
    }
    store3<V>(v, i, stride, kicked);
    if constexpr (virial != Virial::none) {
      full.c[0] -= p.residual[0] * xi.c[0] + p.residual[1] * xi.c[1] + p.residual[2] * xi.c[2] + p.residual_shift;
    }
    add_dyad<virial>(kinetic, splat<V>(p.mass), full, dot(full, full));
  }
  store_tensor(stress, sums.virial, lane);
  store_tensor(kinetic, sums.kinetic, lane);
}

template <class V, bool many_body, bool damped>
void bond_lanes(const Network& network, const BlockArrays& a, const BondParameters& p, Virial virial, LaneSums& sums) {
  for (int lane = 0; lane < a.n_lanes; lane += lanes_of<V>) {
    switch (virial) {
    case Virial::none: bond_lanes<V, many_body, damped, Virial::none>(network, a, p, lane, sums); break;
    case Virial::trace: bond_lanes<V, many_body, damped, Virial::trace>(network, a, p, lane, sums); break;
    case Virial::full: bond_lanes<V, many_body, damped, Virial::full>(network, a, p, lane, sums); break;
    }
  }
}

template <class V>
void bond_lanes(const Network& network, const BlockArrays& a, const BondParameters& p, bool many_body, Virial virial,
                LaneSums& sums) {
  const bool damped = p.gamma != 0.0;
  if (many_body) {
    damped ? bond_lanes<V, true, true>(network, a, p, virial, sums)
           : bond_lanes<V, true, false>(network, a, p, virial, sums);
  } else {
    damped ? bond_lanes<V, false, true>(network, a, p, virial, sums)
           : bond_lanes<V, false, false>(network, a, p, virial, sums);
  }
}

void bond_forces(const Network& network, const BlockArrays& arrays, const BondParameters& parameters, bool many_body,
                 Virial virial, LaneSums& sums) {
  if (arrays.n_lanes == 1) {
    bond_lanes<double>(network, arrays, parameters, many_body, virial, sums);
  } else {
    bond_lanes<Wide>(network, arrays, parameters, many_body, virial, sums);
  }
}

} // namespace

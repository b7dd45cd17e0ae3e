// SPDX-License-Identifier: GPL-3.0-or-later
// The bond pass, for any bond law: kernels.cpp makes it for those of bpm/laws, once for each instruction set.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"

namespace boba::kernels {
namespace {

template <class V> struct Triple { V c[3]; };

struct Yes {
  static constexpr bool value = true;
};
struct No {
  static constexpr bool value = false;
};

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
/// In units of the coordinates: who needs d multiplies what comes out, not every component.
template <class S, class P = typename S::P, class V = typename S::V>
inline Triple<V> separation(const Triple<P>& a, const Triple<P>& b) {
  return {{S::distance(a.c[0], b.c[0]), S::distance(a.c[1], b.c[1]), S::distance(a.c[2], b.c[2])}};
}
template <class V> inline V dot(const Triple<V>& a, const Triple<V>& b) {
  return multiply_add(a.c[2], b.c[2], multiply_add(a.c[1], b.c[1], a.c[0] * b.c[0]));
}

/// r^3 of a separation.
template <class V> inline V cube_of(const Triple<V>& d) {
  const V r2 = dot(d, d);
  return r2 * r2 * inverse_sqrt(r2);
}

/// A bond law with a memory, such as BreakingBondLaw.
template <class Law> constexpr bool remembers = requires {
  Law::n_remembered;
};

/// What one bond remembers in the lanes at hand.
template <class V, int n> struct Remembered { V c[n]; };

/// That of bond b; `memory` points to the first lane.
template <class S, class Law, class Real>
inline Remembered<typename S::V, Law::n_remembered> remembered(const Real* memory, std::int64_t b) {
  Remembered<typename S::V, Law::n_remembered> values;
  for (int k = 0; k < Law::n_remembered; ++k) {
    values.c[k] = load<typename S::V>(memory + (b * Law::n_remembered + k) * S::stride);
  }
  return values;
}
template <class S, class Law, class Real>
inline void remember(Real* memory, std::int64_t b, const Remembered<typename S::V, Law::n_remembered>& values) {
  for (int k = 0; k < Law::n_remembered; ++k) {
    store<typename S::V>(memory + (b * Law::n_remembered + k) * S::stride, values.c[k]);
  }
}
/// The cube of the length that V0 counts; 0 of a broken bond.
template <class Law, class V, class Real, int n> inline V rest_cube(Real r0, const Remembered<V, n>& memory) {
  const V length = Law::rest_length(r0, memory.c);
  return Law::if_whole(length * length * length, memory.c);
}

/// Adds r^3 of the bonds of the nodes [begin, end) to the volumes of both of their nodes, but not to nodes from own_end
/// on; that of a node is then complete, and becomes d^3. Pointers start at the first lane.
template <class S, bool shared, class Coordinate = typename S::Coordinate, class Real = typename S::Real>
void node_volumes(const NetworkOf<Real>& network, const Coordinate* x, Real* volume, double quantum, std::int64_t begin,
                  std::int64_t end, std::int64_t own_end) {
  using V = typename S::V;
  using P = typename S::P;
  constexpr std::int64_t stride = S::stride;
  const V q3 = splat<V>(quantum * quantum * quantum);
  for (std::int64_t i = begin; i < end; ++i) {
    const Triple<P> xi = load3<P>(x, i, stride);
    V sum = load<V>(volume + i * stride);
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      const std::int64_t j = network.bonds[b].other;
      const Triple<V> d = separation<S>(xi, load3<P>(x, j, stride));
      const V cube = cube_of(d);
      sum += cube;
      if (!shared || j < own_end) {
        store<V>(volume + j * stride, load<V>(volume + j * stride) + cube);
      }
    }
    store<V>(volume + i * stride, S::in_diameters(sum, q3));
  }
}

/// The same for a law with a memory, of the bonds that are whole; r0^3 too, into the rest volumes.
template <class S, bool shared, class Law, class Coordinate = typename S::Coordinate, class Real = typename S::Real>
void whole_node_volumes(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a, int lane,
                        std::int64_t begin, std::int64_t end, std::int64_t own_end) {
  using V = typename S::V;
  using P = typename S::P;
  constexpr std::int64_t stride = S::stride;
  const Coordinate* x = a.x + lane;
  Real *volume = a.volume + lane, *rest_volume = a.rest_volume + lane;
  const V q3 = splat<V>(a.quantum * a.quantum * a.quantum);
  for (std::int64_t i = begin; i < end; ++i) {
    const Triple<P> xi = load3<P>(x, i, stride);
    V sum = load<V>(volume + i * stride), rest_sum = load<V>(rest_volume + i * stride);
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      const Real r0 = network.bonds[b].r0;
      const std::int64_t j = network.bonds[b].other;
      const Remembered<V, Law::n_remembered> memory = remembered<S, Law>(a.memory + lane, b);
      const V cube = Law::if_whole(cube_of(separation<S>(xi, load3<P>(x, j, stride))), memory.c);
      const V at_rest = rest_cube<Law>(r0, memory);
      sum += cube;
      rest_sum += at_rest;
      if (!shared || j < own_end) {
        store<V>(volume + j * stride, load<V>(volume + j * stride) + cube);
        store<V>(rest_volume + j * stride, load<V>(rest_volume + j * stride) + at_rest);
      }
    }
    store<V>(volume + i * stride, S::in_diameters(sum, q3));
    store<V>(rest_volume + i * stride, rest_sum);
  }
}

/// Calls visit(i, b) for the bonds b of nodes i before a range that join a node of the range.
template <class Real, class Visit>
inline void for_each_bond_from_before(const NetworkOf<Real>& network, const NodeRange& range, Visit&& visit) {
  std::int64_t first = 0; // the first node with a bond that reaches the range, or later ones
  for (std::int64_t last = range.begin; first < last;) {
    const std::int64_t middle = (first + last) / 2;
    if (network.reach[middle] > range.begin) {
      last = middle;
    } else {
      first = middle + 1;
    }
  }
  for (std::int64_t i = first; i < range.begin; ++i) {
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      if (network.bonds[b].other >= range.begin && network.bonds[b].other < range.end) {
        visit(i, b);
      }
    }
  }
}

template <class Coordinate, class Real>
void volumes_of_nodes(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a,
                      const NodeRange& range) {
  for_lanes<Coordinate>(a.n_lanes, [&](int lane, auto storage) {
    using S = decltype(storage);
    using V = typename S::V;
    const Coordinate* x = a.x + lane;
    Real* volume = a.volume + lane;
    for_each_bond_from_before(network, range, [&](std::int64_t i, std::int64_t b) {
      const std::int64_t j = network.bonds[b].other;
      const Triple<V> d = separation<S>(load3<typename S::P>(x, i, S::stride), load3<typename S::P>(x, j, S::stride));
      const V cube = cube_of(d);
      store<V>(volume + j * S::stride, load<V>(volume + j * S::stride) + cube);
    });
    node_volumes<S, true>(network, x, volume, a.quantum, range.begin, range.end, range.own_end);
  });
}

template <class Coordinate, class Real, class Law>
void volumes_of_whole_bonds(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a,
                            const NodeRange& range) {
  for_lanes<Coordinate>(a.n_lanes, [&](int lane, auto storage) {
    using S = decltype(storage);
    using V = typename S::V;
    using P = typename S::P;
    const Coordinate* x = a.x + lane;
    Real *volume = a.volume + lane, *rest_volume = a.rest_volume + lane;
    for_each_bond_from_before(network, range, [&](std::int64_t i, std::int64_t b) {
      const Real r0 = network.bonds[b].r0;
      const std::int64_t j = network.bonds[b].other;
      const Remembered<V, Law::n_remembered> memory = remembered<S, Law>(a.memory + lane, b);
      const V cube =
          Law::if_whole(cube_of(separation<S>(load3<P>(x, i, S::stride), load3<P>(x, j, S::stride))), memory.c);
      store<V>(volume + j * S::stride, load<V>(volume + j * S::stride) + cube);
      store<V>(rest_volume + j * S::stride, load<V>(rest_volume + j * S::stride) + rest_cube<Law>(r0, memory));
    });
    whole_node_volumes<S, true, Law>(network, a, lane, range.begin, range.end, range.own_end);
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

/// Force over distance of one bond; d and r2 are its separation in units of the coordinates, as is the distance of the
/// result.
template <class S, bool many_body, bool damped, class Law, class V = typename S::V, class Real = typename S::Real>
inline V bond_scale(const BondRecordOf<Real>& bond, const Triple<V>& d, V r2, V quantum, const Triple<V>& vi,
                    const Triple<V>& vj, V volumes, V alpha, const Law& law) {
  const V inverse_r = inverse_sqrt(r2);
  const V r = S::in_diameters(r2 * inverse_r, quantum);
  V normal_velocity{};
  if constexpr (damped) {
    normal_velocity = dot(d, difference(vi, vj)) * inverse_r;
  }
  V force;
  if constexpr (many_body) {
    const V ratio = volumes * bond.inverse_volume;
    force = law.force(alpha, r, bond.r0, bond.inverse_r0, cube_root(ratio), normal_velocity);
  } else {
    force = law.pairwise_force(r, bond.r0, bond.inverse_r0, normal_velocity);
  }
  return force * inverse_r;
}

/// The same by a law with a memory; `rest_volumes`: V0_i + V0_j of the bonds that are whole.
template <class S, bool many_body, class Law, class V = typename S::V, class Real = typename S::Real>
inline V remembering_scale(const BondRecordOf<Real>& bond, const Triple<V>& d, V r2, V quantum, const Triple<V>& vi,
                           const Triple<V>& vj, V volumes, V rest_volumes, V alpha, const Law& law,
                           Remembered<V, Law::n_remembered>& memory) {
  const V inverse_r = inverse_sqrt(r2);
  const V r = S::in_diameters(r2 * inverse_r, quantum);
  const V normal_velocity = dot(d, difference(vi, vj)) * inverse_r;
  V force;
  if constexpr (many_body) {
    const V root = cube_root(volumes / rest_volumes);
    force = law.force(alpha, r, bond.r0, bond.inverse_r0, root, normal_velocity, memory.c);
  } else {
    force = law.pairwise_force(r, bond.r0, bond.inverse_r0, normal_velocity, memory.c);
  }
  return Law::if_whole(force * inverse_r, memory.c);
}

/// Takes s d, the force on a bond's first node, from its second node j.
template <class V, class Real>
inline void add_to_second(Real* f, std::int64_t j, std::int64_t stride, V s, const Triple<V>& d) {
  Triple<V> fj = load3<V>(f, j, stride);
  for (int c = 0; c < 3; ++c) {
    fj.c[c] = subtract_product(fj.c[c], s, d.c[c]);
  }
  store3<V>(f, j, stride, fj);
}

/// V0_i + V0_j in the lanes at hand.
template <class S, class Coordinate, class Real>
inline typename S::V rest_volumes_of(const BlockArraysOf<Coordinate, Real>& a, int lane, std::int64_t i,
                                     std::int64_t j) {
  using V = typename S::V;
  return load<V>(a.rest_volume + lane + i * S::stride) + load<V>(a.rest_volume + lane + j * S::stride);
}

/// True when any lane of any number is not the same as before.
template <class V, int n> inline bool any_changed(const Remembered<V, n>& before, const Remembered<V, n>& now) {
  bool changed = false;
  for (int k = 0; k < n; ++k) {
    changed |= any_different(before.c[k], now.c[k]);
  }
  return changed;
}

/// Force over distance of bond b from node i, by a law with a memory, which is written back where it changes.
template <class S, bool many_body, class Law, class Coordinate, class Real, class V = typename S::V>
inline V scale_and_remember(const BlockArraysOf<Coordinate, Real>& a, int lane, std::int64_t i, std::int64_t b,
                            const BondRecordOf<Real>& bond, const Triple<V>& d, V r2, V quantum, const Triple<V>& vi,
                            const Triple<V>& vj, V volumes, V alpha, const Law& law, LaneSums& sums) {
  V rest_volumes{};
  if constexpr (many_body) {
    rest_volumes = rest_volumes_of<S>(a, lane, i, bond.other);
  }
  const Remembered<V, Law::n_remembered> before = remembered<S, Law>(a.memory + lane, b);
  Remembered<V, Law::n_remembered> memory = before;
  const V s = remembering_scale<S, many_body>(bond, d, r2, quantum, vi, vj, volumes, rest_volumes, alpha, law, memory);
  if (__builtin_expect(any_changed(before, memory), 0) && a.keeps_memory) {
    remember<S, Law>(a.memory + lane, b, memory);
    sums.n_broken += any_different(before.c[0], memory.c[0]) ? 1 : 0;
  }
  return s;
}

/// One pass over a range of nodes. A node's force is complete when its own bonds are done, since bonds to earlier nodes
/// were added when those were visited; nobody needs its velocity any more, so it is kicked on the spot. `shared`: other
/// threads deal with the nodes from own_end on.
template <class S, bool many_body, bool damped, bool shared, Virial virial, class Law,
          class Coordinate = typename S::Coordinate, class Real = typename S::Real>
void bond_lanes(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a,
                const BondParametersOf<Law>& p, int lane, const NodeRange& range, std::int64_t& volumes_done,
                LaneSums& sums) {
  using V = typename S::V;
  using P = typename S::P;
  constexpr std::int64_t stride = S::stride;
  const Coordinate* x = a.x + lane;
  Real* v = a.v + lane;
  const Real* v_beyond = shared ? a.v_beyond + lane : nullptr;
  Real* f = a.f + lane;
  Real* volume = a.volume + lane;
  const V alpha = load_doubles<V>(a.alpha + lane);
  const V q = splat<V>(a.quantum), kick = splat<V>(p.kick), half_kick = splat<V>(p.half_kick), mass = splat<V>(p.mass);
  const V residual_shift = load_doubles<V>(a.residual_shift + lane);
  const auto law = p.law.template in<Real>();
  Tensor<DoublesOf<V>> stress{}, kinetic{};
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    if constexpr (many_body) {
      // Volumes run ahead of forces just as far as the bonds of the nodes up to here reach: what one pass reads is
      // still in the cache for the other.
      if (network.reach[i] > volumes_done) {
        const std::int64_t ahead = volume_chunk;
        const std::int64_t end =
            network.reach[i] + ahead < network.n_nodes ? network.reach[i] + ahead : network.n_nodes;
        if constexpr (remembers<Law>) {
          whole_node_volumes<S, false, Law>(network, a, lane, volumes_done, end, network.n_nodes);
        } else {
          node_volumes<S, false>(network, x, volume, a.quantum, volumes_done, end, network.n_nodes);
        }
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
      const Triple<V> d = separation<S>(xi, load3<P>(x, j, stride));
      const V r2 = dot(d, d);
      Triple<V> vj{};
      if constexpr (damped) {
        const bool own = !shared || j < range.own_end;
        vj = load3<V>(own ? v : v_beyond, own ? j : j - range.own_end, stride);
      }
      V volumes{};
      if constexpr (many_body) {
        volumes = volume_i + load<V>(volume + j * stride);
      }
      V s;
      if constexpr (remembers<Law>) {
        s = scale_and_remember<S, many_body>(a, lane, i, b, bond, d, r2, q, vi, vj, volumes, alpha, law, sums);
      } else {
        s = bond_scale<S, many_body, damped>(bond, d, r2, q, vi, vj, volumes, alpha, law);
      }
      for (int c = 0; c < 3; ++c) {
        fi.c[c] = multiply_add(s, d.c[c], fi.c[c]);
      }
      if (!shared || j < range.own_end) {
        add_to_second(f, j, stride, s, d);
      }
      add_dyad<virial>(node_stress, s, d, r2);
    }
    for (V& sum : node_stress.c) {
      sum = S::in_diameters(sum, q);
    }
    add_to<virial>(stress, node_stress);
    store3<V>(f, i, stride, a.leaves_zeros ? Triple<V>{} : fi);
    if (many_body && a.leaves_zeros) {
      store<V>(volume + i * stride, V{});
      if constexpr (remembers<Law>) {
        store<V>(a.rest_volume + lane + i * stride, V{});
      }
    }
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

/// Calls call with one truth value, or two, as constants.
template <class Call> inline void with_constant(bool x, Call&& call) {
  x ? call(Yes{}) : call(No{});
}
template <class Call> inline void with_constants(bool x, bool y, Call&& call) {
  with_constant(x, [&](auto is_x) { with_constant(y, [&](auto is_y) { call(is_x, is_y); }); });
}

/// The same with whether the bonds have many-body forces, and whether they are damped: those of laws with a memory
/// always are.
template <class Law, class Call> inline void with_variant(bool many_body, const Law& law, Call&& call) {
  if constexpr (remembers<Law>) {
    with_constant(many_body, [&](auto is_many_body) { call(is_many_body, Yes{}); });
  } else {
    with_constants(many_body, law.is_damped(), call);
  }
}

template <class Coordinate, class Real, class Law>
void bond_forces(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a,
                 const BondParametersOf<Law>& p, bool many_body, Virial virial, const NodeRange& range,
                 std::int64_t& volumes_done, LaneSums& sums) {
  const std::int64_t done_before = volumes_done; // the same for every register of lanes
  with_variant<Law>(many_body, p.law, [&](auto is_many_body, auto is_damped) {
    with_constant(range.own_end < network.n_nodes, [&](auto is_shared) {
      for_lanes<Coordinate>(a.n_lanes, [&](int lane, auto storage) {
        using S = decltype(storage);
        constexpr bool m = is_many_body.value, d = is_damped.value, o = is_shared.value;
        volumes_done = done_before;
        switch (virial) {
        case Virial::none:
          bond_lanes<S, m, d, o, Virial::none>(network, a, p, lane, range, volumes_done, sums);
          break;
        case Virial::trace: // as a part of the full tensor for laws with a memory: one loop less to compile
          bond_lanes<S, m, d, o, remembers<Law> ? Virial::full : Virial::trace>(network, a, p, lane, range,
                                                                                volumes_done, sums);
          break;
        case Virial::full:
          bond_lanes<S, m, d, o, Virial::full>(network, a, p, lane, range, volumes_done, sums);
          break;
        }
      });
    });
  });
}

template <class S, bool many_body, bool damped, class Law, class Coordinate = typename S::Coordinate,
          class Real = typename S::Real>
void lanes_from_before(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a,
                       const BondParametersOf<Law>& p, int lane, const NodeRange& range) {
  using V = typename S::V;
  using P = typename S::P;
  constexpr std::int64_t stride = S::stride;
  const V alpha = load_doubles<V>(a.alpha + lane), q = splat<V>(a.quantum);
  const auto law = p.law.template in<Real>();
  Real* f = a.f + lane;
  for_each_bond_from_before(network, range, [&](std::int64_t i, std::int64_t b) {
    const std::int64_t j = network.bonds[b].other;
    const Triple<V> d = separation<S>(load3<P>(a.x + lane, i, stride), load3<P>(a.x + lane, j, stride));
    Triple<V> vi{}, vj{};
    if constexpr (damped) {
      vi = load3<V>(a.v + lane, i, stride);
      vj = load3<V>(a.v + lane, j, stride);
    }
    V volumes{};
    if constexpr (many_body) {
      volumes = load<V>(a.volume + lane + i * stride) + load<V>(a.volume + lane + j * stride);
    }
    V s;
    if constexpr (remembers<Law>) {
      V rest_volumes{};
      Remembered<V, Law::n_remembered> memory = remembered<S, Law>(a.memory + lane, b);
      if constexpr (many_body) {
        rest_volumes = rest_volumes_of<S>(a, lane, i, j);
      }
      s = remembering_scale<S, many_body>(network.bonds[b], d, dot(d, d), q, vi, vj, volumes, rest_volumes, alpha, law,
                                          memory);
    } else {
      s = bond_scale<S, many_body, damped>(network.bonds[b], d, dot(d, d), q, vi, vj, volumes, alpha, law);
    }
    add_to_second(f, j, stride, s, d);
  });
}

template <class Coordinate, class Real, class Law>
void bond_forces_from_before(const NetworkOf<Real>& network, const BlockArraysOf<Coordinate, Real>& a,
                             const BondParametersOf<Law>& p, bool many_body, const NodeRange& range) {
  with_variant<Law>(many_body, p.law, [&](auto is_many_body, auto is_damped) {
    for_lanes<Coordinate>(a.n_lanes, [&](int lane, auto storage) {
      lanes_from_before<decltype(storage), is_many_body.value, is_damped.value>(network, a, p, lane, range);
    });
  });
}

} // namespace
} // namespace boba::kernels

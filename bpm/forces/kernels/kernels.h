// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/bond.h"
#include "bpm/laws/breaking.h"
#include "bpm/laws/contact.h"
#include "bpm/laws/hertz.h"
#include "bpm/laws/yielding.h"
#include "bpm/packing/max_lanes.h"

#include <compare>
#include <cstdint>

// The hot loops as plain functions on raw arrays, compiled once for each instruction set (kernels.cpp) and reached
// through a table of pointers. Only this header knows them both; it must stay free of library types, so that no inline
// function of a library is compiled for a machine that cannot run it.

namespace boba::kernels {

// Every kernel of the lane arrays exists for two ways to store them:
//   double: positions, velocities and forces are doubles;
//   mixed:  positions are 32-bit integers, multiples of a quantum from the grain's origin; the rest are floats.
// `Coordinate` is the type of a position's component (double, std::int32_t), `Real` that of the rest (double, float).

/// One bond as the hot loop reads it: grouped by its first node.
template <class Real> struct BondRecordOf {
  Real r0, inverse_r0, inverse_volume; ///< d, 1/d, 1 / (V0_i + V0_j) in 1/d^3
  std::int32_t other;                  ///< the second node, larger than the first
};
using BondRecord = BondRecordOf<double>;

template <class Real> struct NetworkOf {
  int n_nodes;
  const std::int64_t* first_bond; ///< n_nodes + 1
  const BondRecordOf<Real>* bonds;
  const std::int64_t* reach; ///< per node i: 1 + the last node that a bond of any node up to i joins
};
using Network = NetworkOf<double>;

/// Nodes whose volumes are computed at a go, beyond what the forces need next.
inline constexpr std::int64_t volume_chunk = 64;

/// Forces are added to what `f` holds (contacts come first). Arrays start at the block; `volume` is scratch
/// [node][lane] that holds the volumes of bonds evaluated elsewhere (images), usually zero.
template <class Coordinate, class Real> struct BlockArraysOf {
  Coordinate* x;
  Real *v, *f, *volume;
  const double* alpha;          ///< per lane
  const double* residual_shift; ///< per lane, see BondParameters
  double quantum;               ///< d, a power of two; not read when coordinates are doubles
  int n_lanes;
  /// Forces and volumes of a node are zero when nobody needs them any more, ready for the next step; else they stay.
  bool leaves_zeros = false;
  /// Velocities of the nodes from NodeRange::own_end on, as they were before another thread kicked them; null: all
  /// nodes are the call's own.
  const Real* v_beyond = nullptr;
  /// What the bonds of laws with a memory remember, [bond][number][lane], and whether a pass may change that; their V0
  /// are scratch like `volume`.
  Real *memory = nullptr, *rest_volume = nullptr;
  bool keeps_memory = false;
};
using BlockArrays = BlockArraysOf<double, double>;

/// Nodes [begin, end) of a block. The nodes of several ranges may be dealt with at the same time by several threads:
/// what a call adds to a node is added in the same order as by one call for all nodes, and to nodes before `own_end`
/// alone.
struct NodeRange {
  int begin, end;
  int own_end; ///< bonds to nodes from here on are another's to add there
};

/// What a pass over the bonds needs to know beside the network and its state. `Law` is a bond law with double
/// constants, such as BondLaw.
template <class Law> struct BondParametersOf {
  Law law;
  double kick;      ///< v += kick f, once a node's force is complete: dt/m, dt/2m at the start, 0 to look only
  double half_kick; ///< full-step velocity = v + half_kick f, for the kinetic part of the stress
  double mass;
  /// Streaming velocity along x, not counted as kinetic: residual . x + the lane's shift, x as the arrays hold it.
  double residual[3];
};
using BondParameters = BondParametersOf<BondLaw>;

/// How much of the virial and the kinetic tensor a pass sums up.
enum class Virial { none, trace, full };

/// Per lane of a block. Virial: sum of r_ij f_ij (compression positive); kinetic: sum of m v v. Order xx yy zz xy xz yz
/// trace; with Virial::trace only the last is summed up.
struct LaneSums {
  double virial[7][max_lanes];
  double kinetic[7][max_lanes];
  std::int64_t n_broken; ///< registers in which bonds broke; of laws with a memory alone
};

struct Drift {
  double dt;
  double map[3][3], shift[3]; ///< x <- map x + shift + dt v
  bool mapped;                ///< false: map is the identity and skipped
  /// The cell's motion along x that does not act on positions, to be taken from velocities before their size is
  /// measured: u_x = v_x - (residual . x + residual_shift).
  double residual[3], residual_shift;
  double quantum;               ///< d; mixed only
  std::uint64_t dither_seed;    ///< another one each step; mixed only
  int first_node;               ///< number of the first node in its grain; mixed only
  double lane_shift[max_lanes]; ///< residual_shift, with the lane's origin; mixed only
  /// Numbers, from the first node of the call on, of nodes with any lane faster than sqrt(fast_speed2) are written
  /// here, a node once for every register of its lanes at most; null: nobody asks.
  std::int32_t* fast;
  double fast_speed2; ///< of u, d^2/tau^2
};

/// What a drift saw: enough to know how long a contact list stays valid and whether the run has blown up.
struct DriftResult {
  double largest_speed2; ///< of u, d^2/tau^2
  double checksum;       ///< a sum of all v^2: not finite when any velocity is not
  std::int32_t n_fast;   ///< how many were written down
};

/// Position and velocity of a node that may touch another, copied together onto one cache line before the contact pass:
/// in the lane layout they are spread over six.
struct alignas(64) ContactNode {
  double x[3], v[3];
  double filling[2]; ///< 0: loops read the whole line as one vector
};

/// A candidate contact: a node of each of two grains.
struct NodePair {
  std::int32_t i, j;
  auto operator<=>(const NodePair&) const = default;
};

/// A contact and the force on node i of the first grain; node j of the second feels the opposite.
struct Touch {
  NodePair nodes;
  double force[3];
};

/// Candidates between two grains (or inside one), whose second is seen displaced by a lattice vector.
struct ContactCandidates {
  const NodePair* pairs;
  std::int64_t n;
  const ContactNode *first, *second;  ///< node 0 of each grain
  double shift[3], shift_velocity[3]; ///< what to add to the second grain's positions and velocities
};

/// Touches and rows that a loop over n candidates may write: one beyond, rounded up to full registers.
inline constexpr std::int64_t touch_capacity(std::int64_t n_candidates) {
  return n_candidates + 16;
}

/// Over the contacts of one pair of grains; both have half of the virial.
struct ContactSums {
  double virial[6];   ///< xx yy zz xy xz yz, k d^2
  double smallest_r2; ///< d^2
  double potential;   ///< k d^2
  std::int64_t n_touching;
};

/// Three components and a zero, which loops read as one vector.
struct alignas(32) PointRow {
  double x[4];
};

/// Candidates of grains of one node each. Those of node i are [first[i], first[i + 1]); each pair of nodes is there
/// twice, so that every node sums the forces on itself.
struct PointCandidates {
  const std::int32_t* first;
  const std::int32_t* other;                    ///< per candidate: the second node
  const std::int32_t* image;                    ///< per candidate: its lattice vector
  const PointRow *x, *v;                        ///< of all nodes, which `other` counts
  const PointRow *image_shift, *image_velocity; ///< lattice vectors and how they move
  std::int32_t begin;                           ///< number of node 0 of `first`
  std::int32_t n_nodes;
};

/// What the contacts of a node give it.
struct PointSums {
  double force[3];      ///< k d
  ContactSums contacts; ///< of its sides; where asked for
};

/// How the contacts of nodes are summed up.
struct PointSumming {
  bool in_floats = false; ///< the forces, as those of other grains in mixed precision
  bool with_contacts = false;
};

/// What the pass over candidates writes meanwhile.
struct PointScratch {
  double* terms;          ///< point_terms times `stride` of them
  std::int64_t stride;    ///< at least touch_capacity(candidates)
  std::int32_t* touching; ///< as many
  std::int32_t* last;     ///< one for each node
};
/// What a touch adds, component by component: three of the force, six of the virial, energy and r^2.
inline constexpr int point_terms = 11;

/// Positions of a block and the places of its nodes in their grains' frames, [node][component][lane].
template <class Coordinate> struct FrameArraysOf {
  const Coordinate* x;
  const float* reference;
  int n_nodes, n_lanes;
  double quantum; ///< d; mixed only
};

/// Per lane: a point near the grain, and sums of x - origin and of (x - origin) (x) reference, row by row.
struct FrameFit {
  double origin[3][max_lanes];
  double first[3][max_lanes];
  double second[9][max_lanes];
};

/// Per lane: x = f X + centre, and the square of the distance above which a node counts as far.
struct LaneFrames {
  double f[9][max_lanes], centre[3][max_lanes];
  double threshold2[max_lanes];
};

/// Nodes of one grain, sorted by cell; columns of coordinates, d.
struct SortedNodes {
  const float *x, *y, *z;
};

/// Some of them that stand side by side.
struct PlaceRange {
  std::int32_t begin, end;
};

/// The passes over the bonds of a law with a memory; as those of LaneKernels.
template <class Coordinate, class Real, class Law> struct RememberingKernels {
  /// Of the bonds that are whole; V0 too.
  void (*volumes)(const NetworkOf<Real>&, const BlockArraysOf<Coordinate, Real>&, const NodeRange&);
  void (*bonds)(const NetworkOf<Real>&, const BlockArraysOf<Coordinate, Real>&, const BondParametersOf<Law>&,
                bool many_body, Virial, const NodeRange&, std::int64_t& volumes_done, LaneSums&);
  void (*bonds_from_before)(const NetworkOf<Real>&, const BlockArraysOf<Coordinate, Real>&,
                            const BondParametersOf<Law>&, bool many_body, const NodeRange&);
};

/// The kernels that walk through lane arrays.
template <class Coordinate, class Real> struct LaneKernels {
  /// volume[node][lane] += r^3 of every bond, for the nodes of a range.
  void (*volumes)(const NetworkOf<Real>&, const BlockArraysOf<Coordinate, Real>&, const NodeRange&);
  /// Adds the forces of the bonds of a range's nodes with later ones, and kicks these nodes, whose forces are then
  /// complete. Volumes of nodes from `volumes_done` on are computed as far as they are needed, which it says
  /// afterwards.
  void (*bonds)(const NetworkOf<Real>&, const BlockArraysOf<Coordinate, Real>&, const BondParameters&, bool many_body,
                Virial, const NodeRange&, std::int64_t& volumes_done, LaneSums&);
  /// Adds to a range's nodes the forces of their bonds with nodes before the range. Volumes must be known.
  void (*bonds_from_before)(const NetworkOf<Real>&, const BlockArraysOf<Coordinate, Real>&, const BondParameters&,
                            bool many_body, const NodeRange&);
  RememberingKernels<Coordinate, Real, BreakingBondLaw> breaking;
  RememberingKernels<Coordinate, Real, YieldingBondLaw> yielding;
  DriftResult (*drift)(Coordinate* x, const Real* v, int n_nodes, int n_lanes, const Drift&);
  /// to[node] of every listed node of one grain: its position (origin + what the arrays hold) and velocity.
  void (*collect)(const std::int32_t* nodes, std::int64_t n, const Coordinate* x, const Real* v, int stride,
                  const double* origin, double quantum, ContactNode* to);
  /// Adds sign times the forces to node i (sign = 1) or j (-1) of a grain's lane.
  void (*add_touches)(const Touch* touches, std::int64_t n, double sign, Real* f, int stride);
  /// Sums over the nodes of a block for the frames of its grains.
  void (*fit_frames)(const FrameArraysOf<Coordinate>&, FrameFit&);
  /// Distances of nodes from where their frames put them: the largest below the lane's threshold, and the places
  /// node * n_lanes + lane above it, which are written into `far` (room for all); returns their number.
  std::int64_t (*frame_residuals)(const FrameArraysOf<Coordinate>&, const LaneFrames&, double* largest2,
                                  std::int32_t* far);
};

/// Numbers that near_places may write beyond those it returns.
inline constexpr int near_padding = 16;

/// Writes the contacts among the candidates into `touches` and returns their number. `rows` is scratch; both have
/// room for touch_capacity(candidates).
template <class Law>
using ContactKernel = std::int64_t (*)(const ContactCandidates&, const Law&, ContactNode* rows, Touch* touches,
                                       ContactSums&);

/// The same for grains of one node: sums of each, to the last bit as if its pairs were evaluated one by one.
template <class Law>
using PointContactKernel = void (*)(const PointCandidates&, const Law&, const PointSumming&, const PointScratch&,
                                    PointSums* sums);

struct KernelTable {
  const char* name; ///< "avx512", "avx2" or "baseline"
  LaneKernels<double, double> precise;
  LaneKernels<std::int32_t, float> mixed;
  /// Writes the candidates closer than sqrt(reach2) into `near` (room for one more than all of them), in their order,
  /// and returns their number.
  std::int64_t (*near_candidates)(const ContactCandidates&, double reach2, NodePair* near);
  ContactKernel<ContactLaw> contacts;
  ContactKernel<HertzLaw> hertz_contacts;
  PointContactKernel<ContactLaw> point_contacts;
  PointContactKernel<HertzLaw> hertz_point_contacts;
  /// Writes the places of some ranges closer than sqrt(reach2) to p into `found`, range by range and ascending, and
  /// returns their number. `found` has room for near_padding more numbers than there are places. Coordinates are
  /// rounded to floats.
  std::int32_t (*near_places)(const SortedNodes&, const PlaceRange* ranges, int n_ranges, const double* p,
                              double reach2, std::int32_t* found);
};

extern const KernelTable avx512_table;
extern const KernelTable avx2_table;
extern const KernelTable baseline_table;

/// The table for the widest instruction set this machine has; BOBA_ISA=baseline|avx2|avx512 in the environment chooses
/// a narrower one.
const KernelTable& best_table();

} // namespace boba::kernels

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

// The hot loops as plain functions on raw arrays, compiled once for each instruction set (kernels.cpp) and reached through
// a table of pointers. Only this header knows them both; it must stay free of library types, so that no inline function of
// a library is compiled for a machine that cannot run it.

namespace boba::kernels {

/// One bond as the hot loop reads it: grouped by its first node.
struct BondRecord {
  double r0, inverse_r0, inverse_volume; ///< d, 1/d, 1 / (V0_i + V0_j) in 1/d^3
  std::int64_t other;                    ///< the second node, larger than the first
};

struct Network {
  int n_nodes;
  const std::int64_t* first_bond; ///< n_nodes + 1
  const BondRecord* bonds;
  const std::int64_t* reach; ///< per node i: 1 + the last node that a bond of any node up to i joins
};

/// Nodes whose volumes are computed at a go, beyond what the forces need next.
inline constexpr std::int64_t volume_chunk = 64;

/// Forces are added to what `f` holds (contacts come first). Arrays start at the block; `volume` is scratch
/// [node][lane] that holds the volumes of bonds evaluated elsewhere (images), usually zero.
struct BlockArrays {
  double *x, *v, *f, *volume;
  const double* alpha; ///< per lane
  int n_lanes;
};

struct BondParameters {
  double k, gamma;
  double kick;         ///< v += kick f, once a node's force is complete: dt/m, dt/2m at the start, 0 to look only
  double half_kick;    ///< full-step velocity = v + half_kick f, for the kinetic part of the stress
  double mass;
  double residual[3], residual_shift; ///< streaming velocity along x: residual . x + residual_shift, not counted as kinetic
};

/// How much of the virial and the kinetic tensor a pass sums up.
enum class Virial { none, trace, full };

/// Per lane of a block. Virial: sum of r_ij f_ij (compression positive); kinetic: sum of m v v. Order xx yy zz xy xz yz
/// trace; with Virial::trace only the last is summed up.
struct LaneSums {
  double virial[7][8];
  double kinetic[7][8];
};

struct Drift {
  double dt;
  double map[3][3], shift[3]; ///< x <- map x + shift + dt v
  bool mapped;                ///< false: map is the identity and skipped
  /// The cell's motion along x that does not act on positions, to be taken from velocities before their size is
  /// measured: u_x = v_x - (residual . x + residual_shift).
  double residual[3], residual_shift;
};

/// What a drift saw: enough to know how long a contact list stays valid and whether the run has blown up.
struct DriftResult {
  double largest_speed2; ///< of u, d^2/tau^2
  double checksum;       ///< a sum of all v^2: not finite when any velocity is not
};

/// Position and velocity of a node that may touch another, copied together on one cache line before the contact pass: in
/// the lane layout they are spread over six.
struct alignas(64) ContactNode {
  double x[3], v[3];
};

/// Force of all contacts of one node, k d.
struct ContactForce {
  double f[3];
};

/// Where a contact node comes from: `from` counts numbers of a lane array to its x component.
struct ContactSource {
  std::int32_t from, slot;
};

/// Candidate contacts of one grain, sorted by own node. `own` and `other` are slots of ContactNode.
struct ContactRows {
  std::int64_t n;
  const std::int32_t* own;
  const std::int32_t* other;
  const std::int32_t* image; ///< index into the shift tables
};

struct ContactParameters {
  double k, k3, gamma, diameter;
  const double* shift;          ///< [image][3]: what to add to the other node's position
  const double* shift_velocity; ///< [image][3]
};

/// Half of each pair's virial belongs to this side. `potential` is half the pairs' energy.
struct ContactSums {
  double virial[6];
  double smallest_r2;
  double potential;
  std::int64_t n_touching;
};

/// Nodes of one grain, sorted by cell; columns of coordinates, d.
struct SortedNodes {
  const double *x, *y, *z;
};

struct KernelTable {
  const char* name; ///< "avx512", "avx2" or "baseline"
  int lanes;
  /// volume[node][lane] += r^3 of every bond, at both of its nodes.
  void (*volumes)(const Network&, const double* x, double* volume, int n_lanes);
  void (*bonds)(const Network&, const BlockArrays&, const BondParameters&, bool many_body, Virial, LaneSums&);
  DriftResult (*drift)(double* x, const double* v, int n_nodes, int n_lanes, const Drift&);
  /// nodes[slot] of every source: its position and velocity from arrays whose components are `stride` apart.
  void (*collect)(const ContactSource* sources, std::int64_t n, const double* x, const double* v, int stride,
                  ContactNode* nodes);
  /// Sums the contact forces of one grain into force[own slot], which must be zero before. `scratch` holds at least rows.n
  /// doubles and rows.n ints.
  void (*contacts)(const ContactRows& rows, const ContactNode* nodes, ContactForce* force, const ContactParameters&,
                   double* scratch, std::int32_t* scratch_index, bool with_sums, ContactSums&);
  /// Adds force[slot] of every source to where it came from.
  void (*scatter)(const ContactSource* sources, std::int64_t n, const ContactForce* force, double* f, int stride);
  /// Writes the places in [begin, end) closer than sqrt(reach2) to p into `found`, ascending, and returns their number.
  /// `found` has room for end - begin + 8 numbers.
  std::int32_t (*near_places)(const SortedNodes&, std::int32_t begin, std::int32_t end, const double* p, double reach2,
                              std::int32_t* found);
};

extern const KernelTable avx512_table;
extern const KernelTable avx2_table;
extern const KernelTable baseline_table;

/// The table for the widest instruction set this machine has; BOBA_ISA=baseline|avx2|avx512 in the environment chooses a
/// narrower one.
const KernelTable& best_table();

} // namespace boba::kernels

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/material.h"
#include "bpm/measure/grain_nodes.h"
#include "bpm/parallel/ranks.h"

#include <array>
#include <vector>

namespace boba::measure {

/// Two grains that touch: at least one node of the one is closer than the range of the contact law to a node of the
/// other.
struct GrainContact {
  int grain = 0, other = 0;         ///< grain <= other; equal when a grain touches its own image
  std::array<int, 3> image{};       ///< the other grain's copy is displaced by h image
  Vector3 branch = Vector3::Zero(); ///< from the grain's centre to that copy's centre, d
  Vector3 force = Vector3::Zero();  ///< on `grain` from `other`, elastic part, k d
  Vector3 normal = Vector3::Zero(); ///< unit, from `grain` towards `other`: against the force
  Vector3 point = Vector3::Zero();  ///< mean of the touching pairs' midpoints, d
  double area = 0.0;                ///< d^2
  double largest_overlap = 0.0;     ///< of a node pair, d
  int n_pairs = 0;                  ///< touching node pairs
};

/// All contacts between grains, ordered by grain, other grain and image; each once.
///
/// Force: sum over the touching node pairs of f(r) e, f the contact law at rest; damping is left out, since stored
/// frames need not hold velocities. Area: the midpoints of the pairs are projected along the normal, and the hull of
/// discs of diameter d around them is taken, A = A_hull + L_hull d/2 + pi d^2/4 (one pair alone: the disc). \param
/// ranks collective: all call it alike, each finds the contacts of its own grains (DealtItems), and all have all
/// \throws std::invalid_argument for a contact distance that is not positive.
/// Source: docs/formats-measure.md, "Contact network"; force: bpm/laws/contact.h.
std::vector<GrainContact> contact_network(const Box& box, const GrainNodes& grains, const Material& material = {},
                                          const Ranks& ranks = Ranks::alone());

/// Numbers of contacts, with and without grains that carry nothing.
struct Coordination {
  std::vector<int> n_contacts;  ///< per grain
  std::vector<char> is_rattler; ///< per grain: fewer than min_contacts, counted again without the rattlers found so far
  double mean = 0.0;            ///< of all grains
  double mean_without_rattlers = 0.0; ///< of the others, contacts with rattlers left out; 0 when all are rattlers
  int n_rattlers = 0;
};

/// \param min_contacts 4: the fewest frictionless contacts that can hold a grain in three dimensions
Coordination coordination(int n_grains, const std::vector<GrainContact>& contacts, int min_contacts = 4);

/// Mean of n n^T over the contacts, trace 1; I/3 for directions without preference. Zero without contacts.
Matrix3 fabric_tensor(const std::vector<GrainContact>& contacts);

/// sqrt(3/2 D : D) of the deviator D of a fabric tensor: 0 isotropic, 1 when all contacts are parallel.
double fabric_anisotropy(const Matrix3& fabric);

} // namespace boba::measure

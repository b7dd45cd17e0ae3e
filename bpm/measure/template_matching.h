// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/neighbours.h"

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace boba::measure {

/// The arrangement of a grain's nearest neighbours. The numbers are those written to files. Simple cubic and
/// icosahedral surroundings are told by name, so that they are never taken for one of the three crystals.
enum class Lattice { unknown = 0, fcc = 1, hcp = 2, bcc = 3, sc = 4, icosahedral = 5 };
constexpr int n_lattices = 6;

std::string_view name_of(Lattice lattice);

struct TemplateOptions {
  double max_rmsd = 0.12;  ///< largest deviation of a grain's neighbours from a template, mean neighbour distances
  double max_shear = 0.15; ///< largest equivalent shear of the best affine map from the template to the neighbours
};

/// How the surroundings of a grain compare with the templates.
struct TemplateMatch {
  Lattice lattice = Lattice::unknown; ///< within both limits, else unknown
  Lattice nearest = Lattice::unknown; ///< the template with the smallest deviation, whatever the limits
  double rmsd = 0.0;                  ///< its deviation, in mean neighbour distances; 0 where `nearest` is unknown
  double shear = 0.0;                 ///< its equivalent shear
};

/// Polyhedral template matching: compares a grain and its nearest neighbours with those of fcc and hcp (12), bcc (14),
/// simple cubic (6) and the icosahedron (12).
///
///     rmsd  = min over s, Q, t and the assignment of sqrt( 1/(N+1) sum_i |s (p_i - t) - Q w_i|^2 ),  i = 0 .. N
///     shear = sqrt( 2 sum_k (ln l_k - mean ln l)^2 ),  l_k the singular values of the best affine map w -> p
///
/// p_0 and w_0 are the grain itself, |w_i| has the mean 1. For a simple shear by a small amount `shear` is that amount;
/// the Bain path from fcc to bcc has the length 0.40. The nearest template counts if both are within the limits: a
/// lattice that is farther from fcc than `max_shear` is as near to another one, and no look at one configuration can
/// tell what it came from.
/// \param neighbours at least as many as there are, sorted by distance (nearest_neighbours); fewer than a template has
/// do not match it
/// Source: Larsen, Schmidt, Schiotz, Modelling Simul. Mater. Sci. Eng. 24, 055007 (2016).
TemplateMatch match_templates(std::span<const Neighbour> neighbours, const TemplateOptions& options = {});

/// The same for every grain. A grain with a periodic copy of itself among the neighbours that a template compares is
/// unknown: what is seen there is the cell, not an arrangement of grains.
/// \throws std::invalid_argument for options that are not positive, and for centres that coincide.
std::vector<TemplateMatch> match_templates(const Box& box, std::span<const Vector3> centres,
                                           const TemplateOptions& options = {});

/// Number of grains of each lattice, indexed by Lattice.
std::array<int, n_lattices> count_lattices(const std::vector<TemplateMatch>& matches);

} // namespace boba::measure

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/contact/interface_law.h"

#include <Eigen/Core>
#include <stdexcept>
#include <vector>

namespace boba::continuum {

/// A contact problem condensed on its own unknowns: the pressures p_i >= 0 of the candidate nodes.
///
///     o = o_0 - A p                    area-weighted overlap with the plate that is left over
///     p_i > 0:  o_i = D_i g(p_i)       the overlap that the interface carries (0 for a rigid one)
///     p_i = 0:  o_i <= 0
struct CondensedContact {
  /// A: weighted approach of node i under unit pressure at j; symmetric positive definite.
  Eigen::MatrixXd compliance;
  /// D: area of the nodes.
  Eigen::VectorXd area;
  /// o_0: weighted overlap of the unpressed body.
  Eigen::VectorXd overlap;
};

struct ContactSolution {
  Eigen::VectorXd pressure;
  std::vector<bool> active;
  int iterations = 0;
};

/// An iteration that did not settle; the message holds the last residuals.
class NotSettled : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Changes of the active set after which the search is given up.
constexpr int most_active_sets = 200;

/// Primal-dual active set (a semi-smooth Newton method) from a first guess of the active nodes.
///
/// When a set comes back without being a solution the search goes on by single exchanges of least index, which ends
/// for every positive definite A (Murty 1974). Throws NotSettled after max_iterations.
/// Source: Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003) 865; Murty, Opsearch 11 (1974) 138.
ContactSolution solve(const CondensedContact& problem, const InterfaceLaw& interface, std::vector<bool> active,
                      int max_iterations = most_active_sets);

/// Numbers of the nodes that are marked.
std::vector<Eigen::Index> active_nodes(const std::vector<bool>& active);

} // namespace boba::continuum

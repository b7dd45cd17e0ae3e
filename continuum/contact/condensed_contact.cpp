// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/contact/condensed_contact.h"

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <set>

namespace boba::continuum {
namespace {

using Eigen::Index;

/// Largest |D g(p) + A p - o_0| over the active nodes.
double residual(const CondensedContact& problem, const InterfaceLaw& interface, const std::vector<Index>& nodes,
                const Eigen::VectorXd& p) {
  double worst = 0;
  for (const Index i : nodes) {
    const double left = problem.area[i] * interface.overlap(p[i]) + problem.compliance.row(i).dot(p);
    worst = std::max(worst, std::abs(left - problem.overlap[i]));
  }
  return worst;
}

/// Pressures with the given active nodes, by Newton's method on D g(p) + A p = o_0 (one step when g is linear).
Eigen::VectorXd solve_equalities(const CondensedContact& problem, const InterfaceLaw& interface,
                                 const std::vector<Index>& nodes, Eigen::VectorXd p) {
  const double goal = 1e-13 * (problem.overlap.cwiseAbs().maxCoeff() + 1e-300);
  const bool linear = interface.rigid() || interface.c3 == 0;
  for (int step = 0; step < 50; ++step) {
    Eigen::MatrixXd jacobian = problem.compliance(nodes, nodes);
    Eigen::VectorXd rhs(Index(nodes.size()));
    for (Index k = 0; k < rhs.size(); ++k) {
      const Index i = nodes[std::size_t(k)];
      jacobian(k, k) += problem.area[i] * interface.softness(p[i]);
      rhs[k] = problem.overlap[i] - problem.area[i] * interface.overlap(p[i]) - problem.compliance.row(i).dot(p);
    }
    const Eigen::VectorXd change = jacobian.llt().solve(rhs);
    for (Index k = 0; k < rhs.size(); ++k) {
      p[nodes[std::size_t(k)]] += change[k];
    }
    if (linear || change.norm() <= 1e-14 * p.norm() || residual(problem, interface, nodes, p) <= goal) {
      return p;
    }
  }
  throw NotSettled(fmt::format("the contact pressures did not settle in 50 Newton steps: residual {:.3e} (goal {:.3e})",
                               residual(problem, interface, nodes, p), goal));
}

/// Nodes whose state contradicts the solution: pressed ones that pull, free ones that overlap.
std::vector<std::size_t> contradictions(const CondensedContact& problem, const std::vector<bool>& active,
                                        const Eigen::VectorXd& p) {
  const Eigen::VectorXd overlap = problem.overlap - problem.compliance * p;
  const double slack = 1e-13 * problem.overlap.cwiseAbs().maxCoeff();
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (active[i] ? p[Index(i)] < 0 : overlap[Index(i)] > slack) {
      result.push_back(i);
    }
  }
  return result;
}

} // namespace

std::vector<Index> active_nodes(const std::vector<bool>& active) {
  std::vector<Index> result;
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (active[i]) {
      result.push_back(static_cast<Index>(i));
    }
  }
  return result;
}

ContactSolution solve(const CondensedContact& problem, const InterfaceLaw& interface, std::vector<bool> active,
                      int max_iterations) {
  std::set<std::vector<bool>> seen;
  bool single = false;
  Eigen::VectorXd p = Eigen::VectorXd::Zero(problem.area.size());
  std::vector<std::size_t> wrong;
  for (int iteration = 1; iteration <= max_iterations; ++iteration) {
    for (std::size_t i = 0; i < active.size(); ++i) {
      p[Index(i)] = active[i] ? std::max(p[Index(i)], 0.) : 0.;
    }
    p = solve_equalities(problem, interface, active_nodes(active), p);
    wrong = contradictions(problem, active, p);
    if (wrong.empty()) {
      return {p, active, iteration};
    }
    single = single || !seen.insert(active).second;
    for (const auto i : wrong) {
      active[i] = !active[i];
      if (single) {
        break;
      }
    }
  }
  throw NotSettled(fmt::format("the active set did not settle in {} iterations: {} nodes contradict it, lowest "
                               "pressure {:.3e}, largest overlap {:.3e}",
                               max_iterations, wrong.size(), p.minCoeff(),
                               (problem.overlap - problem.compliance * p).maxCoeff()));
}

} // namespace boba::continuum

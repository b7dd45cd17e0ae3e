// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/grain_nodes.h"
#include "bpm/measure/reciprocal_lattice.h"
#include "bpm/parallel/ranks.h"

#include <vector>

namespace boba::measure {

struct ScatteringOptions {
  double q_max = 1.0;       ///< 1/d
  double shell_width = 0.0; ///< 1/d; 0 means 2 pi / V^(1/3), which is the same for all cells of one lattice
};

/// Averages over the wave vectors with |q| nearest to a multiple of the shell width.
struct ScatteringShell {
  double q = 0.0;             ///< mean |q|, 1/d
  std::int64_t n_vectors = 0; ///< wave vectors in the shell, q and -q both counted
  double intensity = 0.0;     ///< I: 1/N |sum over all nodes of exp(i q.r)|^2, mean of the shell
  double form_factor = 0.0; ///< P_F: mean over grains of 1/N_k |sum over its nodes of exp(i q.r)|^2, mean of the shell
  double structure = 0.0;   ///< S = I / P_F; not a number where P_F is 0
};

/// I and P_F at every wave vector of `lattice`, in its order.
struct ScatteringAmplitudes {
  std::vector<double> intensity, form_factor;
};

/// Sums at every wave vector of the half lattice, by whichever of the two ways takes fewer products: the non-uniform
/// transform of each grain (`SpectrumPlan`, relative error 1e-10), or for small grains and few wave vectors the exact
/// sums.
///
/// Grains are summed in their order: the result does not depend on the number of threads and ranks.
/// \param ranks collective: all call it alike with all nodes, each sums at its own wave vectors (DealtItems), and all
/// have the result; so below
/// Source: docs/notation.md, "form factor"; "scattering, structure factor"; docs/performance-measure.md.
ScatteringAmplitudes scattering_amplitudes(const Box& box, const GrainNodes& grains, const ReciprocalLattice& lattice,
                                           const Ranks& ranks = Ranks::alone());

/// The same by the non-uniform transform. Each rank spreads its own grains' nodes, and all know their grids.
ScatteringAmplitudes transformed_amplitudes(const Box& box, const GrainNodes& grains, const ReciprocalLattice& lattice,
                                            const Ranks& ranks = Ranks::alone());

/// The same by exact sums.
///
/// The phases run along each row by recurrence, exp(i q(n3 + 1).r) = exp(i q(n3).r) exp(i b3.r), in the vector unit;
/// cost: (number of nodes) x (number of wave vectors). The sums are formed in grain order: the result does not depend
/// on the number of threads and ranks.
ScatteringAmplitudes summed_amplitudes(const Box& box, const GrainNodes& grains, const ReciprocalLattice& lattice,
                                       const Ranks& ranks = Ranks::alone());

/// P_F, I and S = I / P_F on the reciprocal lattice of the box up to q_max, averaged in shells of |q|.
///
/// A shell's S is the ratio of its mean I to its mean P_F (P_F alone has zeros). Shells without wave vectors are left
/// out. As q -> 0, P_F -> N (nodes per grain); at large q P_F -> 1 for nodes without order.
/// \throws std::invalid_argument for options out of range or a box that is not periodic.
/// Source: docs/notation.md, "scattering, structure factor".
std::vector<ScatteringShell> scattering(const Box& box, const GrainNodes& grains, const ScatteringOptions& options,
                                        const Ranks& ranks = Ranks::alone());

/// Averages given amplitudes in shells.
std::vector<ScatteringShell> shell_average(const Box& box, const ReciprocalLattice& lattice,
                                           const ScatteringAmplitudes& amplitudes, double shell_width = 0.0);

/// 1/N |sum exp(i q.r)|^2 by the definition, node by node: the oracle of the fast sums.
double direct_intensity(std::span<const Vector3> nodes, const Vector3& q);

/// Form factor of a uniform ball per node, P_F/N = [3 (sin x - x cos x)/x^3]^2 with x = q R; 1 at x = 0.
double ball_form_factor(double q, double radius);

} // namespace boba::measure

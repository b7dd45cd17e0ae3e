// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// Constants that bonds and contacts of every grain share. In the engine's units k = gamma = 1 and k3 = 50.
/// The many-body coefficient alpha belongs to the grain (its species), not to this struct.
/// Source: Clemmer, Hackney & Grest, bond force; docs/notation.md, "Forces".
struct Material {
  double k = 1.0;             ///< bond and contact stiffness, k
  double gamma = 1.0;         ///< damping of bonds and contacts, sqrt(k m)
  double k3 = 50.0;           ///< cubic contact repulsion, k/d^2
  double hertz_modulus = 0.0; ///< above 0: contacts follow Hertz's law with this E_eff instead of k and k3, k/d
  double node_mass = 1.0;     ///< m
  double diameter = 1.0;      ///< contact distance of two nodes, d
};

} // namespace boba

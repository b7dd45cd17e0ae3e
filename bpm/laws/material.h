// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/bond.h"
#include "bpm/laws/contact.h"

#include <string>
#include <vector>

namespace boba {

/// Constants that bonds and contacts of every grain share, and which contact law holds.
/// The many-body coefficient alpha belongs to the grain (its species), not to this struct.
/// Source: Clemmer, Hackney & Grest, bond force; docs/notation.md, "Forces".
struct Material {
  double k = BondLaw::k_parameter.usual;         ///< bond and contact stiffness, k
  double gamma = BondLaw::gamma_parameter.usual; ///< damping of bonds and contacts, sqrt(k m)
  double k3 = ContactLaw::k3_parameter.usual;    ///< cubic contact repulsion of the law "hookean", k/d^2
  double node_mass = 1.0;                        ///< m
  double diameter = 1.0;                         ///< contact distance of two nodes, d
  std::string contact = ContactLaw::name;        ///< name of the contact law, see forces/contact_laws.h
  std::vector<double> contact_parameters;        ///< values of the parameters of that law which are not named above
};

/// The bond law with a material's constants.
inline BondLaw bond_law(const Material& material) {
  return {material.k, material.gamma};
}

} // namespace boba

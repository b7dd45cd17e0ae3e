// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/bond.h"
#include "bpm/laws/contact.h"
#include "bpm/laws/parameter.h"

#include <array>
#include <optional>
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
  std::optional<double> contact_diameter;        ///< the same of nodes of different grains; absent: `diameter`
  std::string contact = ContactLaw::name;        ///< name of the contact law, see forces/contact_laws.h
  std::array<double, 3> gravity{};               ///< acceleration of every node, d/tau^2
  std::vector<double> contact_parameters;        ///< values of the parameters of that law which are not named above
};

/// Contact distance of nodes of different grains, d. Above `diameter` the grains' surfaces are smoother, since the
/// bumps of single nodes overlap more; the stiffness k of a contact of two nodes stays as it is.
inline constexpr Parameter contact_diameter_parameter = {
    "contact_diameter",
    "d",
    1.0,
    1.5,
    false,
    1.0,
    "distance at which nodes of different grains touch, and twice that at which a node touches a wall; k and k3 are "
    "not scaled"};

/// The constants that hold between different grains, and between grains and walls.
inline Material between_grains(Material material) {
  material.diameter = material.contact_diameter.value_or(material.diameter);
  return material;
}

/// The bond law with a material's constants.
inline BondLaw bond_law(const Material& material) {
  return {material.k, material.gamma};
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
// For a program that brings a contact law of its own. Include this in one source file of that program, written for the
// instruction set that its compiler flags say; nothing in the tree includes it.
#pragma once

#include "bpm/forces/contact_laws.h"
#include "bpm/forces/kernels/point_kernel.h"

#include <utility>

namespace boba {

/// Makes the kernel of a law and lets scenes choose it by `[material] contact = "NAME"` with `parameters` as keys.
///
///     boba::add_contact_law<Adhesive>("adhesive", {{"well", "k d", 0.0, 1.0, false, 0.0, "depth of the well"}},
///                                     [](const boba::Material& m) { return Adhesive{m.k, m.contact_parameters[0]}; });
///
/// `Law` has range, force, slopes and energy as boba::ContactLaw does, for double and for vectors of doubles.
/// \throws std::invalid_argument when the name or a key is taken.
template <class Law>
void add_contact_law(std::string name, std::vector<Parameter> parameters, std::function<Law(const Material&)> make) {
  add_contact_law({.name = std::move(name),
                   .parameters = std::move(parameters),
                   .make = [make = std::move(make)](const Material& material) {
                     return std::make_shared<const ContactModelOf<Law>>(make(material), &kernels::contact_forces<Law>,
                                                                        &kernels::point_contact_forces<Law>);
                   }});
}

} // namespace boba

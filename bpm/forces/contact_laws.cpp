// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/contact_laws.h"

#include "bpm/laws/hertz.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>

namespace boba {

namespace {

std::vector<ContactLawEntry>& mutable_contact_laws() {
  // k3 is a member of Material, not one of contact_parameters.
  static std::vector<ContactLawEntry> laws = {
      {.name = ContactLaw::name,
       .parameters = {},
       .make =
           [](const Material& m) {
             const ContactLaw law{.k = m.k, .gamma = m.gamma, .k3 = m.k3, .diameter = m.diameter};
             const kernels::KernelTable& table = kernels::best_table();
             return std::make_shared<const ContactModelOf<ContactLaw>>(law, table.contacts, table.point_contacts);
           }},
      {.name = HertzLaw::name,
       .parameters = {HertzLaw::modulus_parameter},
       .for_spheres = true,
       .make =
           [](const Material& m) {
             const HertzLaw law{.modulus = m.contact_parameters[0], .gamma = m.gamma, .diameter = m.diameter};
             const kernels::KernelTable& table = kernels::best_table();
             return std::make_shared<const ContactModelOf<HertzLaw>>(law, table.hertz_contacts,
                                                                     table.hertz_point_contacts);
           }},
  };
  return laws;
}

bool is_taken(const std::string& parameter) {
  const auto has = [&](const ContactLawEntry& law) {
    return std::any_of(law.parameters.begin(), law.parameters.end(),
                       [&](const Parameter& p) { return parameter == p.name; });
  };
  const std::vector<ContactLawEntry>& laws = contact_laws();
  return parameter == "k" || parameter == "gamma" || parameter == "contact" ||
         parameter == contact_diameter_parameter.name || parameter == ContactLaw::k3_parameter.name ||
         std::any_of(laws.begin(), laws.end(), has);
}

} // namespace

const std::vector<ContactLawEntry>& contact_laws() {
  return mutable_contact_laws();
}

void add_contact_law(ContactLawEntry entry) {
  const auto& laws = contact_laws();
  if (std::any_of(laws.begin(), laws.end(), [&](const auto& law) { return law.name == entry.name; })) {
    throw std::invalid_argument(fmt::format("contact law \"{}\": there is one of that name already", entry.name));
  }
  for (const Parameter& parameter : entry.parameters) {
    if (is_taken(parameter.name)) {
      throw std::invalid_argument(
          fmt::format("contact law \"{}\": the key {} of [material] is taken", entry.name, parameter.name));
    }
  }
  mutable_contact_laws().push_back(std::move(entry));
}

const ContactLawEntry& contact_law_of(const Material& material) {
  std::string known;
  for (const ContactLawEntry& law : contact_laws()) {
    if (law.name == material.contact) {
      if (material.contact_parameters.size() != law.parameters.size()) {
        throw std::invalid_argument(fmt::format("contact law \"{}\" has {} parameters of its own; {} are given",
                                                law.name, law.parameters.size(), material.contact_parameters.size()));
      }
      return law;
    }
    known += (known.empty() ? "\"" : ", \"") + law.name + "\"";
  }
  throw std::invalid_argument(fmt::format("there is no contact law \"{}\"; allowed: {}", material.contact, known));
}

std::shared_ptr<const ContactModel> contact_model(const Material& material) {
  return contact_law_of(material).make(material);
}

} // namespace boba

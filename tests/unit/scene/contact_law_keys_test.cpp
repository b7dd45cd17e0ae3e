// SPDX-License-Identifier: GPL-3.0-or-later
// A scene chooses a contact law by name; laws from outside the tree bring keys of their own.
#include "bpm/forces/outside_contact_law.h"
#include "bpm/scene/scene.h"
#include "tests/support/other_laws.h"

#include <gtest/gtest.h>

namespace boba::test {
namespace {

const bool parabolic_is_known = [] {
  add_contact_law<ParabolicContact>("parabolic",
                                    {{"extra", "k/d", 0.0, 10.0, false, 3.0, "second-order part of the repulsion"}},
                                    [](const Material& m) {
                                      return ParabolicContact{m.k, m.contact_parameters.at(0), m.diameter};
                                    });
  return true;
}();

TEST(ContactLawKeys, ChooseALawAndItsParameters) {
  const auto material = [](const std::string& keys) {
    return read_stored_scene("[material]\n" + keys +
                                 "[[template]]\nname = \"t\"\nnodes = 60\n[[species]]\ncount = 2\nalpha = 1.0\n"
                                 "[[stage]]\ntype = \"insert\"\n",
                             "scene.toml", {})
        .material;
  };
  EXPECT_EQ(material("").contact, "hookean");
  EXPECT_FALSE(material("").contact_diameter);
  EXPECT_EQ(material("contact_diameter = 1.25\n").contact_diameter, 1.25);
  EXPECT_EQ(material("contact = \"parabolic\"\n").contact_parameters, std::vector<double>{3.0});
  EXPECT_EQ(material("contact = \"parabolic\"\nextra = 0.5\n").contact_parameters, std::vector<double>{0.5});
  const auto refusal = [&](const std::string& keys) -> std::string {
    try {
      material(keys);
      return "";
    } catch (const std::exception& error) {
      return error.what();
    }
  };
  EXPECT_NE(refusal("extra = 0.5\n").find("belongs to contact = \"parabolic\""), std::string::npos);
  EXPECT_NE(refusal("contact = \"parabolic\"\nk3 = 1.0\n").find("belongs to contact = \"hookean\""), std::string::npos);
  EXPECT_NE(refusal("contact = \"parabolic\"\nextra = 11.0\n").find("must be"), std::string::npos);
  EXPECT_NE(refusal("contact_diameter = 0.9\n").find("contact_diameter"), std::string::npos);
  EXPECT_NE(refusal("contact = \"none\"\n").find("parabolic"), std::string::npos);
  EXPECT_NE(refusal("contact = \"hertz\"\n").find("needs hertz_modulus"), std::string::npos);
  EXPECT_NE(refusal("hertz_modulus = 1.0\n").find("nodes = 1"), std::string::npos);
}

} // namespace
} // namespace boba::test

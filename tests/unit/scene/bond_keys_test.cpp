// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of a species that say what becomes of its bonds.
#include "bpm/scene/scene.h"

#include <gtest/gtest.h>
#include <string>

namespace boba::test {
namespace {

Scene scene_with(const std::string& keys, const std::string& shape = "sphere") {
  return read_stored_scene("[[template]]\nname = \"t\"\nshape = \"" + shape + "\"\nnodes = 60\n" +
                               "[[species]]\ncount = 1\nalpha = 1.0\n" + keys + "[[stage]]\ntype = \"specimen\"\n",
                           "scene.toml", {});
}

std::string refusal(const std::string& keys, const std::string& shape = "sphere") {
  try {
    scene_with(keys, shape);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST(BondKeys, SayWhatBreaksABond) {
  EXPECT_FALSE(scene_with("").species[0].breaking.is_possible());
  const Breaking plain = scene_with("break_strain = 0.2\n").species[0].breaking;
  EXPECT_EQ(plain, (Breaking{.strain = 0.2}));
  const Breaking all =
      scene_with("break_strain = 0.2\nbreak_in = \"tension\"\nbreak_smoothing = true\nbreak_scatter = 5.0\n")
          .species[0]
          .breaking;
  EXPECT_EQ(all, (Breaking{.strain = 0.2, .in_tension_only = true, .smooth = true, .weibull_modulus = 5.0}));
}

TEST(BondKeys, ThatMeanNothingAreRefused) {
  EXPECT_NE(refusal("break_strain = 0.0\n").find("break_strain"), std::string::npos);
  EXPECT_NE(refusal("break_smoothing = true\n").find("needs break_strain"), std::string::npos);
  EXPECT_NE(refusal("break_in = \"tension\"\n").find("needs break_strain"), std::string::npos);
  EXPECT_NE(refusal("break_strain = 0.2\nbreak_in = \"compression\"\n").find("either"), std::string::npos);
  EXPECT_NE(refusal("break_strain = 0.2\n", "periodic_box").find("periodic_box"), std::string::npos);
}

TEST(BondKeys, ACopyThatRestsNeedsWholeBonds) {
  const std::string measure = "[[measure]]\nwhat = \"order\"\nrelaxed = true\n";
  EXPECT_EQ(refusal(measure), "");
  EXPECT_NE(refusal("break_strain = 0.2\n" + measure).find("relaxed"), std::string::npos);
}

} // namespace
} // namespace boba::test

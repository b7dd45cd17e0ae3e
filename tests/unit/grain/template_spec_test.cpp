// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/shapes/convex_polyhedron.h"
#include "bpm/grain/shapes/shape.h"
#include "bpm/grain/template_spec.h"
#include "tests/unit/grain/complaint.h"

#include <gtest/gtest.h>
#include <limits>
#include <set>

namespace boba {
namespace {

using Shape = TemplateSpec::Shape;
using Surface = TemplateSpec::Surface;

TEST(TemplateSpec, NamesWhatIsWrong) {
  EXPECT_EQ(complaint({}), "");
  EXPECT_NE(complaint({.radius = -1.0}).find("radius = -1"), std::string::npos);
  EXPECT_NE(complaint({.radius = std::numeric_limits<double>::quiet_NaN()}).find("radius"), std::string::npos);
  EXPECT_NE(complaint({.n_nodes = 3}).find("n_nodes = 3"), std::string::npos);
  EXPECT_NE(complaint({.density = 0.2}).find("density = 0.2"), std::string::npos);
  EXPECT_NE(complaint({.bond_cutoff = 9.0}).find("bond_cutoff = 9"), std::string::npos);
  EXPECT_NE(complaint({.shape = Shape::cylinder, .height = 0.0}).find("height = 0"), std::string::npos);
  EXPECT_NE(complaint({.shape = Shape::box, .size = {9, -9, 9}}).find("size[1] = -9"), std::string::npos);
  EXPECT_NE(complaint({.shape = Shape::periodic_box, .surface = Surface::wall}).find("surface"), std::string::npos);
  EXPECT_NE(complaint({.radius = 9000.0}).find("number of nodes"), std::string::npos);
}

TEST(TemplateSpec, EveryMemberThatMattersIsInTheText) {
  std::set<std::string> texts;
  const std::vector<TemplateSpec> different = {{},
                                               {.surface = Surface::wall},
                                               {.radius = 9.0},
                                               {.n_nodes = 300},
                                               {.seed = 2},
                                               {.bond_cutoff = 1.4},
                                               {.density = 1.2},
                                               {.shape = Shape::cylinder},
                                               {.shape = Shape::cylinder, .height = 20.0},
                                               {.shape = Shape::cylinder, .height = 20.0, .n_nodes = 300},
                                               {.shape = Shape::box},
                                               {.shape = Shape::periodic_box},
                                               {.shape = Shape::box, .size = {9, 8, 7}},
                                               {.shape = Shape::box, .size = {9, 8, 7}, .n_nodes = 300},
                                               {.shape = Shape::ellipsoid},
                                               {.shape = Shape::superellipsoid},
                                               {.shape = Shape::superellipsoid, .exponent = 5.0},
                                               {.shape = Shape::superellipsoid, .exponent_z = 5.0},
                                               {.shape = Shape::capsule},
                                               {.shape = Shape::polyhedron},
                                               {.shape = Shape::polyhedron, .polyhedron = "octahedron"},
                                               {.shape = Shape::polyhedron, .rounding = 0.1},
                                               {.shape = Shape::polyhedron, .vertices = named_vertices("cube")}};
  for (const TemplateSpec& spec : different) {
    EXPECT_TRUE(texts.insert(canonical_text(spec)).second) << canonical_text(spec);
  }
}

TEST(TemplateSpec, MembersThatDoNotMatterAreNot) {
  EXPECT_EQ(canonical_text({.radius = 10.0, .height = 1.0, .size = {1, 2, 3}}), canonical_text({}));
  EXPECT_EQ(canonical_text({.radius = 3.0, .n_nodes = 300}), canonical_text({.radius = 4.0, .n_nodes = 300}));
  EXPECT_EQ(canonical_text({.shape = Shape::box, .size = {2, 4, 6}, .n_nodes = 300}),
            canonical_text({.shape = Shape::box, .size = {1, 2, 3}, .n_nodes = 300}));
}

TEST(TemplateSpec, HashIsThePublishedOne) {
  EXPECT_EQ(template_hash(""), 0xcbf29ce484222325ULL); // test vectors of the FNV draft
  EXPECT_EQ(template_hash("a"), 0xaf63dc4c8601ec8cULL);
  EXPECT_EQ(template_hash("foobar"), 0x85944171f73967e8ULL);
}

TEST(TemplateSpec, WordsGoBothWays) {
  for (const Shape shape : {Shape::sphere, Shape::cylinder, Shape::box, Shape::periodic_box, Shape::ellipsoid,
                            Shape::superellipsoid, Shape::capsule, Shape::polyhedron, Shape::mesh}) {
    EXPECT_EQ(shape_from_string(to_string(shape)), shape);
  }
  EXPECT_EQ(shape_names().size(), 9u);
  EXPECT_EQ(surface_from_string("wall"), Surface::wall);
  EXPECT_THROW(shape_from_string("ball"), std::invalid_argument);
  EXPECT_THROW(surface_from_string(""), std::invalid_argument);
}

} // namespace
} // namespace boba

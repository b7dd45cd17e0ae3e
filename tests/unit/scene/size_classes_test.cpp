// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes of a species: classes against closed forms and drawn numbers, grains dealt out, and what a scene makes of them.
#include "bpm/grain/build_template.h"
#include "bpm/io/input_error.h"
#include "bpm/scene/read_sizes.h"
#include "bpm/scene/scene_size.h"
#include "bpm/scene/size_classes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <stdexcept>

namespace boba {
namespace {

double mean(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

double central_moment(const std::vector<double>& x, int power) {
  double sum = 0.0;
  for (const double value : x) {
    sum += std::pow(value - mean(x), power);
  }
  return sum / static_cast<double>(x.size());
}

TEST(SizeClasses, HaveTheMeanAndTheDeviationThatWereGiven) {
  for (const std::string& distribution : size_distributions()) {
    for (const int n : {2, 3, 5, 16, 64}) {
      for (const double spread : {1e-3, 0.1, 0.3}) {
        const std::vector<double> d = size_classes(distribution, spread, n);
        EXPECT_EQ(static_cast<int>(d.size()), n);
        EXPECT_NEAR(mean(d), 1.0, 1e-12);
        EXPECT_NEAR(std::sqrt(central_moment(d, 2)), spread, 1e-12);
        EXPECT_TRUE(std::is_sorted(d.begin(), d.end()));
      }
    }
  }
}

/// Four slices of a normal distribution end at its quartile, 0.6744898: their means are 1.27111 and 0.32466.
TEST(SizeClasses, OfANormalDistributionFollowItsQuartiles) {
  const std::vector<double> d = size_classes("normal", 0.2, 4);
  EXPECT_NEAR((d[3] - 1.0) / (d[2] - 1.0), 1.271106 / 0.324663, 1e-4);
  EXPECT_NEAR(d[0] + d[3], 2.0, 1e-12);
  const std::vector<double> even = size_classes("uniform", 0.2, 4);
  EXPECT_NEAR((even[3] - 1.0) / (even[2] - 1.0), 3.0, 1e-12);
}

TEST(SizeClasses, OfALogNormalDistributionFollowNumbersThatWereDrawn) {
  constexpr double spread = 0.4;
  constexpr int n = 8, drawn = 1 << 20;
  const double s = std::sqrt(std::log(1.0 + spread * spread));
  std::mt19937_64 engine(5);
  std::lognormal_distribution<double> distribution(-0.5 * s * s, s);
  std::vector<double> x(drawn);
  std::generate(x.begin(), x.end(), [&] { return distribution(engine); });
  std::sort(x.begin(), x.end());
  std::vector<double> slices;
  for (int i = 0; i < n; ++i) {
    slices.push_back(mean({x.begin() + i * (drawn / n), x.begin() + (i + 1) * (drawn / n)}));
  }
  const double stretch = spread / std::sqrt(central_moment(slices, 2));
  const std::vector<double> d = size_classes("lognormal", spread, n);
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(d[i], 1.0 + stretch * (slices[i] - mean(slices)), 4e-3) << i;
  }
}

TEST(SizeClasses, ManyOfThemHaveTheSkewnessOfTheDistribution) {
  constexpr double spread = 0.2;
  const std::vector<double> d = size_classes("lognormal", spread, 64);
  EXPECT_NEAR(central_moment(d, 3) / std::pow(spread, 3.0), 3.0 * spread + std::pow(spread, 3.0), 0.06);
  EXPECT_NEAR(central_moment(size_classes("normal", spread, 64), 3), 0.0, 1e-12);
}

TEST(SizeClasses, RefuseWhatMakesNoGrain) {
  EXPECT_THROW(size_classes("gamma", 0.1, 3), std::invalid_argument);
  EXPECT_THROW(size_classes("normal", 0.1, 1), std::invalid_argument);
  EXPECT_THROW(size_classes("normal", 0.5, 64), std::invalid_argument); // 2.4 deviations below the mean
}

TEST(DealtOut, KeepsTheSumAndComesAsNearAsWholeNumbersDo) {
  EXPECT_EQ(dealt_out(10, {1, 1, 1}), (std::vector<std::int64_t>{4, 3, 3}));
  EXPECT_EQ(dealt_out(7, {0.5, 0.3, 0.2}), (std::vector<std::int64_t>{4, 2, 1})); // 3.5, 2.1, 1.4
  EXPECT_EQ(dealt_out(100, {3, 1}), (std::vector<std::int64_t>{75, 25}));
}

Scene read(const std::string& size, const std::string& count = "40") {
  return read_stored_scene("[[template]]\nname = \"t\"\nradius = 4.0\n"
                           "[[template]]\nname = \"rod\"\nshape = \"cylinder\"\nradius = 3\nheight = 9\nnodes = 400\n"
                           "[[species]]\nname = \"a\"\ntemplate = \"t\"\nalpha = 1.0\ncount = " +
                               count + "\n" + size +
                               "\n[[species]]\nname = \"b\"\ntemplate = \"rod\"\nalpha = 1.0\ncount = 3\n"
                               "[[stage]]\ntype = \"insert\"\n",
                           "scene.toml", {});
}

std::string message_of(const std::string& size, const std::string& count = "40") {
  try {
    read(size, count);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SpeciesSizes, MakeATemplateForEachClassInPlaceOfTheirOwn) {
  const Scene scene = read("size = { distribution = \"list\", diameters = [0.5, 1.5], shares = [3, 1] }");
  ASSERT_EQ(scene.templates.size(), 3U); // "rod" and two sizes; nobody is made from "t" itself
  ASSERT_EQ(scene.species.size(), 2U);
  EXPECT_EQ(scene.templates[scene.species[1].template_index].name, "rod");
  const std::vector<GrainsOfSize>& sizes = scene.species[0].sizes;
  ASSERT_EQ(sizes.size(), 2U);
  EXPECT_DOUBLE_EQ(scene.templates[sizes[0].template_index].spec.radius, 2.0);
  EXPECT_DOUBLE_EQ(scene.templates[sizes[1].template_index].spec.radius, 6.0);
  EXPECT_EQ(sizes[0].count, 30);
  EXPECT_EQ(sizes[1].count, 10);
  const double sphere = 4.0 / 3.0 * M_PI * bulk_node_density;
  EXPECT_NEAR(expected_size(scene).nodes, sphere * (30 * 8.0 + 10 * 216.0) + 3 * 400, 1e-6);
}

TEST(SpeciesSizes, OfAnotherSpeciesAreNotTouched) {
  const Scene scene = read("");
  ASSERT_EQ(scene.templates.size(), 2U);
  EXPECT_TRUE(scene.species[0].sizes.empty());
  EXPECT_EQ(scene.species[0].template_index, 0);
  EXPECT_EQ(scene.species[1].template_index, 1);
}

/// Equal volumes of spheres of diameters 1 and 2 are 8 to 1 by number.
TEST(SpeciesSizes, CountVolumeWhereTheyAreToldTo) {
  const Scene scene = read("size = { distribution = \"list\", diameters = [1.0, 2.0], by = \"volume\" }", "90");
  EXPECT_EQ(scene.species[0].sizes[0].count, 80);
  EXPECT_EQ(scene.species[0].sizes[1].count, 10);
}

/// The templates themselves: the volume that n nodes stand for gives the diameter.
TEST(SpeciesSizes, AreRealisedToTheSizeOfANode) {
  const Scene scene = read("size = { distribution = \"normal\", spread = 0.2, classes = 4 }");
  std::vector<double> diameters;
  std::vector<std::shared_ptr<const GrainTemplate>> built;
  for (const SceneTemplate& t : scene.templates) {
    const bool is_rod = t.name == "rod";
    built.push_back(is_rod ? nullptr : std::make_shared<const GrainTemplate>(build_template(t.spec)));
  }
  for (const GrainsOfSize& grains : scene.species[0].sizes) {
    EXPECT_EQ(grains.count, 10);
    diameters.push_back(std::cbrt(6.0 / M_PI * built[grains.template_index]->n_nodes() / bulk_node_density));
  }
  EXPECT_NEAR(mean(diameters), 8.0, 0.1);
  EXPECT_NEAR(std::sqrt(central_moment(diameters, 2)) / 8.0, 0.2, 0.02);
  const std::string told = realised_sizes(scene.species[0], built);
  EXPECT_EQ(told.find("40 grains of 4 sizes (10, 10, 10, 10); mean diameter "), 0U) << told;
}

TEST(SpeciesSizes, ScaleNodesByTheCube) {
  const Scene scene = read_stored_scene("[[template]]\nname = \"t\"\nnodes = 300\n[[species]]\nalpha = 1.0\ncount = 4\n"
                                        "[species.size]\ndistribution = \"list\"\ndiameters = [1.0, 2.0]\n"
                                        "[[stage]]\ntype = \"insert\"\n",
                                        "scene.toml", {"species.0.size.diameters=[0.5, 1.0]"});
  ASSERT_EQ(scene.templates.size(), 2U);
  EXPECT_EQ(*scene.templates[0].spec.n_nodes, 38); // 37.5
  EXPECT_EQ(*scene.templates[1].spec.n_nodes, 300);
}

TEST(SpeciesSizes, AreRefusedInOneSentence) {
  const auto refused = [](const std::string& size, const std::string& with, const std::string& count = "40") {
    const std::string message = message_of(size, count);
    EXPECT_NE(message.find(with), std::string::npos) << size << "\n" << message;
    EXPECT_NE(message.find("scene.toml:"), std::string::npos) << message;
  };
  refused("size = { spread = 0.1 }", "species.0.size.distribution is missing");
  refused("size = { distribution = \"normal\" }", "species.0.size.spread is missing");
  refused("size = { distribution = \"normal\", spred = 0.1 }", "Did you mean \"spread\"?");
  refused("size = { distribution = \"list\" }", "diameters is missing");
  refused("size = { distribution = \"list\", diameters = [1.0, 1.1], shares = [1] }", "has 1 numbers; there are 2");
  refused("size = { distribution = \"list\", diameters = [1.0], spread = 0.1 }", "has no meaning");
  refused("size = { distribution = \"normal\", spread = 0.1, shares = [1] }", "has no meaning");
  refused("size = { distribution = \"normal\", spread = 0.1 }", "4 grains are too few", "4");
  refused("size = { distribution = \"normal\", spread = 0.5, classes = 64 }", "smallest of 64 classes", "64");
  refused("size = { distribution = \"list\", diameters = [0.2] }", "at 0.2 times its size cannot be made");
  refused("size = 3", "must be a table");
}

} // namespace
} // namespace boba

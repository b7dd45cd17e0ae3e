// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_cache.h"
#include "bpm/grain/template_file.h"

#include <fstream>
#include <gtest/gtest.h>
#include <pwd.h>
#include <unistd.h>

namespace boba {
namespace {

namespace fs = std::filesystem;

class TemplateCacheTest : public testing::Test {
protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    directory_ = fs::temp_directory_path() / (std::string("boba-cache-") + test->name() + std::to_string(getpid()));
  }
  void TearDown() override { fs::remove_all(directory_); }

  GrainTemplate get() {
    built_ = false;
    return TemplateCache(directory_).get(spec_, [this] { built_ = true; });
  }
  fs::path file() const { return TemplateCache(directory_).file_of(spec_); }

  static void expect_equal(const GrainTemplate& a, const GrainTemplate& b) {
    ASSERT_EQ(a.n_nodes(), b.n_nodes());
    ASSERT_EQ(a.bonds.size(), b.bonds.size());
    for (int n = 0; n < a.n_nodes(); ++n) {
      EXPECT_EQ(a.position[n], b.position[n]);
    }
    for (std::size_t k = 0; k < a.bonds.size(); ++k) {
      EXPECT_EQ(a.bonds[k].i, b.bonds[k].i);
      EXPECT_EQ(a.bonds[k].j, b.bonds[k].j);
      EXPECT_EQ(a.bonds[k].r0, b.bonds[k].r0);
    }
    EXPECT_EQ(a.period, b.period);
    EXPECT_EQ(a.reference_volume, b.reference_volume);
  }

  TemplateSpec spec_{.surface = TemplateSpec::Surface::wall, .n_nodes = 40};
  fs::path directory_;
  bool built_ = false;
};

TEST_F(TemplateCacheTest, SecondRequestComesFromDisk) {
  const GrainTemplate first = get();
  EXPECT_TRUE(built_);
  EXPECT_TRUE(TemplateCache(directory_).contains(spec_));
  const GrainTemplate second = get();
  EXPECT_FALSE(built_);
  expect_equal(first, second);
}

TEST_F(TemplateCacheTest, PeriodSurvivesTheFile) {
  GrainTemplate box;
  box.position = {{0.1, 0.2, 0.3}, {1, 0, 0}};
  box.bonds = {{0, 1, 0.97}};
  box.period = Eigen::Vector3d(5, 6, 7);
  box.reference_volume = 210;
  fs::create_directories(directory_);
  write_template(directory_ / "box.h5", box, "a box");
  const auto read = read_template(directory_ / "box.h5", "a box");
  ASSERT_TRUE(read);
  expect_equal(box, *read);
  EXPECT_FALSE(read_template(directory_ / "box.h5", "another box"));
}

TEST_F(TemplateCacheTest, AnyDamagedByteIsNoticed) {
  const GrainTemplate first = get();
  std::string good;
  {
    std::ifstream in(file(), std::ios::binary);
    good.assign(std::istreambuf_iterator<char>(in), {});
  }
  const std::string text = canonical_text(spec_);
  for (std::size_t at = 0; at < good.size(); at += 13) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x20);
    std::ofstream(file(), std::ios::binary) << bad;
    EXPECT_FALSE(read_template(file(), text)) << "byte " << at;
  }
  std::ofstream(file(), std::ios::binary) << good.substr(0, good.size() / 2);
  expect_equal(first, get());
  EXPECT_TRUE(built_);
  get();
  EXPECT_FALSE(built_) << "the damaged file was not replaced";
}

TEST_F(TemplateCacheTest, AFileOfAnotherSpecificationUnderTheSameHashIsRebuilt) {
  const GrainTemplate first = get();
  write_template(file(), first, "another grain with the same hash");
  get();
  EXPECT_TRUE(built_);
}

TEST_F(TemplateCacheTest, WrongNumbersUnderARightChecksumAreRebuilt) {
  const GrainTemplate right = get();
  const auto expect_rebuilt = [&](const char* what, auto change) {
    GrainTemplate wrong = right;
    change(wrong);
    write_template(file(), wrong, canonical_text(spec_));
    EXPECT_FALSE(TemplateCache(directory_).contains(spec_)) << what;
    expect_equal(get(), right);
    EXPECT_TRUE(built_) << what;
  };
  expect_rebuilt("a node far away", [](GrainTemplate& g) { g.position[3] = Eigen::Vector3d(1e300, 0.0, 0.0); });
  expect_rebuilt("a node a little off", [](GrainTemplate& g) { g.position[3][1] += 1e-4; });
  expect_rebuilt("nodes spread over 1e9 d", [](GrainTemplate& g) { g.position[3] = Eigen::Vector3d(1e9, -1e9, 1e9); });
  expect_rebuilt("a rest length", [](GrainTemplate& g) { g.bonds[5].r0 *= 1.01; });
  expect_rebuilt("a bond less", [](GrainTemplate& g) { g.bonds.pop_back(); });
  expect_rebuilt("a bond of no node", [](GrainTemplate& g) { g.bonds.back().j = 1 << 30; });
  expect_rebuilt("a bond twice", [](GrainTemplate& g) { g.bonds.push_back(g.bonds.back()); });
  expect_rebuilt("no nodes", [](GrainTemplate& g) { g = GrainTemplate{}; });
  expect_rebuilt("a volume", [](GrainTemplate& g) { g.reference_volume = -1.0; });
  expect_rebuilt("a period", [](GrainTemplate& g) { g.period = Eigen::Vector3d(1e-300, 1.0, 1.0); });
}

TEST_F(TemplateCacheTest, ATextFileInItsPlaceIsRebuilt) {
  fs::create_directories(directory_);
  std::ofstream(file()) << "not a template\n";
  get();
  EXPECT_TRUE(built_);
}

TEST_F(TemplateCacheTest, NoDirectoryStillGivesTheTemplate) {
  std::ofstream(directory_) << "a file where the directory should be\n";
  EXPECT_EQ(get().n_nodes(), 40);
  EXPECT_TRUE(built_);
}

TEST(TemplateCacheDirectory, FollowsTheEnvironmentInOrder) {
  setenv("BOBA_CACHE_DIR", "/a", 1);
  setenv("XDG_CACHE_HOME", "/b", 1);
  setenv("HOME", "/c", 1);
  EXPECT_EQ(default_cache_directory(), "/a");
  unsetenv("BOBA_CACHE_DIR");
  EXPECT_EQ(default_cache_directory(), "/b/boba");
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(default_cache_directory(), "/c/.cache/boba");
  unsetenv("HOME");
  const passwd* user = getpwuid(getuid()); // the home that the system knows
  EXPECT_EQ(default_cache_directory(), std::filesystem::path(user->pw_dir) / ".cache" / "boba");
}

} // namespace
} // namespace boba

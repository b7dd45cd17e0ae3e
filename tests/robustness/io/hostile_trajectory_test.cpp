// SPDX-License-Identifier: GPL-3.0-or-later
// Trajectories that a library of HDF5 can read and no run wrote: told in a sentence, or sound enough to be used.
#include "bpm/dynamics/simulation.h"
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_packing.h"
#include "tests/support/hdf5_edits.h"
#include "tests/support/small_trajectory.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace boba::test {
namespace {

using What = Hdf5Edit::What;
using Type = Hdf5Edit::Type;

class HostileTrajectory : public testing::Test {
protected:
  void SetUp() override {
    write_small_trajectory(folder_ / "sound.h5");
    sound_ = content_of(folder_ / "sound.h5");
  }

  /// What is said of the sound file with these changes; empty when nothing is wrong with it.
  std::string said(const std::vector<Hdf5Edit>& edits) {
    const auto path = folder_.file("changed.h5", sound_);
    apply(path, edits);
    try {
      use_trajectory(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::string said(const std::string& dataset, std::vector<std::uint64_t> shape, double value,
                   Type type = Type::float64) {
    return said({{What::replace, dataset, std::move(shape), type, value, 0, ""}});
  }

  TemporaryFolder folder_;
  std::string sound_;
};

TEST_F(HostileTrajectory, ASoundOneIsUsed) {
  EXPECT_EQ(said({}), "");
}

TEST_F(HostileTrajectory, WhatIsWrongIsNamed) {
  const std::string grains = "/parameters/grains/";
  const auto expect = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << "said: " << message;
  };
  expect(said(grains + "species", {0}, 0, Type::int64), "species has 0 values for 3 grains");
  expect(said(grains + "template", {2}, 0, Type::int64), "template has 2 values for 3 grains");
  expect(said(grains + "template", {3}, 7, Type::int64), "template: grain 0 has 7; allowed: 0 to 2");
  expect(said({{What::set_value, grains + "first_node", {}, Type::int64, 2.0, 1, ""}}),
         "nodes; they must have the same");
  expect(said(grains + "first_node", {4}, 0, Type::int64), "must rise from 0");
  expect(said("/observables/grain_stress/value", {3, 3, 5}, 0.0), "[frames x 3 x 6] is needed");
  expect(said("/particles/all/position/value", {3, 1, 3}, 0.0), "position/value has the shape [3 x 1 x 3]");
  expect(said("/parameters/seed", {}, 0.0, Type::text), "seed is not a whole number");
  expect(said("/parameters/seed", {}, 0.0, Type::variable_text), "not a text of fixed length");
  expect(said("/particles/all/id", {1ULL << 40}, 1, Type::int64), "more values than the file can hold");
  expect(said("/particles/all/id", {1ULL << 62, 1ULL << 62}, 1, Type::int64), "more values than the file can hold");
  expect(said({{What::set_value, "/particles/all/image/value", {}, Type::int64, 989855744.0, 100, ""}}),
         "position of node");
  expect(said({{What::set_value, "/particles/all/image/value", {}, Type::int64, 1000.0, 100, ""}}), "d long, ");
  expect(said({{What::set_value, "/connectivity/bonds_r0", {}, Type::float64, 1.3, 3, ""}}), "rest length");
  expect(said({{What::set_value, "/connectivity/bonds_r0", {}, Type::float64, 0.0, 3, ""}}), "rest length 0 d");
  expect(said({{What::set_value, "/particles/all/box/edges/value", {}, Type::float64, 0.5, 1, ""}}), "along x");
  expect(said({{What::set_value, "/particles/all/box/edges/value", {}, Type::float64, -5.0, 4, ""}}), "computed with");
  expect(said({{What::set_value, "/particles/all/box/boba_origin/value", {}, Type::float64, 1e300, 4, ""}}),
         "computed with");
  expect(said({{What::set_value, "/particles/all/position/value", {}, Type::float64, 1e300, 4, ""}}),
         "position of node");
  expect(said({{What::set_value, "/particles/all/velocity/value", {}, Type::float64, 1e300, 4, ""}}),
         "velocity of node");
  expect(said({{What::set_value, "/observables/grain_centre/value", {}, Type::float64, 3.5, 4, ""}}), "nodes' mean");
  expect(said({{What::set_value, "/particles/all/position/step", {}, Type::int64, 7.0, 2, ""}}), "steps must rise");
  expect(said({{What::external_link, "/particles/all/id", {}, Type::int64, 0.0, 0, "/x"}}), "link to somewhere else");
  expect(said({{What::attribute, "/particles/all/box/edges/value", {}, Type::int64, 0.0, 0, ""}}), "boundary");
}

TEST_F(HostileTrajectory, EveryChangeOfEveryDatasetIsToldOrHarmless) {
  const std::vector<std::vector<std::uint64_t>> shapes = {
      {}, {0}, {1}, {3}, {4}, {3, 0}, {3, 3, 3}, {0, 0, 0, 0}, {1ULL << 33}, {3, 1ULL << 40, 3}};
  const std::vector<double> values = {0.0,       -1.0,         1.0,   2.0,    1e9,   1e300, std::nan(""),
                                      -INFINITY, 2147483647.0, -9e18, 5e-324, -1e-7, 0.3};
  int n = 0, refused = 0;
  for (const std::string& name : hdf5_datasets(folder_ / "sound.h5")) {
    std::vector<Hdf5Edit> edits;
    for (const What what :
         {What::remove, What::soft_link, What::external_link, What::group, What::share, What::attribute}) {
      edits.push_back({what, name, {}, Type::float64, 0.0, 0, "/particles/all/id"});
    }
    for (const std::uint64_t length : {0, 1, 2, 4, 100}) {
      edits.push_back({What::resize, name, {}, Type::float64, 0.0, length, ""});
    }
    for (const auto& shape : shapes) {
      edits.push_back({What::replace, name, shape, Type::float64, 1.0, 0, ""});
      edits.push_back({What::replace, name, shape, Type::int64, 1.0, 0, ""});
    }
    for (int type = 0; type <= static_cast<int>(Type::compound); ++type) {
      edits.push_back({What::replace, name, {3}, static_cast<Type>(type), 1.0, 0, ""});
    }
    for (const double value : values) {
      for (const std::uint64_t at : {0, 2, 70}) {
        edits.push_back({What::set_value, name, {}, Type::float64, value, at, ""});
      }
    }
    for (const Hdf5Edit& edit : edits) {
      SCOPED_TRACE(name + " " + std::to_string(n));
      const std::string message = said({edit});
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      refused += message.empty() ? 0 : 1;
      ++n;
    }
  }
  EXPECT_GT(refused, n / 2);
}

} // namespace
} // namespace boba::test

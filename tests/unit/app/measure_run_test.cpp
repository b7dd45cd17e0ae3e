// SPDX-License-Identifier: GPL-3.0-or-later
// From a stored trajectory to tables: a crystal whose numbers are known.
#include "bpm/app/measure/measure_run.h"
#include "bpm/io/trajectory.h"
#include "tests/support/crystals.h"
#include "tests/support/shapes.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace {

using namespace boba;
namespace fs = std::filesystem;

/// Columns of a CSV table, by name; an empty field is not-a-number.
std::map<std::string, std::vector<double>> read_table(const fs::path& path) {
  std::ifstream file(path);
  std::string line, field;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> columns;
  std::getline(file, line);
  for (std::istringstream in(line); std::getline(in, field, ',');) {
    names.push_back(field);
  }
  while (std::getline(file, line)) {
    std::istringstream in(line + ",");
    for (const std::string& name : names) {
      std::getline(in, field, ',');
      columns[name].push_back(field.empty() ? std::nan("") : std::stod(field));
    }
  }
  return columns;
}

/// Rhombic dodecahedra of inner diameter 6 d on an fcc lattice of the same neighbour distance: they fill space.
struct CrystalRun {
  fs::path folder;
  Topology topology;
  Snapshot snapshot;

  explicit CrystalRun(const std::string& name) : folder(fs::path(testing::TempDir()) / name) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    const auto crystal = crystals::fcc(3);
    constexpr double spacing = 6.0;
    snapshot.box = Box(spacing * crystal.box.origin(), spacing * crystal.box.lengths());
    topology.first_node = {0};
    for (const Vector3& centre : crystal.centres) {
      const auto first = static_cast<std::int64_t>(snapshot.position.size());
      for (const Vector3& corner : shapes::rhombic_dodecahedron()) {
        snapshot.position.push_back(spacing * (centre + corner / (2.0 * std::sqrt(2.0))));
      }
      const auto last = static_cast<std::int64_t>(snapshot.position.size());
      topology.bonds.push_back({first, first + 1, (snapshot.position[first] - snapshot.position[first + 1]).norm()});
      topology.first_node.push_back(last);
      snapshot.grain_centre.push_back(spacing * centre);
      snapshot.grain_stress.push_back({-1.0, -2.0, -3.0, 0.5, 0.0, 0.0});
    }
    const std::size_t n_grains = crystal.centres.size();
    topology.id.resize(snapshot.position.size());
    std::iota(topology.id.begin(), topology.id.end(), 1);
    topology.molecule.resize(n_grains);
    std::iota(topology.molecule.begin(), topology.molecule.end(), 1);
    topology.species.assign(n_grains, 0);
    topology.alpha.assign(n_grains, 0.0);
    topology.template_index.assign(n_grains, 0);
    TrajectoryWriter writer(folder / "trajectory.h5", topology, {});
    writer.write(snapshot);
    // Next frame: everything carried along by a shear of the cell, which flips; only grain 0 steps aside.
    const Box before = snapshot.box;
    Matrix3 h = before.h();
    h.row(0) += 0.7 * h.row(1);
    snapshot.box.set_h(h);
    snapshot.box.flip();
    snapshot.step = 100;
    snapshot.time = 10.0;
    snapshot.strain = 0.7;
    for (std::size_t g = 0; g < n_grains; ++g) {
      const Vector3 move = 0.7 * (snapshot.grain_centre[g][1] - before.origin()[1]) * Vector3::UnitX() +
                           (g == 0 ? Vector3(0.0, 0.0, 0.3) : Vector3::Zero());
      snapshot.grain_centre[g] += move;
      for (std::int64_t i = topology.first_node[g]; i < topology.first_node[g + 1]; ++i) {
        snapshot.position[i] += move;
      }
    }
    writer.write(snapshot);
    writer.close();
  }
};

MeasureRunOptions all_of(const CrystalRun& run) {
  MeasureRunOptions options;
  options.run = run.folder;
  choose_measures(options.plan, {"all"});
  options.plan.scattering.q_max = 1.0;
  options.plan.facet_sensitivity = true;
  return options;
}

TEST(MeasureRun, SpaceFillingCrystalHasItsKnownNumbers) {
  const CrystalRun run("measure_run_crystal");
  const MeasureRunResult result = measure_run(all_of(run));
  EXPECT_EQ(result.n_frames, 2);
  EXPECT_TRUE(result.undeformed_known);
  EXPECT_FALSE(result.velocity_known);
  const fs::path folder = run.folder / "measures";
  const double n = 108.0;

  const auto shape = read_table(folder / "shape.csv");
  EXPECT_NEAR(shape.at("asphericity_mean")[0], 1.1621, 5e-5);
  EXPECT_NEAR(shape.at("undeformed_asphericity")[0], 1.1621, 5e-5);
  EXPECT_NEAR(shape.at("volume_mean_d3")[0], 216.0 / std::sqrt(2.0), 1e-9);
  EXPECT_DOUBLE_EQ(shape.at("facets_mean")[0], 12.0);
  EXPECT_DOUBLE_EQ(shape.at("twelve_facets_share")[0], 1.0);
  EXPECT_NEAR(shape.at("faceted_share")[0], 1.0, 1e-12);
  EXPECT_EQ(read_table(folder / "grains.csv").at("grain").size(), 2 * 108u);
  EXPECT_EQ(read_table(folder / "facets.csv").at("grain").size(), 2 * 12 * 108u);
  EXPECT_DOUBLE_EQ(read_table(folder / "facet_sensitivity.csv").at("undeformed_facets")[0], 12.0);

  const auto phi = read_table(folder / "packing_fraction.csv");
  EXPECT_GT(phi.at("phi")[0], 0.9999); // hulls fill the box
  EXPECT_NEAR(phi.at("phi_undeformed_hulls")[0], 1.0, 1e-9);
  EXPECT_NEAR(phi.at("phi_reference")[0], 14.0 / 1.226 / (216.0 / std::sqrt(2.0)),
              1e-9); // nodes over the bulk's density

  const auto order = read_table(folder / "order.csv");
  EXPECT_DOUBLE_EQ(order.at("fcc_share")[0], 1.0);
  EXPECT_NEAR(order.at("q6_mean")[0], 0.57452, 5.1e-6);

  const auto contacts = read_table(folder / "coordination.csv");
  EXPECT_DOUBLE_EQ(contacts.at("contacts_per_grain")[0], 18.0); // 12 faces, and the 6 tips touch the second neighbours

  const auto stress = read_table(folder / "stress.csv");
  const double volume = n * 216.0 / std::sqrt(2.0);
  EXPECT_NEAR(stress.at("P_k/d")[0], 2.0 * n / volume, 1e-12);
  EXPECT_NEAR(stress.at("mu")[0], 0.25, 1e-12);
  EXPECT_TRUE(std::isnan(stress.at("kinetic_xx_k/d")[0])); // no velocities: not known, not zero

  const auto motion = read_table(folder / "motion.csv");
  ASSERT_EQ(motion.at("step").size(), 1u); // nothing to compare the first frame with
  EXPECT_NEAR(motion.at("non_affine_square_d2")[0], 0.09 / n * (1.0 - 1.0 / n), 1e-9);
  const auto grain_motion = read_table(folder / "grain_motion.csv");
  EXPECT_NEAR(grain_motion.at("displacement_z_d")[0], 0.3, 1e-9);
  EXPECT_NEAR(grain_motion.at("displacement_x_d")[50], 0.0, 1e-9);

  const auto scattering = read_table(folder / "scattering.csv");
  ASSERT_GE(scattering.at("q_1/d").size(), 8u);
  // Equal grains on fcc (cube edge 6 sqrt(2)): no vector below the first Bragg peak at 2 pi sqrt(3) / edge = 1.28
  // scatters.
  EXPECT_NEAR(scattering.at("intensity")[0], 0.0, 1e-10);
  EXPECT_GT(scattering.at("form_factor")[0], 1.0);
  EXPECT_TRUE(fs::exists(folder / "averages.json"));
}

TEST(MeasureRun, TablesAreNotOverwrittenInSilence) {
  const CrystalRun run("measure_run_twice");
  MeasureRunOptions options = all_of(run);
  choose_measures(options.plan, {"order"});
  measure_run(options);
  EXPECT_THROW(measure_run(options), std::invalid_argument); // wrong input, as for a run
  options.force = true;
  options.only_frame = -1;
  EXPECT_EQ(measure_run(options).n_frames, 1);
  EXPECT_EQ(read_table(run.folder / "measures" / "order.csv").at("step"), std::vector<double>{100.0});
}

TEST(MeasureRun, FramesAreChosenByStrain) {
  const CrystalRun run("measure_run_every");
  MeasureRunOptions options = all_of(run);
  choose_measures(options.plan, {"stress"});
  options.every_strain = 0.8;
  EXPECT_EQ(measure_run(options).n_frames, 1);
  options.every_strain = 0.7;
  options.force = true;
  EXPECT_EQ(measure_run(options).n_frames, 2);
}

TEST(MeasureRun, WindowLimitsTheAverages) {
  const CrystalRun run("measure_run_window");
  MeasureRunOptions options = all_of(run);
  choose_measures(options.plan, {"stress"});
  options.window = {-1.0, 5.0};
  measure_run(options);
  std::ifstream file(run.folder / "measures" / "averages.json");
  const auto json = nlohmann::json::parse(file);
  EXPECT_NEAR(json.at("mu").at("mean").get<double>(), 0.25, 1e-12);
  EXPECT_EQ(json.at("mu").at("values").get<int>(), 2);
  EXPECT_FALSE(json.at("mu").at("reached_plateau").get<bool>());
}

TEST(MeasureRun, WrongInputIsNamed) {
  const CrystalRun run("measure_run_wrong");
  MeasureRunOptions options = all_of(run);
  options.only_frame = 7;
  EXPECT_THROW(measure_run(options), std::exception);
  EXPECT_FALSE(fs::exists(run.folder / "measures")); // nothing was begun
  options = all_of(run);
  options.run = run.folder / "no_such_folder";
  EXPECT_THROW(measure_run(options), std::exception);
  options = all_of(run);
  options.every = 0;
  EXPECT_THROW(measure_run(options), std::invalid_argument);
  MeasurePlan plan;
  EXPECT_THROW(choose_measures(plan, {"shape", "colour"}), std::invalid_argument);
}

} // namespace

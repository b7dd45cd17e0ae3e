// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/run_writers.h"

#include "bpm/app/version.h"
#include "bpm/io/lammps_dump.h"
#include "bpm/io/trajectory.h"
#include "bpm/io/vtk.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <optional>

namespace boba {

namespace {

std::string with_overrides(const Scene& scene) {
  std::string text = scene.text + (scene.text.ends_with('\n') ? "" : "\n") + "# Overrides of this run:\n";
  for (const std::string& assignment : scene.overrides) {
    text += "# --set " + assignment + "\n";
  }
  return text;
}

/// What checkpoints call the writers.
const std::string table_name = "table", trajectory_name = "trajectory", dump_name = "dump", vtk_name = "vtk",
                  motion_name = "motion";

/// Step that a writer had written last at the checkpoint; -1 for nothing.
std::int64_t last_step_of(const RunSetup& setup, const std::string& writer) {
  std::int64_t step = -1;
  if (setup.restart) {
    Archive archive = Archive::reading_from(setup.restart->state);
    archive.inside("output", [&] { archive.inside(writer, [&] { archive.field("last_step", step); }); });
  }
  return step;
}

/// Of the run until now; a run that continues reads it from the table's part of the checkpoint.
StrainPath path_of_strain(const RunSetup& setup, const Simulation& simulation) {
  StrainPath path(simulation.strain());
  if (setup.restart) {
    Archive archive = Archive::reading_from(setup.restart->state);
    archive.inside("output", [&] { archive.inside(table_name, [&] { archive.object("strain_path", path); }); });
  }
  return path;
}

TrajectoryWriter trajectory_writer(const RunSetup& setup, const Simulation& simulation, const FrameOutput& output,
                                   std::int64_t last_step, bool nodes_by_others) {
  const Topology topology = simulation.packing().topology(true);
  const std::filesystem::path path = setup.folder.trajectory();
  // Before its first frame the file has nothing to be kept, and if that frame was cut off HDF5 cannot read it at all.
  const bool is_gap = setup.accept_gaps && !std::filesystem::exists(path);
  if (setup.restart && last_step >= 0 && !is_gap) {
    return TrajectoryWriter::go_on(path, topology, last_step, nodes_by_others);
  }
  TrajectoryOrigin origin;
  origin.scene = with_overrides(setup.scene);
  origin.seed = setup.scene.seed;
  origin.version = version();
  origin.git_hash = git_hash();
  TrajectoryOptions options;
  options.velocity = output.velocities;
  options.nodes_by_others = nodes_by_others;
  options.damage = bonds_break(simulation.packing());
  options.bonds_yield = bonds_yield(simulation.packing());
  const FileMode mode = setup.restart ? FileMode::overwrite : FileMode::create;
  return {path, topology, origin, options, mode};
}

WriteBehind::Write dump_writer(const RunSetup& setup, const std::shared_ptr<const Topology>& topology,
                               std::int64_t last_step) {
  const std::filesystem::path path = setup.folder.dump();
  if (setup.restart) {
    truncate_lammps_dump(path, last_step);
  }
  const FileMode mode = setup.restart ? FileMode::append : FileMode::create;
  auto writer = std::make_shared<LammpsDumpWriter>(path, DumpLayout::viewer, mode);
  return [writer, topology](const Snapshot& snapshot) { writer->write(*topology, snapshot); };
}

WriteBehind::Write vtk_writer(const RunSetup& setup, const std::shared_ptr<const Topology>& topology,
                              std::int64_t last_step) {
  const std::filesystem::path path = setup.folder.vtk() / "packing.pvd";
  std::filesystem::create_directories(setup.folder.vtk());
  auto series = std::make_shared<VtkSeries>(setup.restart ? VtkSeries::go_on(path, last_step) : VtkSeries(path));
  return [series, topology](const Snapshot& snapshot) { series->write(*topology, snapshot); };
}

std::shared_ptr<MeasureTables> measure_tables(const RunSetup& setup, const Simulation& simulation,
                                              const MeasurePlan& plan, std::int64_t last_step) {
  const Packing& packing = simulation.packing();
  const FileMode mode = setup.restart ? FileMode::append : FileMode::create;
  auto tables = std::make_shared<MeasureTables>(setup.folder.measures(), packing.topology(false), plan,
                                                undeformed_grains(packing), mode, last_step, simulation.ranks());
  if (plan.rest && plan.has(MeasureKind::order) && simulation.ranks().is_root()) {
    tables->set_frame_rest(
        std::make_shared<const FrameRest>(packing, plan.material, setup.scene.options.dt, *plan.rest));
  }
  if (setup.restart && simulation.ranks().is_root() && plan.has(MeasureKind::motion)) {
    Archive archive = Archive::reading_from(setup.restart->state);
    archive.inside("output", [&] { archive.inside(motion_name, [&] { tables->archive_motion(archive); }); });
  }
  return tables;
}

/// Observers that look when rank 0's writers of frames look, in the same order, and write nothing.
template <class MakeSchedule>
void follow_writers(RunWriters& writers, const RunSetup& setup, const MakeSchedule& schedule) {
  const OutputPlan& plan = setup.scene.output;
  const auto follow = [&](const std::string& name, const std::optional<FrameOutput>& output) {
    if (output) {
      writers.frames.push_back(std::make_unique<FrameObserver>(name, schedule(output->every),
                                                               Simulation::Parts{.velocity = output->velocities},
                                                               last_step_of(setup, name), [](const Snapshot&) {}));
    }
  };
  follow(dump_name, plan.dump);
  follow(vtk_name, plan.vtk);
}

/// The measures, which all ranks take together.
template <class MakeSchedule>
void add_measures(RunWriters& writers, const RunSetup& setup, const Simulation& simulation,
                  const MakeSchedule& schedule) {
  for (std::size_t k = 0; k < setup.scene.measures.size(); ++k) {
    const SceneMeasure& entry = setup.scene.measures[k];
    const std::string name = fmt::format("measure{}", k);
    const std::int64_t last_step = last_step_of(setup, name);
    const auto tables = measure_tables(setup, simulation, entry.plan, last_step);
    // Velocities tell the kinetic part of the stress apart.
    const Simulation::Parts parts = {.velocity = entry.plan.has(MeasureKind::stress),
                                     .positions_on_all_ranks = entry.plan.needs_all_ranks()};
    writers.frames.push_back(std::make_unique<FrameObserver>(
        name, schedule(entry.every), parts, last_step, [tables](const Snapshot& snapshot) { tables->add(snapshot); }));
    if (entry.plan.has(MeasureKind::motion)) {
      writers.motion = tables;
    }
  }
}

} // namespace

void RunWriters::archive(Archive& archive) {
  archive.object(table_name, *table);
  for (const auto& writer : frames) {
    archive.object(writer->name(), *writer);
  }
  if (motion) {
    archive.inside(motion_name, [&] { motion->archive_motion(archive); });
  }
}

void RunWriters::wait() const {
  for (const auto& writer : behind) {
    writer->wait();
  }
}

RunWriters open_writers(const RunSetup& setup, const Simulation& simulation, const PackingNumbers& numbers) {
  RunWriters writers;
  const OutputPlan& plan = setup.scene.output;
  const auto schedule = [&](const OutputInterval& every) {
    return Schedule(every, path_of_strain(setup, simulation), simulation.time());
  };
  const bool with_stress =
      std::ranges::any_of(setup.scene.stages, [](const SceneStage& stage) { return stage.entry->shows_stress(); });
  const std::vector<std::string> columns =
      run_table_columns({bonds_break(simulation.packing()), bonds_yield(simulation.packing()), with_stress});
  const bool writes = simulation.ranks().is_root();
  std::optional<TableWriter> table;
  if (writes) {
    table = setup.restart ? TableWriter::go_on(setup.folder.table(), columns, last_step_of(setup, table_name))
                          : TableWriter(setup.folder.table(), columns);
  }
  writers.table = std::make_unique<TableObserver>(std::move(table), schedule(plan.table), numbers,
                                                  last_step_of(setup, table_name), with_stress);

  // Files are cut behind what the checkpoint knows of, not at its step: rows of the same step may have come later.
  const auto add = [&](const std::string& name, const FrameOutput& output, FrameObserver::Write write,
                       bool own = false) {
    writers.frames.push_back(std::make_unique<FrameObserver>(
        name, schedule(output.every), Simulation::Parts{.velocity = output.velocities, .own = own},
        last_step_of(setup, name), std::move(write)));
  };
  if (plan.trajectory) {
    writers.trajectory = std::make_shared<SharedTrajectory>(
        simulation.ranks(), setup.folder.trajectory(), simulation.packing().first_nodes(), [&](bool nodes_by_others) {
          return trajectory_writer(setup, simulation, *plan.trajectory, last_step_of(setup, trajectory_name),
                                   nodes_by_others);
        });
    add(
        trajectory_name, *plan.trajectory, [writer = writers.trajectory](const Snapshot& own) { writer->write(own); },
        true);
  }
  if (writes) {
    const auto topology = std::make_shared<const Topology>(simulation.packing().topology(false));
    const auto add_behind = [&](const std::string& name, const FrameOutput& output, WriteBehind::Write write) {
      writers.behind.push_back(std::make_unique<WriteBehind>(std::move(write)));
      add(name, output, [behind = writers.behind.back().get()](Snapshot&& frame) { behind->add(std::move(frame)); });
    };
    if (plan.dump) {
      add_behind(dump_name, *plan.dump, dump_writer(setup, topology, last_step_of(setup, dump_name)));
    }
    if (plan.vtk) {
      add_behind(vtk_name, *plan.vtk, vtk_writer(setup, topology, last_step_of(setup, vtk_name)));
    }
  } else {
    follow_writers(writers, setup, schedule);
  }
  add_measures(writers, setup, simulation, schedule);
  return writers;
}

} // namespace boba

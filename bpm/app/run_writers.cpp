// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/run_writers.h"

#include "bpm/app/version.h"
#include "bpm/io/lammps_dump.h"
#include "bpm/io/trajectory.h"
#include "bpm/io/vtk.h"

#include <filesystem>
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

/// Step that a writer (the table is the first) had written last at the checkpoint; -1 for nothing.
std::int64_t last_step_of(const RunSetup& setup, std::size_t writer) {
  return setup.restart && writer < setup.restart->last_steps.size() ? setup.restart->last_steps[writer] : -1;
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
    tables->restore_motion(setup.restart->motion);
  }
  return tables;
}

/// Observers that look when rank 0's writers of frames look, in the same order, and write nothing.
template <class MakeSchedule>
void follow_writers(RunWriters& writers, const RunSetup& setup, const MakeSchedule& schedule) {
  const OutputPlan& plan = setup.scene.output;
  for (const auto* output : {&plan.dump, &plan.vtk}) {
    if (*output) {
      writers.frames.push_back(std::make_unique<FrameObserver>(
          schedule((*output)->every), Simulation::Parts{.velocity = (*output)->velocities},
          last_step_of(setup, writers.frames.size() + 1), [](const Snapshot&) {}));
    }
  }
}

/// The measures, which all ranks take together.
template <class MakeSchedule>
void add_measures(RunWriters& writers, const RunSetup& setup, const Simulation& simulation,
                  const MakeSchedule& schedule) {
  for (const SceneMeasure& entry : setup.scene.measures) {
    const std::int64_t last_step = last_step_of(setup, writers.frames.size() + 1);
    const auto tables = measure_tables(setup, simulation, entry.plan, last_step);
    // Velocities tell the kinetic part of the stress apart.
    const Simulation::Parts parts = {.velocity = entry.plan.has(MeasureKind::stress),
                                     .positions_on_all_ranks = entry.plan.needs_all_ranks()};
    writers.frames.push_back(std::make_unique<FrameObserver>(
        schedule(entry.every), parts, last_step, [tables](const Snapshot& snapshot) { tables->add(snapshot); }));
    if (entry.plan.has(MeasureKind::motion)) {
      writers.motion = tables;
    }
  }
}

} // namespace

std::vector<std::int64_t> RunWriters::last_steps() const {
  std::vector<std::int64_t> steps{table->last_step()};
  for (const auto& writer : frames) {
    steps.push_back(writer->last_step());
  }
  return steps;
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
    const bool is_known = setup.restart && !setup.restart->strain_path.empty();
    return Schedule(every,
                    is_known ? StrainPath::restored(setup.restart->strain_path) : StrainPath(simulation.strain()),
                    simulation.time());
  };
  const std::vector<std::string> columns = run_table_columns();
  const bool writes = simulation.ranks().is_root();
  std::optional<TableWriter> table;
  if (writes) {
    table = setup.restart ? TableWriter::go_on(setup.folder.table(), columns, last_step_of(setup, 0))
                          : TableWriter(setup.folder.table(), columns);
  }
  writers.table =
      std::make_unique<TableObserver>(std::move(table), schedule(plan.table), numbers, last_step_of(setup, 0));

  // Files are cut behind what the checkpoint knows of, not at its step: rows of the same step may have come later.
  const auto last_step = [&] { return last_step_of(setup, writers.frames.size() + 1); };
  const auto add = [&](const FrameOutput& output, FrameObserver::Write write, bool own = false) {
    writers.frames.push_back(std::make_unique<FrameObserver>(
        schedule(output.every), Simulation::Parts{.velocity = output.velocities, .own = own}, last_step(),
        std::move(write)));
  };
  if (plan.trajectory) {
    writers.trajectory = std::make_shared<SharedTrajectory>(
        simulation.ranks(), setup.folder.trajectory(), simulation.packing().first_nodes(), [&](bool nodes_by_others) {
          return trajectory_writer(setup, simulation, *plan.trajectory, last_step(), nodes_by_others);
        });
    add(
        *plan.trajectory, [writer = writers.trajectory](const Snapshot& own) { writer->write(own); }, true);
  }
  if (writes) {
    const auto topology = std::make_shared<const Topology>(simulation.packing().topology(false));
    const auto add_behind = [&](const FrameOutput& output, WriteBehind::Write write) {
      writers.behind.push_back(std::make_unique<WriteBehind>(std::move(write)));
      add(output, [behind = writers.behind.back().get()](Snapshot&& frame) { behind->add(std::move(frame)); });
    };
    if (plan.dump) {
      add_behind(*plan.dump, dump_writer(setup, topology, last_step()));
    }
    if (plan.vtk) {
      add_behind(*plan.vtk, vtk_writer(setup, topology, last_step()));
    }
  } else {
    follow_writers(writers, setup, schedule);
  }
  add_measures(writers, setup, simulation, schedule);
  return writers;
}

} // namespace boba

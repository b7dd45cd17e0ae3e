// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_checks.h"
#include "bpm/io/trajectory_head.h"
#include "bpm/io/trajectory_layout.h"
#include "bpm/io/wrapped_nodes.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

using namespace trajectory;
using hdf5::File;

namespace {

/// What HDF5 may add for its indices of chunks and the small datasets in one frame, bytes.
constexpr std::uint64_t index_room = 2 << 20;

void need(std::size_t size, std::size_t wanted, const char* what) {
  if (size != wanted) {
    throw std::invalid_argument(fmt::format("trajectory: the snapshot has {} {}; {} are needed", size, what, wanted));
  }
}

std::span<const double> numbers(const std::vector<Vector3>& vectors) {
  static_assert(sizeof(Vector3) == 3 * sizeof(double));
  return {vectors.data()->data(), 3 * vectors.size()};
}

std::size_t undeformed_nodes(const Topology& topology) {
  std::size_t n = 0;
  for (const std::vector<Vector3>& nodes : topology.undeformed) {
    n += nodes.size();
  }
  return n;
}

void set_closed(const File& file, bool is_closed) {
  const std::int32_t value = is_closed ? 1 : 0;
  file.rewrite<std::int32_t>(closed, {&value, 1});
}

bool was_closed(const std::filesystem::path& path) {
  const File file = File::open(path, false);
  return file.has(closed) && file.read<std::int32_t>(closed).at(0) == 1;
}

/// Names of everything that grows by frames.
std::vector<std::string> all_growing(const File& file) {
  std::vector<std::string> names = growing_values(file);
  names.push_back(time_name());
  names.push_back(step_name());
  return names;
}

void copy_frames(const File& from, const File& to, hsize_t n_frames) {
  to.reserve(std::filesystem::file_size(from.path()));
  for (const std::string& name : all_growing(to)) {
    for (hsize_t frame = 0; frame < n_frames; ++frame) {
      if (!from.has(name)) {
        to.write_frame<double>(name, frame, std::vector<double>{0.0}); // a streaming rate, of a file that has none
      } else if (name == step_name()) {
        to.write_frame<std::int64_t>(name, frame, from.read_frame<std::int64_t>(name, frame));
      } else if (name == value_of(image)) {
        to.write_frame<std::int32_t>(name, frame, from.read_frame<std::int32_t>(name, frame));
      } else {
        to.write_frame<double>(name, frame, from.read_frame<double>(name, frame));
      }
    }
  }
}

/// Puts a copy that holds the complete frames up to `last_step` in the file's place.
///
/// After a kill in the middle of a flush HDF5's index and its account of free space may disagree: the old frames can be
/// read, but writing on would lay new data over other data.
void rebuild(const std::filesystem::path& path, std::int64_t last_step) {
  const std::filesystem::path copy = path.string() + ".rebuilt";
  {
    const TrajectoryReader reader(path);
    const File from = File::open(path, false);
    TrajectoryWriter writer(
        copy, reader.topology(), reader.origin(),
        {.velocity = reader.has_velocity(),
         .compression = from.compression(value_of(position)),
         .damage = from.has(damage),
         .bonds_yield = from.has_attribute(std::string(grains) + "/alpha", trajectory::bonds_yield)},
        FileMode::overwrite);
    writer.close();
    File to = File::open(copy, true);
    if (from.has_attribute(box, "boundary")) {
      to.set_attribute(box, "boundary", from.texts_attribute(box, "boundary"));
    }
    const std::vector<std::int64_t>& steps = reader.steps();
    copy_frames(from, to,
                static_cast<hsize_t>(std::upper_bound(steps.begin(), steps.end(), last_step) - steps.begin()));
    to.close();
  }
  std::filesystem::rename(copy, path);
}

} // namespace

struct TrajectoryWriter::Impl {
  File file;
  std::size_t n_nodes = 0, n_grains = 0;
  bool has_velocity = false, has_damage = false, has_boundary = false;
  bool has_streaming_rate = true; ///< false for a file of a version that did not store it
  std::int64_t n_frames = 0;
  std::int64_t last_step = -1;

  hsize_t frame() const { return static_cast<hsize_t>(n_frames); } ///< the one to be written next
  void write(const char* element, std::span<const double> values) const {
    file.write_frame<double>(value_of(element), frame(), values);
  }
  void prepare(const Snapshot& snapshot);
  void finish(const Snapshot& snapshot);
};

TrajectoryWriter::TrajectoryWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TrajectoryWriter::TrajectoryWriter(TrajectoryWriter&&) noexcept = default;
TrajectoryWriter& TrajectoryWriter::operator=(TrajectoryWriter&&) noexcept = default;

TrajectoryWriter::~TrajectoryWriter() {
  try {
    close();
  } catch (const std::exception&) { // whoever needs to know calls close()
  }
}

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& path, const Topology& topology,
                                   const TrajectoryOrigin& origin_of_file, const TrajectoryOptions& options,
                                   FileMode mode)
    : impl_(std::make_unique<Impl>()) {
  check_file_mode(path, mode);
  impl_->file = File::create(path, options.nodes_by_others);
  impl_->n_nodes = topology.id.size();
  impl_->n_grains = static_cast<std::size_t>(topology.n_grains());
  impl_->has_velocity = options.velocity;
  impl_->has_damage = options.damage;
  const File& file = impl_->file;
  file.reserve(index_room + origin_of_file.scene.size() + 64 * topology.id.size() + 64 * topology.first_node.size() +
               24 * topology.bonds.size() + 24 * undeformed_nodes(topology));
  write_once(file, topology, origin_of_file, options);
  file.flush();
}

TrajectoryWriter TrajectoryWriter::go_on(const std::filesystem::path& path, const Topology& topology,
                                         std::int64_t last_step, bool nodes_by_others) {
  auto impl = std::make_unique<Impl>();
  if (!was_closed(path)) {
    rebuild(path, last_step);
  }
  impl->file = File::open(path, true, nodes_by_others);
  const File& file = impl->file;
  if (file.read<std::int64_t>(std::string(all) + "/id") != topology.id) {
    throw std::runtime_error(fmt::format("{}: holds another packing than the one that goes on", path.string()));
  }
  impl->n_nodes = topology.id.size();
  impl->n_grains = static_cast<std::size_t>(topology.n_grains());
  impl->has_velocity = file.has(velocity);
  impl->has_damage = file.has(damage);
  impl->has_streaming_rate = file.has(streaming_rate);
  check_growing(file, topology);
  const std::vector<std::int64_t> steps = complete_steps(file);
  impl->n_frames = std::upper_bound(steps.begin(), steps.end(), last_step) - steps.begin();
  for (const std::string& name : all_growing(file)) {
    file.set_frames(name, static_cast<hsize_t>(impl->n_frames));
  }
  set_closed(file, false);
  file.flush();
  impl->last_step = impl->n_frames > 0 ? steps[impl->n_frames - 1] : -1;
  impl->has_boundary = file.has_attribute(box, "boundary");
  return TrajectoryWriter(std::move(impl));
}

bool TrajectoryWriter::is_new(const Snapshot& snapshot) const {
  const Impl& out = *impl_;
  if (out.n_frames > 0 && snapshot.step == out.last_step) {
    return false;
  }
  if (snapshot.step <= out.last_step || snapshot.step < 0) {
    throw std::invalid_argument(fmt::format("trajectory: step {} comes after step {}", snapshot.step, out.last_step));
  }
  return true;
}

bool TrajectoryWriter::can_allocate_frames() const {
  return impl_->file.has_whole_frames(value_of(position));
}

/// Room on the disk, and what can only be told once there is a frame.
void TrajectoryWriter::Impl::prepare(const Snapshot& snapshot) {
  need(snapshot.grain_centre.size(), n_grains, "grain centres");
  need(snapshot.grain_stress.size(), n_grains, "grain stresses");
  file.reserve(index_room + (has_velocity ? 60 : 36) * n_nodes + (has_damage ? 8 : 0) * n_nodes + 72 * n_grains);
  if (has_damage) {
    need(snapshot.damage.size(), n_nodes, "shares of broken bonds");
  }
  if (!has_boundary) {
    std::vector<std::string> boundary;
    for (const bool periodic : snapshot.box.periodic()) {
      boundary.push_back(periodic ? "periodic" : "none");
    }
    file.set_attribute(box, "boundary", boundary);
    has_boundary = true;
  }
}

/// All but the nodes.
void TrajectoryWriter::Impl::finish(const Snapshot& snapshot) {
  // H5MD wants the cell vectors as rows; the columns of h lie one after the other in memory.
  const Matrix3 h = snapshot.box.h();
  const Vector3 corner = snapshot.box.origin();
  write(edges, {h.data(), 9});
  write(box_origin, {corner.data(), 3});
  write(strain, {&snapshot.strain, 1});
  if (has_damage) {
    write(damage, snapshot.damage);
  }
  if (has_streaming_rate) {
    write(streaming_rate, {&snapshot.streaming_rate, 1});
  }
  write(grain_centre, numbers(snapshot.grain_centre));
  write(grain_stress, {snapshot.grain_stress.data()->data(), 6 * snapshot.grain_stress.size()});
  // Last: a frame without its step is not there for a reader.
  file.write_frame<double>(time_name(), frame(), {&snapshot.time, 1});
  file.write_frame<std::int64_t>(step_name(), frame(), {&snapshot.step, 1});
  file.flush();
  ++n_frames;
  last_step = snapshot.step;
}

void TrajectoryWriter::write(const Snapshot& snapshot) {
  Impl& out = *impl_;
  if (!is_new(snapshot)) {
    return;
  }
  need(snapshot.position.size(), out.n_nodes, "positions");
  if (out.has_velocity) {
    need(snapshot.velocity.size(), out.n_nodes, "velocities");
  }
  out.prepare(snapshot);
  const WrappedNodes nodes(snapshot);
  out.file.write_frame<std::int32_t>(value_of(image), out.frame(), nodes.image);
  if (out.has_velocity) {
    out.write(velocity, numbers(snapshot.velocity));
  }
  out.write(position, numbers(nodes.position));
  out.finish(snapshot);
}

TrajectoryWriter::NodePlaces TrajectoryWriter::allocate_frame(const Snapshot& snapshot) {
  Impl& out = *impl_;
  out.prepare(snapshot);
  NodePlaces places;
  places.image = out.file.allocate_frame<std::int32_t>(value_of(image), out.frame());
  if (out.has_velocity) {
    places.velocity = out.file.allocate_frame<double>(value_of(velocity), out.frame());
  }
  places.position = out.file.allocate_frame<double>(value_of(position), out.frame());
  return places;
}

void TrajectoryWriter::finish(const Snapshot& snapshot) {
  impl_->finish(snapshot);
}

void TrajectoryWriter::give_up() {
  impl_->file.detach();
}

std::int64_t TrajectoryWriter::n_frames() const {
  return impl_->n_frames;
}

void TrajectoryWriter::close() {
  if (impl_ != nullptr && impl_->file.is_open()) {
    set_closed(impl_->file, true);
    impl_->file.close();
  }
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_layout.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

using namespace trajectory;
using hdf5::File;

namespace {

/// Small datasets keep many frames in one chunk, so that a frame touches few places of the file.
constexpr hsize_t small_chunk = 256;

std::string value_of(const char* element) {
  return std::string(element) + "/value";
}

/// What HDF5 may add for its indices of chunks and the small datasets in one frame, bytes.
constexpr std::uint64_t index_room = 2 << 20;

std::string step_name() {
  return std::string(position) + "/step";
}
std::string time_name() {
  return std::string(position) + "/time";
}

/// An H5MD element of doubles that shares step and time with the positions.
void make_element(const File& file, const char* element, const File::Growing& layout, const std::string& unit) {
  file.make_growing<double>(value_of(element), layout, not_written);
  file.set_attribute(value_of(element), "boba_unit", unit);
  if (element != position) {
    file.link(step_name(), std::string(element) + "/step");
    file.link(time_name(), std::string(element) + "/time");
  }
}

void write_head(const File& file, const TrajectoryOrigin& origin_of_file) {
  file.make_group("/h5md/author");
  file.make_group("/h5md/creator");
  const std::vector<std::int32_t> version = {1, 1};
  file.set_attribute("/h5md", "version", version);
  file.set_attribute("/h5md/author", "name", origin_of_file.author);
  file.set_attribute("/h5md/creator", "name", std::string("boba"));
  file.set_attribute("/h5md/creator", "version", origin_of_file.version);
  file.make_group("/parameters");
  file.write_text("/parameters/scene", origin_of_file.scene);
  file.write_text("/parameters/version", origin_of_file.version);
  file.write_text("/parameters/git_hash", origin_of_file.git_hash);
  // As text: a seed may use all 64 bits.
  file.write_text("/parameters/seed", std::to_string(origin_of_file.seed));
  const std::int32_t not_closed = 0;
  file.write<std::int32_t>(closed, {&not_closed, 1});
}

template <typename T> std::vector<std::int64_t> widened(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

/// Nodes of the undeformed templates one after the other, with the range of each.
void write_undeformed(const File& file, const Topology& topology) {
  std::vector<std::int64_t> first = {0};
  std::vector<double> all_nodes;
  for (const std::vector<Vector3>& nodes : topology.undeformed) {
    for (const Vector3& x : nodes) {
      all_nodes.insert(all_nodes.end(), x.data(), x.data() + 3);
    }
    first.push_back(static_cast<std::int64_t>(all_nodes.size() / 3));
  }
  if (!all_nodes.empty()) {
    file.write<std::int64_t>(std::string(grains) + "/undeformed_first_node", first);
    file.write<double>(std::string(grains) + "/undeformed_position", all_nodes, 3);
    file.set_attribute(std::string(grains) + "/undeformed_position", "boba_unit", std::string("d"));
  }
}

void write_grains(const File& file, const Topology& topology) {
  const std::string folder = std::string(grains) + "/";
  file.make_group(grains);
  const auto write = [&](const char* name, const std::vector<std::int64_t>& values) {
    file.write<std::int64_t>(folder + name, values);
  };
  write("first_node", topology.first_node);
  write("molecule", topology.molecule);
  write("species", widened(topology.species));
  write("template", widened(topology.template_index));
  write_undeformed(file, topology);
  file.write<double>(folder + "alpha", topology.alpha);
  file.set_attribute(folder + "alpha", "boba_unit", std::string("k d"));
}

void write_particles(const File& file, const Topology& topology) {
  const std::string folder = std::string(all) + "/";
  std::vector<std::int64_t> grain;
  std::vector<std::int32_t> species;
  for (const int g : topology.grain_of_node()) {
    grain.push_back(topology.molecule[g]);
    species.push_back(topology.species[g]);
  }
  const std::vector<double> mass(topology.id.size(), 1.0);
  file.write<std::int64_t>(folder + "id", topology.id);
  file.write<std::int64_t>(folder + "grain", grain);
  file.write<std::int32_t>(folder + "species", species);
  file.write<double>(folder + "mass", mass);
  file.set_attribute(folder + "mass", "boba_unit", std::string("m"));
}

void write_bonds(const File& file, const Topology& topology) {
  std::vector<std::int64_t> pairs;
  std::vector<double> r0;
  pairs.reserve(2 * topology.bonds.size());
  r0.reserve(topology.bonds.size());
  for (const Topology::Pair& bond : topology.bonds) {
    pairs.push_back(topology.id[bond.i]);
    pairs.push_back(topology.id[bond.j]);
    r0.push_back(bond.r0);
  }
  file.make_group("/connectivity");
  file.write<std::int64_t>("/connectivity/bonds", pairs, 2);
  file.set_reference("/connectivity/bonds", "particles_group", all);
  file.write<double>("/connectivity/bonds_r0", r0);
  file.set_attribute("/connectivity/bonds_r0", "boba_unit", std::string("d"));
}

void make_elements(const File& file, const Topology& topology, const TrajectoryOptions& options) {
  const auto n = static_cast<hsize_t>(topology.n_nodes());
  const auto n_grains = static_cast<hsize_t>(topology.n_grains());
  const File::Growing nodes{{n, 3}, 1, options.compression};
  file.make_group(position);
  file.make_growing<std::int64_t>(step_name(), {{}, small_chunk, 0}, std::int64_t{-1});
  file.make_growing<double>(time_name(), {{}, small_chunk, 0}, not_written);
  file.set_attribute(time_name(), "boba_unit", std::string("tau"));
  make_element(file, position, nodes, "d");
  file.make_growing<std::int32_t>(value_of(image), nodes, image_not_written);
  file.link(step_name(), std::string(image) + "/step");
  file.link(time_name(), std::string(image) + "/time");
  if (options.velocity) {
    make_element(file, velocity, nodes, "d/tau");
  }
  make_element(file, edges, {{3, 3}, small_chunk, 0}, "d");
  make_element(file, box_origin, {{3}, small_chunk, 0}, "d");
  make_element(file, strain, {{}, small_chunk, 0}, "1");
  make_element(file, streaming_rate, {{}, small_chunk, 0}, "1/tau");
  make_element(file, grain_centre, {{n_grains, 3}, 1, 0}, "d");
  make_element(file, grain_stress, {{n_grains, 6}, 1, 0}, "k d");
  file.set_attribute(value_of(grain_stress), "components", std::string("xx yy zz xy xz yz"));
}

void check_parts(const Snapshot& snapshot, std::size_t n_nodes, std::size_t n_grains, bool with_velocity) {
  const auto need = [](std::size_t size, std::size_t wanted, const char* what) {
    if (size != wanted) {
      throw std::invalid_argument(fmt::format("trajectory: the snapshot has {} {}; {} are needed", size, what, wanted));
    }
  };
  need(snapshot.position.size(), n_nodes, "positions");
  need(snapshot.grain_centre.size(), n_grains, "grain centres");
  need(snapshot.grain_stress.size(), n_grains, "grain stresses");
  if (with_velocity) {
    need(snapshot.velocity.size(), n_nodes, "velocities");
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
    TrajectoryWriter writer(copy, reader.topology(), reader.origin(),
                            {reader.has_velocity(), from.compression(value_of(position))}, FileMode::overwrite);
    writer.close();
    const File to = File::open(copy, true);
    if (from.has_attribute(box, "boundary")) {
      to.set_attribute(box, "boundary", from.texts_attribute(box, "boundary"));
    }
    const std::vector<std::int64_t>& steps = reader.steps();
    copy_frames(from, to,
                static_cast<hsize_t>(std::upper_bound(steps.begin(), steps.end(), last_step) - steps.begin()));
    to.flush();
  }
  std::filesystem::rename(copy, path);
}

} // namespace

struct TrajectoryWriter::Impl {
  File file;
  std::size_t n_nodes = 0, n_grains = 0;
  bool has_velocity = false, has_boundary = false;
  bool has_streaming_rate = true; ///< false for a file of a version that did not store it
  std::int64_t n_frames = 0;
  std::int64_t last_step = -1;
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
  impl_->file = File::create(path);
  impl_->n_nodes = topology.id.size();
  impl_->n_grains = static_cast<std::size_t>(topology.n_grains());
  impl_->has_velocity = options.velocity;
  const File& file = impl_->file;
  file.reserve(index_room + origin_of_file.scene.size() + 64 * topology.id.size() + 64 * topology.first_node.size() +
               24 * topology.bonds.size() + 24 * undeformed_nodes(topology));
  write_head(file, origin_of_file);
  file.make_group(box);
  const std::vector<std::int32_t> dimension = {3};
  file.set_attribute(box, "dimension", dimension);
  write_particles(file, topology);
  write_grains(file, topology);
  write_bonds(file, topology);
  make_elements(file, topology, options);
  file.flush();
}

TrajectoryWriter TrajectoryWriter::go_on(const std::filesystem::path& path, const Topology& topology,
                                         std::int64_t last_step) {
  auto impl = std::make_unique<Impl>();
  if (!was_closed(path)) {
    rebuild(path, last_step);
  }
  impl->file = File::open(path, true);
  const File& file = impl->file;
  if (file.read<std::int64_t>(std::string(all) + "/id") != topology.id) {
    throw std::runtime_error(fmt::format("{}: holds another packing than the one that goes on", path.string()));
  }
  impl->n_nodes = topology.id.size();
  impl->n_grains = static_cast<std::size_t>(topology.n_grains());
  impl->has_velocity = file.has(velocity);
  impl->has_streaming_rate = file.has(streaming_rate);
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

void TrajectoryWriter::write(const Snapshot& snapshot) {
  Impl& out = *impl_;
  if (out.n_frames > 0 && snapshot.step == out.last_step) {
    return;
  }
  if (snapshot.step <= out.last_step || snapshot.step < 0) {
    throw std::invalid_argument(fmt::format("trajectory: step {} comes after step {}", snapshot.step, out.last_step));
  }
  check_parts(snapshot, out.n_nodes, out.n_grains, out.has_velocity);
  out.file.reserve(index_room + (out.has_velocity ? 60 : 36) * out.n_nodes + 72 * out.n_grains);
  if (!out.has_boundary) {
    std::vector<std::string> boundary;
    for (const bool periodic : snapshot.box.periodic()) {
      boundary.push_back(periodic ? "periodic" : "none");
    }
    out.file.set_attribute(box, "boundary", boundary);
    out.has_boundary = true;
  }
  std::vector<Vector3> wrapped(out.n_nodes);
  std::vector<std::int32_t> images(3 * out.n_nodes);
  for (std::size_t node = 0; node < out.n_nodes; ++node) {
    const Eigen::Vector3i n = snapshot.box.image_of(snapshot.position[node]);
    wrapped[node] = snapshot.position[node] - snapshot.box.h() * n.cast<double>();
    std::copy(n.begin(), n.end(), images.begin() + static_cast<std::ptrdiff_t>(3 * node));
  }
  // H5MD wants the cell vectors as rows; the columns of h lie one after the other in memory.
  const Matrix3 h = snapshot.box.h();
  const Vector3 corner = snapshot.box.origin();
  const auto frame = static_cast<hsize_t>(out.n_frames);
  const auto write = [&](const char* element, std::span<const double> values) {
    out.file.write_frame<double>(value_of(element), frame, values);
  };
  out.file.write_frame<std::int32_t>(value_of(image), frame, images);
  if (out.has_velocity) {
    write(velocity, numbers(snapshot.velocity));
  }
  write(edges, {h.data(), 9});
  write(box_origin, {corner.data(), 3});
  write(strain, {&snapshot.strain, 1});
  if (out.has_streaming_rate) {
    write(streaming_rate, {&snapshot.streaming_rate, 1});
  }
  write(grain_centre, numbers(snapshot.grain_centre));
  write(grain_stress, {snapshot.grain_stress.data()->data(), 6 * snapshot.grain_stress.size()});
  write(position, numbers(wrapped));
  // Last: a frame without its step is not there for a reader.
  out.file.write_frame<double>(time_name(), frame, {&snapshot.time, 1});
  out.file.write_frame<std::int64_t>(step_name(), frame, {&snapshot.step, 1});
  out.file.flush();
  ++out.n_frames;
  out.last_step = snapshot.step;
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/id_table.h"
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_layout.h"

#include <algorithm>
#include <fmt/format.h>

namespace boba {

using namespace trajectory;
using hdf5::File;

namespace {

/// HDF5's failures, as errors of the file that somebody gave.
template <typename Call> auto as_input_error(Call call) {
  try {
    return call();
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(error.what());
  }
}

template <typename T> std::vector<T> narrowed(const std::vector<std::int64_t>& values) {
  return {values.begin(), values.end()};
}

TrajectoryOrigin read_origin(const File& file) {
  TrajectoryOrigin result;
  result.scene = file.read_text("/parameters/scene");
  result.version = file.read_text("/parameters/version");
  result.git_hash = file.read_text("/parameters/git_hash");
  result.author = file.text_attribute("/h5md/author", "name");
  const std::string seed = file.read_text("/parameters/seed");
  result.seed = std::stoull(seed);
  return result;
}

[[noreturn]] void refuse(const File& file, const std::string& why) {
  throw InputError(fmt::format("{}: {}", file.path().string(), why));
}

std::vector<Vector3> as_vectors(const std::vector<double>& numbers) {
  std::vector<Vector3> vectors(numbers.size() / 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    vectors[i] = Vector3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  }
  return vectors;
}

std::vector<std::vector<Vector3>> read_undeformed(const File& file) {
  const std::string folder = std::string(grains) + "/";
  std::vector<std::vector<Vector3>> undeformed;
  if (!file.has(folder + "undeformed_position")) {
    return undeformed;
  }
  const std::vector<Vector3> nodes = as_vectors(file.read<double>(folder + "undeformed_position"));
  const auto first = file.read<std::int64_t>(folder + "undeformed_first_node");
  if (first.empty() || first.front() != 0 || first.back() != static_cast<std::int64_t>(nodes.size()) ||
      !std::is_sorted(first.begin(), first.end())) {
    refuse(file, folder + "undeformed_first_node does not divide the undeformed nodes into templates");
  }
  for (std::size_t t = 0; t + 1 < first.size(); ++t) {
    undeformed.emplace_back(nodes.begin() + first[t], nodes.begin() + first[t + 1]);
  }
  return undeformed;
}

Topology read_topology(const File& file) {
  const std::string folder = std::string(grains) + "/";
  Topology topology;
  topology.id = file.read<std::int64_t>(std::string(all) + "/id");
  topology.first_node = file.read<std::int64_t>(folder + "first_node");
  topology.molecule = file.read<std::int64_t>(folder + "molecule");
  topology.species = narrowed<int>(file.read<std::int64_t>(folder + "species"));
  topology.template_index = narrowed<int>(file.read<std::int64_t>(folder + "template"));
  topology.alpha = file.read<double>(folder + "alpha");
  topology.undeformed = read_undeformed(file);
  const std::vector<std::int64_t>& first = topology.first_node;
  if (first.empty() || first.front() != 0 || first.back() != topology.n_nodes() ||
      !std::is_sorted(first.begin(), first.end())) {
    refuse(file, folder + "first_node does not divide the nodes into grains");
  }
  const std::vector<std::int64_t> pairs = file.read<std::int64_t>("/connectivity/bonds");
  const std::vector<double> r0 = file.read<double>("/connectivity/bonds_r0");
  if (pairs.size() != 2 * r0.size()) {
    refuse(file, "/connectivity/bonds and bonds_r0 have different lengths");
  }
  const IdTable nodes(topology.id);
  for (std::size_t bond = 0; bond < r0.size(); ++bond) {
    const Topology::Pair pair{nodes.row(pairs[2 * bond]), nodes.row(pairs[2 * bond + 1]), r0[bond]};
    if (pair.i == IdTable::none || pair.j == IdTable::none) {
      refuse(file, fmt::format("bond {} - {} joins nodes that are not there", pairs[2 * bond], pairs[2 * bond + 1]));
    }
    topology.bonds.push_back(pair);
  }
  return topology;
}

} // namespace

struct TrajectoryReader::Impl {
  File file;
  std::array<bool, 3> periodic = {true, true, true};

  template <typename T> std::vector<T> frame_of(const char* element, std::int64_t frame) const {
    return file.read_frame<T>(std::string(element) + "/value", static_cast<hsize_t>(frame));
  }
};

TrajectoryReader::TrajectoryReader(TrajectoryReader&&) noexcept = default;
TrajectoryReader& TrajectoryReader::operator=(TrajectoryReader&&) noexcept = default;
TrajectoryReader::~TrajectoryReader() = default;

TrajectoryReader::TrajectoryReader(const std::filesystem::path& path) : impl_(std::make_unique<Impl>()) {
  as_input_error([&] {
    impl_->file = File::open(path, false);
    const File& file = impl_->file;
    if (!file.has(grains) || !file.has(position)) {
      refuse(file, "is an HDF5 file, but not a trajectory written by Boba (no /parameters/grains)");
    }
    origin_ = read_origin(file);
    topology_ = read_topology(file);
    steps_ = complete_steps(file);
    has_velocity_ = file.has(velocity);
    if (file.has_attribute(box, "boundary")) {
      const std::vector<std::string> boundary = file.texts_attribute(box, "boundary");
      for (std::size_t axis = 0; axis < 3; ++axis) {
        impl_->periodic[axis] = boundary.at(axis) == "periodic";
      }
    }
  });
}

Snapshot TrajectoryReader::snapshot(std::int64_t frame) const {
  const std::int64_t index = frame < 0 ? frame + n_frames() : frame;
  if (index < 0 || index >= n_frames()) {
    refuse(impl_->file, fmt::format("has no frame {}; it holds {} complete frames", frame, n_frames()));
  }
  return as_input_error([&] {
    const Impl& in = *impl_;
    Snapshot snapshot;
    snapshot.step = steps_[index];
    snapshot.time = in.file.read_frame<double>(std::string(position) + "/time", static_cast<hsize_t>(index)).at(0);
    snapshot.strain = in.frame_of<double>(strain, index).at(0);
    if (in.file.has(streaming_rate)) {
      snapshot.streaming_rate = in.frame_of<double>(streaming_rate, index).at(0);
    }
    const std::vector<double> h = in.frame_of<double>(edges, index), corner = in.frame_of<double>(box_origin, index);
    snapshot.box = Box(Vector3(corner.data()), Vector3(h[0], h[4], h[8]), Vector3(h[3], h[6], h[7]), in.periodic);
    snapshot.position = as_vectors(in.frame_of<double>(position, index));
    const std::vector<std::int32_t> images = in.frame_of<std::int32_t>(image, index);
    for (std::size_t node = 0; node < snapshot.position.size(); ++node) {
      snapshot.position[node] +=
          snapshot.box.h() * Vector3(images[3 * node], images[3 * node + 1], images[3 * node + 2]);
    }
    if (has_velocity_) {
      snapshot.velocity = as_vectors(in.frame_of<double>(velocity, index));
    }
    snapshot.grain_centre = as_vectors(in.frame_of<double>(grain_centre, index));
    const std::vector<double> stress = in.frame_of<double>(grain_stress, index);
    snapshot.grain_stress.resize(stress.size() / 6);
    for (std::size_t i = 0; i < stress.size(); ++i) {
      snapshot.grain_stress[i / 6][i % 6] = stress[i];
    }
    return snapshot;
  });
}

std::int64_t TrajectoryReader::frame_of_step(std::int64_t step) const {
  const auto found = std::lower_bound(steps_.begin(), steps_.end(), step);
  if (found == steps_.end() || *found != step) {
    refuse(impl_->file, steps_.empty()
                            ? "holds no complete frame"
                            : fmt::format("has no frame of step {}; there are {} frames between steps {} and {}", step,
                                          n_frames(), steps_.front(), steps_.back()));
  }
  return found - steps_.begin();
}

} // namespace boba

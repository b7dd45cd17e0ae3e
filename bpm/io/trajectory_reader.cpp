// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_checks.h"
#include "bpm/io/trajectory_layout.h"
#include "bpm/io/trajectory_topology.h"

#include <algorithm>
#include <charconv>
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

TrajectoryOrigin read_origin(const File& file) {
  TrajectoryOrigin result;
  result.scene = file.read_text("/parameters/scene");
  result.version = file.read_text("/parameters/version");
  result.git_hash = file.read_text("/parameters/git_hash");
  result.author = file.text_attribute("/h5md/author", "name");
  const std::string seed = file.read_text("/parameters/seed");
  const auto [end, error] = std::from_chars(seed.data(), seed.data() + seed.size(), result.seed);
  if (error != std::errc() || end != seed.data() + seed.size()) {
    refuse_file(file, "/parameters/seed is not a whole number of 64 bits");
  }
  return result;
}

std::vector<Vector3> as_vectors(const std::vector<double>& numbers) {
  std::vector<Vector3> vectors(numbers.size() / 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    vectors[i] = Vector3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  }
  return vectors;
}

std::array<bool, 3> read_boundary(const File& file) {
  std::array<bool, 3> periodic = {true, true, true};
  if (!file.has_attribute(box, "boundary")) {
    return periodic; // no frame yet
  }
  const std::vector<std::string> boundary = file.texts_attribute(box, "boundary");
  const auto is_known = [](const std::string& word) { return word == "periodic" || word == "none"; };
  if (boundary.size() != 3 || !std::all_of(boundary.begin(), boundary.end(), is_known)) {
    refuse_file(file, fmt::format("the attribute boundary of {} must be three words, periodic or none", box));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    periodic[axis] = boundary[axis] == "periodic";
  }
  return periodic;
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
      refuse_file(file, "is an HDF5 file, but not a trajectory written by Boba (no /parameters/grains)");
    }
    origin_ = read_origin(file);
    topology_ = read_topology(file);
    check_growing(file, topology_);
    steps_ = complete_steps(file);
    has_velocity_ = file.has(velocity);
    bonds_yield_ = file.has_attribute(std::string(grains) + "/alpha", trajectory::bonds_yield);
    impl_->periodic = read_boundary(file);
  });
}

std::int64_t TrajectoryReader::frame_number(std::int64_t frame) const {
  const std::int64_t index = frame < 0 ? frame + n_frames() : frame;
  if (index < 0 || index >= n_frames()) {
    refuse_file(impl_->file, fmt::format("has no frame {}; it holds {} complete frames", frame, n_frames()));
  }
  return index;
}

double TrajectoryReader::strain_of(std::int64_t frame) const {
  const std::int64_t index = frame_number(frame);
  return as_input_error([&] { return impl_->frame_of<double>(strain, index).at(0); });
}

Snapshot TrajectoryReader::snapshot(std::int64_t frame) const {
  const std::int64_t index = frame_number(frame);
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
    snapshot.box = checked_box(in.file, index, corner, h, in.periodic);
    snapshot.position = as_vectors(in.frame_of<double>(position, index));
    const std::vector<std::int32_t> images = in.frame_of<std::int32_t>(image, index);
    for (std::size_t node = 0; node < snapshot.position.size(); ++node) {
      snapshot.position[node] +=
          snapshot.box.h() * Vector3(images[3 * node], images[3 * node + 1], images[3 * node + 2]);
    }
    if (has_velocity_) {
      snapshot.velocity = as_vectors(in.frame_of<double>(velocity, index));
    }
    if (in.file.has(damage)) {
      snapshot.damage = in.frame_of<double>(damage, index);
    }
    snapshot.grain_centre = as_vectors(in.frame_of<double>(grain_centre, index));
    const std::vector<double> stress = in.frame_of<double>(grain_stress, index);
    snapshot.grain_stress.resize(stress.size() / 6);
    for (std::size_t i = 0; i < stress.size(); ++i) {
      snapshot.grain_stress[i / 6][i % 6] = stress[i];
    }
    check_frame(in.file, index, topology_, snapshot);
    return snapshot;
  });
}

std::int64_t TrajectoryReader::frame_of_step(std::int64_t step) const {
  const auto found = std::lower_bound(steps_.begin(), steps_.end(), step);
  if (found == steps_.end() || *found != step) {
    refuse_file(impl_->file, steps_.empty()
                                 ? "holds no complete frame"
                                 : fmt::format("has no frame of step {}; there are {} frames between steps {} and {}",
                                               step, n_frames(), steps_.front(), steps_.back()));
  }
  return found - steps_.begin();
}

} // namespace boba

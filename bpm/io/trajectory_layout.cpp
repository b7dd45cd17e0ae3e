// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory_layout.h"

#include "bpm/io/input_error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <stdexcept>

namespace boba::trajectory {

void refuse_file(const hdf5::File& file, const std::string& why) {
  throw InputError(fmt::format("{}: {}", file.path().string(), why));
}

std::vector<std::string> growing_values(const hdf5::File& file) {
  std::vector<std::string> names;
  for (const char* name :
       {position, image, velocity, damage, edges, box_origin, strain, streaming_rate, grain_centre, grain_stress}) {
    const bool optional = name == velocity || name == damage || name == streaming_rate;
    if (!optional || file.has(name)) {
      names.push_back(std::string(name) + "/value");
    }
  }
  return names;
}

namespace {

bool has_fill_values(const hdf5::File& file, hsize_t frame) {
  for (const std::string& name : growing_values(file)) {
    if (name.starts_with(image)) {
      const std::vector<std::int32_t> values = file.read_frame<std::int32_t>(name, frame);
      if (std::find(values.begin(), values.end(), image_not_written) != values.end()) {
        return true;
      }
      continue;
    }
    const std::vector<double> values = file.read_frame<double>(name, frame);
    if (std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); })) {
      return true;
    }
  }
  return false;
}

/// Frames at the end that may lack values: a kill leaves one, a file that is being written may show two.
constexpr int most_torn = 3;

hsize_t frames_in(const hdf5::File& file, const std::string& name) {
  const std::vector<hsize_t> shape = file.look(name).shape;
  if (shape.empty()) {
    refuse_file(file, fmt::format("{} holds one value instead of one a frame", name));
  }
  return shape[0];
}

bool is_torn(const hdf5::File& file, hsize_t frame) {
  try {
    return has_fill_values(file, frame);
  } catch (const std::runtime_error&) {
    return true; // the index names a place that was not written any more
  }
}

} // namespace

std::vector<std::int64_t> complete_steps(const hdf5::File& file) {
  std::vector<std::int64_t> steps = file.read<std::int64_t>(std::string(position) + "/step");
  hsize_t n_frames = std::min<hsize_t>(steps.size(), frames_in(file, time_name()));
  for (const std::string& name : growing_values(file)) {
    n_frames = std::min(n_frames, frames_in(file, name));
  }
  steps.resize(n_frames);
  steps.erase(std::find_if(steps.begin(), steps.end(), [](std::int64_t step) { return step < 0; }), steps.end());
  if (const auto at = std::adjacent_find(steps.begin(), steps.end(), std::greater_equal<>()); at != steps.end()) {
    refuse_file(file, fmt::format("step {} of {} comes after step {}; steps must rise", at[1], step_name(), at[0]));
  }
  // Only the last frame can be torn by a kill; what is missing of it reads as the fill value.
  for (int n_torn = 0; !steps.empty() && is_torn(file, steps.size() - 1); ++n_torn) {
    if (n_torn == most_torn) {
      refuse_file(file, fmt::format("its last {} frames hold values that are not numbers", n_torn + 1));
    }
    steps.pop_back();
  }
  return steps;
}

} // namespace boba::trajectory

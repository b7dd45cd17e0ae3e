// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory_layout.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace boba::trajectory {

std::vector<std::string> growing_values(const hdf5::File& file) {
  std::vector<std::string> names;
  for (const char* name :
       {position, image, velocity, edges, box_origin, strain, streaming_rate, grain_centre, grain_stress}) {
    const bool optional = name == velocity || name == streaming_rate;
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
  hsize_t n_frames = std::min<hsize_t>(steps.size(), file.shape(std::string(position) + "/time").at(0));
  for (const std::string& name : growing_values(file)) {
    n_frames = std::min(n_frames, file.shape(name).at(0));
  }
  steps.resize(n_frames);
  steps.erase(std::find_if(steps.begin(), steps.end(), [](std::int64_t step) { return step < 0; }), steps.end());
  // Only the last frame can be torn by a kill; what is missing of it reads as the fill value.
  while (!steps.empty() && is_torn(file, steps.size() - 1)) {
    steps.pop_back();
  }
  return steps;
}

} // namespace boba::trajectory

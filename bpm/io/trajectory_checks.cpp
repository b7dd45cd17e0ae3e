// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory_checks.h"

#include "bpm/grain/sound_template.h"
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory_layout.h"
#include "bpm/io/usable_cell.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace boba::trajectory {

using hdf5::File;

namespace {

/// Sums beyond this are no stress, time or strain of a packing.
constexpr double largest_number = 1e100;

[[noreturn]] void refuse_frame(const File& file, std::int64_t frame, const std::string& why) {
  refuse_file(file, fmt::format("frame {}: {}", frame, why));
}

void check_element(const File& file, const std::string& name, File::Content content,
                   const std::vector<hsize_t>& frame_shape) {
  const File::Dataset dataset = file.look(name);
  if (dataset.content != content) {
    refuse_file(file,
                fmt::format("{} does not hold {} numbers", name, content == File::Content::integer ? "whole" : "real"));
  }
  if (dataset.shape.empty() ||
      !std::equal(dataset.shape.begin() + 1, dataset.shape.end(), frame_shape.begin(), frame_shape.end())) {
    refuse_file(file,
                fmt::format("{} has the shape [{}]; [frames{}{}] is needed", name, fmt::join(dataset.shape, " x "),
                            frame_shape.empty() ? "" : " x ", fmt::join(frame_shape, " x ")));
  }
}

void check_numbers(const File& file, std::int64_t frame, const Snapshot& snapshot) {
  const auto check = [&](const char* what, double value) {
    if (!(std::abs(value) <= largest_number)) {
      refuse_frame(file, frame, fmt::format("the {} is {:g}", what, value));
    }
  };
  check("time", snapshot.time);
  check("strain", snapshot.strain);
  check("streaming rate", snapshot.streaming_rate);
  for (const double share : snapshot.damage) {
    if (!(share >= 0.0 && share <= 1.0)) {
      refuse_frame(file, frame,
                   fmt::format("the share of a node's bonds that are broken is {:g}; allowed: 0 to 1", share));
    }
  }
  for (const std::array<double, 6>& stress : snapshot.grain_stress) {
    for (const double value : stress) {
      check("stress of a grain", value);
    }
  }
}

void check_vectors(const File& file, std::int64_t frame, const char* what, const std::vector<Vector3>& vectors) {
  const auto wrong = std::find_if_not(vectors.begin(), vectors.end(), is_usable_position);
  if (wrong != vectors.end()) {
    refuse_frame(file, frame,
                 fmt::format("the {} {} is {:g} {:g} {:g}; allowed: {:g} to {:g}", what, wrong - vectors.begin(),
                             (*wrong)[0], (*wrong)[1], (*wrong)[2], -largest_coordinate, largest_coordinate));
  }
}

void check_bonds(const File& file, std::int64_t frame, const Topology& topology, const Snapshot& snapshot) {
  const auto is_right = [](double length, double r0) {
    return length > 1e-9 * r0 && length <= largest_stored_stretch * r0;
  };
  // A lone grain may be a periodic specimen, whose bonds go through the faces of the cell.
  const bool may_cross = topology.n_grains() == 1;
  const auto may_be_broken = [&](const Topology::Pair& bond) {
    return !snapshot.damage.empty() && snapshot.damage[bond.i] > 0.0 && snapshot.damage[bond.j] > 0.0;
  };
  for (const Topology::Pair& bond : topology.bonds) {
    if (may_be_broken(bond)) {
      continue;
    }
    const Vector3 d = snapshot.position[bond.i] - snapshot.position[bond.j];
    if (!is_right(d.norm(), bond.r0) && !(may_cross && is_right(snapshot.box.minimum_image(d).norm(), bond.r0))) {
      refuse_frame(
          file, frame,
          fmt::format("the bond of nodes {} and {} is {:g} d long, {:g} at rest; allowed: up to {:g} times that",
                      topology.id[bond.i], topology.id[bond.j], d.norm(), bond.r0, largest_stored_stretch));
    }
  }
}

void check_centres(const File& file, std::int64_t frame, const Topology& topology, const Snapshot& snapshot) {
  for (int g = 0; g < topology.n_grains(); ++g) {
    Vector3 sum = Vector3::Zero();
    const auto nodes = snapshot.nodes_of(topology, g);
    for (const Vector3& x : nodes) {
      sum += x;
    }
    const Vector3 mean = sum / static_cast<double>(nodes.size()), &stored = snapshot.grain_centre[g];
    if (!((stored - mean).norm() <= 1e-4 + 1e-9 * mean.norm())) {
      refuse_frame(file, frame,
                   fmt::format("the centre of grain {} is {:g} {:g} {:g}; its nodes' mean is {:g} {:g} {:g}", g,
                               stored[0], stored[1], stored[2], mean[0], mean[1], mean[2]));
    }
  }
}

} // namespace

void check_growing(const File& file, const Topology& topology) {
  const auto n = static_cast<hsize_t>(topology.n_nodes()), n_grains = static_cast<hsize_t>(topology.n_grains());
  constexpr auto real = File::Content::real, integer = File::Content::integer;
  check_element(file, step_name(), integer, {});
  check_element(file, time_name(), real, {});
  check_element(file, value_of(position), real, {n, 3});
  check_element(file, value_of(image), integer, {n, 3});
  if (file.has(velocity)) {
    check_element(file, value_of(velocity), real, {n, 3});
  }
  if (file.has(damage)) {
    check_element(file, value_of(damage), real, {n});
  }
  check_element(file, value_of(edges), real, {3, 3});
  check_element(file, value_of(box_origin), real, {3});
  check_element(file, value_of(strain), real, {});
  if (file.has(streaming_rate)) {
    check_element(file, value_of(streaming_rate), real, {});
  }
  check_element(file, value_of(grain_centre), real, {n_grains, 3});
  check_element(file, value_of(grain_stress), real, {n_grains, 6});
}

Box checked_box(const File& file, std::int64_t frame, const std::vector<double>& corner, const std::vector<double>& h,
                const std::array<bool, 3>& periodic) {
  if (h[1] != 0.0 || h[2] != 0.0 || h[5] != 0.0) {
    refuse_frame(file, frame, "the cell's first vector must lie along x and its second in the plane of x and y");
  }
  const Vector3 origin(corner.data()), lengths(h[0], h[4], h[8]), tilts(h[3], h[6], h[7]);
  if (!is_usable_cell(lengths, tilts) || !is_usable_position(origin) || !is_usable_position(lengths)) {
    refuse_frame(
        file, frame,
        fmt::format("a cell of lengths {:g} {:g} {:g}, tilts {:g} {:g} {:g} and corner {:g} {:g} {:g} d cannot "
                    "be computed with",
                    h[0], h[4], h[8], h[3], h[6], h[7], origin[0], origin[1], origin[2]));
  }
  return Box(origin, lengths, tilts, periodic);
}

void check_frame(const File& file, std::int64_t frame, const Topology& topology, const Snapshot& snapshot) {
  check_numbers(file, frame, snapshot);
  check_vectors(file, frame, "position of node", snapshot.position);
  check_vectors(file, frame, "velocity of node", snapshot.velocity);
  check_vectors(file, frame, "centre of grain", snapshot.grain_centre);
  check_bonds(file, frame, topology, snapshot);
  check_centres(file, frame, topology, snapshot);
}

} // namespace boba::trajectory

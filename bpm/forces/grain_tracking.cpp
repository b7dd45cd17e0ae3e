// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/grain_tracking.h"

#include "bpm/forces/lane_kernels.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

/// Share of a grain's nodes with new places above which noting them all is cheaper than going on.
constexpr double largest_moved_share = 0.1;
/// Places are stored as floats: their rounding, up to hundreds of d from a grain's centre, stays below this, d.
constexpr double rounding = 1e-4;
/// Added to a grain's moments per node so that they can be inverted for flat and tiny grains, d^2.
constexpr double moments_floor = 1e-6;

template <class Coordinate, class Real>
kernels::FrameArraysOf<Coordinate> frame_arrays_of(const Block& block, const LaneArrays<Coordinate, Real>& arrays,
                                                   const float* places, double quantum) {
  return {arrays.x.data() + block.offset, places + block.offset, block.n_nodes, block.n_lanes, quantum};
}

} // namespace

GrainTracking::GrainTracking(const LaneLayout& layout, const kernels::KernelTable& table, const ContactReach& reach)
    : layout_(layout), table_(table), reach_(reach), fast_motion_(0.1 * reach.reserve()) {}

void GrainTracking::layout_changed() {
  place_.assign(layout_.size(), 0.0f);
  grains_.assign(layout_.n_grains(), {});
}

void GrainTracking::look(const LaneState& state, bool afresh) {
#pragma omp parallel for schedule(dynamic, 1)
  for (int b = 0; b < static_cast<int>(layout_.blocks().size()); ++b) {
    if (!afresh) {
      look_at_block(b, state);
    }
    for (const int grain : layout_.blocks()[b].grain) {
      if (grain >= 0) {
        if (afresh) {
          note_all(grain, state);
        }
        follow(grain, state);
      }
    }
  }
}

void GrainTracking::forget_news() {
  for (TrackedGrain& grain : grains_) {
    grain.all_noted = false;
    grain.moved.clear();
    grain.moved_to.clear();
  }
}

std::size_t GrainTracking::bytes() const {
  std::size_t bytes = place_.capacity() * sizeof(float);
  for (const TrackedGrain& grain : grains_) {
    bytes += grain.grid.bytes();
  }
  return bytes;
}

Vector3 GrainTracking::place(int grain, int node) const {
  const std::int64_t at = layout_.index(grain, node, 0), stride = layout_.stride(grain);
  return {place_[at], place_[at + stride], place_[at + 2 * stride]};
}

kernels::LaneFrames GrainTracking::fit_frames(int b, const LaneState& state) {
  const Block& block = layout_.blocks()[b];
  kernels::FrameFit fit{};
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    const int g = block.grain[lane];
    for (int c = 0; c < 3 && g >= 0; ++c) {
      fit.origin[c][lane] = grains_[g].frame.centre[c] - state.origin(g)[c];
    }
  }
  state.visit([&](const auto& arrays) {
    kernels_of(table_, arrays).fit_frames(frame_arrays_of(block, arrays, place_.data(), state.quantum()), fit);
  });
  kernels::LaneFrames frames{};
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    frames.threshold2[lane] = 1e300; // an idle lane never deviates
    const int g = block.grain[lane];
    if (g < 0) {
      continue;
    }
    TrackedGrain& grain = grains_[g];
    Matrix3 second;
    for (int c = 0; c < 9; ++c) {
      second(c / 3, c % 3) = fit.second[c][lane];
    }
    // The same addition as to the moments: what the nodes do not tell (all of it, for a single node) stays as noted.
    second += moments_floor * block.n_nodes * Matrix3::Identity();
    grain.frame.linear = second * grain.inverse_moments;
    for (int c = 0; c < 3; ++c) {
      grain.frame.centre[c] += fit.first[c][lane] / block.n_nodes;
      frames.centre[c][lane] = grain.frame.centre[c] - state.origin(g)[c];
    }
    for (int c = 0; c < 9; ++c) {
      frames.f[c][lane] = grain.frame.linear(c / 3, c % 3);
    }
    frames.threshold2[lane] = reach_.far2();
  }
  return frames;
}

void GrainTracking::look_at_block(int b, const LaneState& state) {
  thread_local std::vector<std::int32_t> far;
  const Block& block = layout_.blocks()[b];
  const kernels::LaneFrames frames = fit_frames(b, state);
  double largest2[max_lanes] = {};
  far.resize(static_cast<std::size_t>(block.n_nodes) * block.n_lanes);
  const std::int64_t n_far = state.visit([&](const auto& arrays) {
    return kernels_of(table_, arrays)
        .frame_residuals(frame_arrays_of(block, arrays, place_.data(), state.quantum()), frames, largest2, far.data());
  });
  for (std::int64_t k = 0; k < n_far; ++k) {
    grains_[block.grain[far[k] % block.n_lanes]].moved.push_back(far[k] / block.n_lanes);
  }
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    const int g = block.grain[lane];
    if (g >= 0) {
      grains_[g].deviation = std::sqrt(largest2[lane]) + rounding;
      if (out_of_shape(grains_[g], block.n_nodes) || !note_moved(g, state)) {
        note_all(g, state);
      }
    }
  }
}

bool GrainTracking::out_of_shape(const TrackedGrain& grain, int n_nodes) const {
  const double e = shortening(grain.frame.linear);
  return !(e <= ContactReach::largest_shortening) ||
         !(reach_.inside() * (1.0 - e) - 2.0 * grain.deviation >= reach_.inner_diameter() + reach_.reserve()) ||
         static_cast<double>(grain.n_moved + static_cast<std::int64_t>(grain.moved.size())) >
             largest_moved_share * n_nodes;
}

/// Notes the places of all nodes again: the frame starts as a mere translation.
void GrainTracking::note_all(int g, const LaneState& state) {
  TrackedGrain& grain = grains_[g];
  const int n_nodes = layout_.n_nodes(g);
  const std::int64_t stride = layout_.stride(g);
  // A position that is no number stands at the centre here; the drift finds its velocity and ends the run.
  const auto finite = [](double x) { return std::isfinite(x) ? x : 0.0; };
  Vector3 mean = Vector3::Zero();
  for (int node = 0; node < n_nodes; ++node) {
    mean += state.position(g, node).unaryExpr(finite);
  }
  mean /= n_nodes;
  const GrainFrame fresh = {Matrix3::Identity(), mean};
  // Where the neighbours' search had the grain, seen from its new places.
  grain.neighbour_frame = grain.neighbour_frame.after(grain.frame.inverse()).after(fresh);
  grain.frame = fresh;

  thread_local std::vector<Vector3> places;
  places.resize(n_nodes);
  Bounds bounds;
  Matrix3 moments = Matrix3::Zero();
  for (int node = 0; node < n_nodes; ++node) {
    const std::int64_t at = layout_.index(g, node, 0);
    const Vector3 x = (state.position(g, node) - mean).unaryExpr(finite);
    for (int c = 0; c < 3; ++c) {
      place_[at + c * stride] = static_cast<float>(x[c]);
      places[node][c] = place_[at + c * stride];
    }
    bounds.include(places[node]);
    grain.compare_with_neighbour_bounds(places[node]);
    moments += places[node] * places[node].transpose();
  }
  // A flat or tiny grain has no full set of moments: its frame then only turns and shears where it can.
  moments += moments_floor * n_nodes * Matrix3::Identity();
  grain.inverse_moments = moments.inverse();
  grain.grid = GrainGrid(places, bounds, reach_.between() / (1.0 - ContactReach::largest_shortening));
  grain.deviation = rounding;
  grain.moved.clear();
  grain.moved_to.clear();
  grain.n_moved = 0;
  grain.all_noted = true;
}

/// Gives the nodes that deviate far the places where they are. False when one has left the grain's bounds.
bool GrainTracking::note_moved(int g, const LaneState& state) {
  TrackedGrain& grain = grains_[g];
  const GrainFrame back = grain.frame.inverse();
  const Bounds allowed = grain.grid.bounds().widened(reach_.bounds_margin);
  const std::int64_t stride = layout_.stride(g);
  for (const std::int32_t node : grain.moved) {
    const std::int64_t at = layout_.index(g, node, 0);
    const Vector3 x = back(state.position(g, node));
    if (!allowed.contains(x)) {
      return false;
    }
    for (int c = 0; c < 3; ++c) {
      place_[at + c * stride] = static_cast<float>(x[c]);
    }
    grain.moved_to.push_back(place(g, node));
    grain.grid.insert(node, grain.moved_to.back());
    grain.compare_with_neighbour_bounds(grain.moved_to.back());
  }
  grain.n_moved += static_cast<int>(grain.moved.size());
  return true;
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/point_contacts.h"

#include "bpm/forces/contact_pair.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace boba {

namespace {

/// Widest skin over that of other packings, whose grains have skins inside too.
constexpr double skin_share = 1.6;

/// Least skin, d.
constexpr double least_skin = 0.03;

/// Skin over the square root of what the fastest node moves in a step, both in d. With w d of motion a step a list of
/// skin s lasts s / 2w steps and holds a share (1 + s)^3 more candidates than contacts; building takes as long as some
/// 200 candidates, so that the least time is near s = 3.5 sqrt(w).
constexpr double skin_of_motion = 3.5;

/// Of one thread, for a chunk at a time.
struct ChunkScratch {
  std::vector<double> terms;
  std::vector<std::int32_t> touching, last;
  std::vector<kernels::PointRow> shift, velocity;
  std::vector<kernels::PointSums> sums;

  /// Sums are of no contacts afterwards.
  void make_room(const PointChunk& chunk) {
    const auto n = static_cast<std::size_t>(kernels::touch_capacity(static_cast<std::int64_t>(chunk.other.size())));
    if (touching.size() < n) {
      touching.resize(n);
      terms.resize(kernels::point_terms * n);
    }
    last.resize(chunk.n_slots());
    shift.resize(chunk.images.size());
    velocity.resize(chunk.images.size());
    sums.assign(chunk.n_slots(), {{}, no_contacts});
  }
};

} // namespace

PointContacts::PointContacts(const LaneLayout& layout, const ContactModel& law, double skin)
    : layout_(layout), law_(law), widest_skin_(std::max(skin_share * skin, least_skin)), skin_(0.5 * widest_skin_) {}

bool PointContacts::serves(const LaneLayout& layout) {
  for (int g = 0; g < layout.n_grains(); ++g) {
    if (layout.n_nodes(g) != 1 || !layout.holds(g)) {
      return false;
    }
  }
  return layout.n_grains() > 0;
}

void PointContacts::prepare(const LaneState& state, const Box& box) {
  if (is_built_) {
    collect(state);
    ++steps_since_build_;
    if (holds(box)) {
      return;
    }
    choose_skin();
  }
  build(state, box);
}

void PointContacts::collect(const LaneState& state) {
  x_.resize(layout_.n_grains());
  v_.resize(layout_.n_grains());
  state.visit([&](const auto& lanes) {
    const int n_grains = layout_.n_grains();
#pragma omp parallel for schedule(static)
    for (int g = 0; g < n_grains; ++g) {
      kernels::PointRow &x = x_[list_.slot_of(g)], &v = v_[list_.slot_of(g)];
      const Vector3& origin = state.origin(g);
      for (int c = 0; c < 3; ++c) {
        const std::int64_t at = layout_.index(g, 0, c);
        if constexpr (std::is_same_v<std::decay_t<decltype(lanes.x[at])>, double>) {
          x.x[c] = lanes.x[at];
        } else {
          x.x[c] = origin[c] + state.quantum() * lanes.x[at];
        }
        v.x[c] = lanes.v[at];
      }
      x.x[3] = v.x[3] = 0.0;
    }
  });
}

bool PointContacts::holds(const Box& box) {
  const Matrix3 cell = box.h() * h_inverse_at_build_;
  const Vector3 shift = box.origin() - cell * origin_at_build_;
  const auto n_nodes = static_cast<std::int64_t>(x_.size());
  double moved2 = 0.0;
#pragma omp parallel for schedule(static) reduction(max : moved2)
  for (std::int64_t slot = 0; slot < n_nodes; ++slot) {
    const Vector3 carried = cell * at_build_[slot] + shift;
    const double* x = x_[slot].x;
    moved2 = std::max(moved2, (Vector3(x[0], x[1], x[2]) - carried).squaredNorm());
  }
  moved_ = std::sqrt(moved2);
  const double stretch = 1.0 - (cell - Matrix3::Identity()).norm();
  return stretch * (law_.range() + skin_) - 2.0 * moved_ >= law_.range();
}

void PointContacts::choose_skin() {
  const double in_a_step = moved_ / static_cast<double>(std::max<std::int64_t>(1, steps_since_build_));
  skin_ = std::clamp(skin_of_motion * std::sqrt(in_a_step), least_skin, widest_skin_);
}

void PointContacts::build(const LaneState& state, const Box& box) {
  std::vector<Vector3> position(layout_.n_grains());
  for (int g = 0; g < layout_.n_grains(); ++g) {
    position[g] = state.position(g, 0);
  }
  list_.build(position, box, law_.range() + skin_);
  at_build_.resize(position.size());
  for (int g = 0; g < layout_.n_grains(); ++g) {
    at_build_[list_.slot_of(g)] = position[g];
  }
  h_inverse_at_build_ = box.h_inverse();
  origin_at_build_ = box.origin();
  collect(state);
  steps_since_build_ = 0;
  is_built_ = true;
  ++n_builds_;
}

void PointContacts::evaluate(Precision precision, const Box& box, const Evaluation& what, ForceSums& sums) {
  if (precision == Precision::full) {
    evaluate_in(force_, box, what, sums);
  } else {
    evaluate_in(force_in_floats_, box, what, sums);
  }
}

template <class Real>
void PointContacts::evaluate_in(std::vector<Real>& force, const Box& box, const Evaluation& what, ForceSums& sums) {
  force.resize(3 * static_cast<std::size_t>(layout_.n_grains()));
  const kernels::PointSumming how = {std::is_same_v<Real, float>, what.virial != Virial::none};
  const std::vector<PointChunk>& chunks = list_.chunks();
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < chunks.size(); ++k) {
    const PointChunk& chunk = chunks[k];
    thread_local ChunkScratch scratch_of_thread;
    ChunkScratch& scratch = scratch_of_thread;
    scratch.make_room(chunk);
    for (std::size_t n = 0; n < chunk.images.size(); ++n) {
      const ImageVector& image = chunk.images[n];
      const Vector3 turns(image.a, image.b, image.c);
      const Vector3 x = box.h() * turns, v = what.residual_rate * turns;
      scratch.shift[n] = {{x[0], x[1], x[2], 0.0}};
      scratch.velocity[n] = {{v[0], v[1], v[2], 0.0}};
    }
    law_.evaluate({chunk.first.data(), chunk.other.data(), chunk.image.data(), x_.data(), v_.data(),
                   scratch.shift.data(), scratch.velocity.data(), chunk.begin, chunk.n_slots()},
                  how,
                  {scratch.terms.data(), static_cast<std::int64_t>(scratch.touching.size()), scratch.touching.data(),
                   scratch.last.data()},
                  scratch.sums.data());
    for (std::int32_t node = 0; node < chunk.n_slots(); ++node) {
      const int grain = list_.grain_of(chunk.begin + node);
      for (int c = 0; c < 3; ++c) {
        force[3 * static_cast<std::size_t>(grain) + c] = static_cast<Real>(scratch.sums[node].force[c]);
      }
      if (how.with_contacts) {
        sums.contacts[grain] = scratch.sums[node].contacts;
      }
    }
  }
}

template <class Real> void PointContacts::add_from(const std::vector<Real>& force, const Block& block, Real* f) const {
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    if (const int grain = block.grain[lane]; grain >= 0) {
      for (int c = 0; c < 3; ++c) {
        f[c * block.n_lanes + lane] += force[3 * static_cast<std::size_t>(grain) + c];
      }
    }
  }
}

void PointContacts::add(const Block& block, double* f) const {
  add_from(force_, block, f);
}

void PointContacts::add(const Block& block, float* f) const {
  add_from(force_in_floats_, block, f);
}

std::size_t PointContacts::bytes() const {
  return list_.bytes() + (x_.capacity() + v_.capacity()) * sizeof(kernels::PointRow) +
         at_build_.capacity() * sizeof(Vector3) + force_.capacity() * sizeof(double) +
         force_in_floats_.capacity() * sizeof(float);
}

} // namespace boba

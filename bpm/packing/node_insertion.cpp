// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/node_insertion.h"

#include "bpm/grain/near_pairs.h"
#include "bpm/grain/random.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

namespace boba {

namespace {

constexpr double roundest = 1.3;
constexpr int tries = 2000;          ///< of a grain before the others are shifted
constexpr int rounds = 20;           ///< of shifting for one grain
constexpr int sweeps = 5;            ///< of all grains a round
constexpr double shift_share = 0.1;  ///< of a grain's radius that it shifts by at most
constexpr double largest_turn = 0.2; ///< rad

struct Pose {
  Vector3 centre;
  Eigen::Quaterniond rotation;
};

double gyration_radius(const GrainTemplate& grain) {
  double squares = 0.0;
  for (const Vector3& x : grain.position) {
    squares += x.squaredNorm();
  }
  return std::sqrt(squares / grain.n_nodes());
}

/// The nodes of the grains that have been placed, in cells of a periodic cube.
class PlacedNodes {
public:
  PlacedNodes(const Insertion& insertion, double edge)
      : insertion_(insertion), edge_(edge), reach2_(insertion.diameter * insertion.diameter),
        n_(static_cast<int>(std::clamp(edge / insertion.diameter, 1.0, most_cells))),
        head_(static_cast<std::size_t>(n_) * n_ * n_, -1) {
    std::int64_t nodes = 0;
    for (const Grain& grain : insertion.grains) {
      first_.push_back(nodes);
      nodes += template_of(grain).n_nodes();
    }
    x_.resize(nodes);
    next_.assign(nodes, -1);
    for (const auto& grain : insertion.templates) { // the outermost nodes are the first to meet others
      std::vector<int> order(grain->position.size());
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return grain->position[a].squaredNorm() > grain->position[b].squaredNorm();
      });
      outermost_first_.push_back(std::move(order));
    }
  }

  const GrainTemplate& template_of(const Grain& grain) const { return *insertion_.templates[grain.template_index]; }

  /// True when no node of the grain in this pose is too near to one that has been placed.
  bool fits(int g, const Pose& pose) const {
    const Grain& grain = insertion_.grains[g];
    const Eigen::Matrix3d turn = pose.rotation.toRotationMatrix();
    for (const int node : outermost_first_[grain.template_index]) {
      if (is_taken(into_cell(pose.centre + turn * template_of(grain).position[node]))) {
        return false;
      }
    }
    return true;
  }

  void add(int g, const Pose& pose) {
    const GrainTemplate& grain = template_of(insertion_.grains[g]);
    const Eigen::Matrix3d turn = pose.rotation.toRotationMatrix();
    for (int node = 0; node < grain.n_nodes(); ++node) {
      const std::int64_t n = first_[g] + node;
      x_[n] = into_cell(pose.centre + turn * grain.position[node]);
      std::int64_t& head = head_[cell_of(x_[n])];
      next_[n] = head;
      head = n;
    }
  }

  void remove(int g) {
    const int n_nodes = template_of(insertion_.grains[g]).n_nodes();
    for (std::int64_t n = first_[g]; n < first_[g] + n_nodes; ++n) {
      std::int64_t* at = &head_[cell_of(x_[n])];
      while (*at != n) {
        at = &next_[*at];
      }
      *at = next_[n];
    }
  }

private:
  static constexpr double most_cells = 256.0; ///< along an edge

  Vector3 into_cell(const Vector3& x) const {
    Vector3 result = x;
    for (double& c : result) {
      c -= edge_ * std::floor(c / edge_);
    }
    return result;
  }
  int cell_along(double c) const { return std::min(static_cast<int>(c / edge_ * n_), n_ - 1); }
  std::size_t cell_of(const Vector3& x) const {
    return (static_cast<std::size_t>(cell_along(x.z())) * n_ + cell_along(x.y())) * n_ + cell_along(x.x());
  }

  bool is_taken(const Vector3& x) const {
    const int reach = std::min(1, n_ - 1), cell[3] = {cell_along(x.x()), cell_along(x.y()), cell_along(x.z())};
    for (int c = cell[2] - reach; c <= cell[2] + reach; ++c) {
      for (int b = cell[1] - reach; b <= cell[1] + reach; ++b) {
        for (int a = cell[0] - reach; a <= cell[0] + reach; ++a) {
          const std::size_t place = (static_cast<std::size_t>((c + n_) % n_) * n_ + (b + n_) % n_) * n_ + (a + n_) % n_;
          for (std::int64_t other = head_[place]; other >= 0; other = next_[other]) {
            if (wrapped(x_[other] - x, Vector3::Constant(edge_)).squaredNorm() < reach2_) {
              return true;
            }
          }
        }
      }
    }
    return false;
  }

  const Insertion& insertion_;
  double edge_, reach2_;
  int n_;
  std::vector<std::int64_t> head_, first_, next_;
  std::vector<Vector3> x_;
  std::vector<std::vector<int>> outermost_first_;
};

/// The placement of all grains, largest first.
class Addition {
public:
  Addition(const Insertion& insertion, double edge)
      : insertion_(insertion), edge_(edge), placed_(insertion, edge), random_(insertion.seed),
        poses_(insertion.grains.size()) {
    for (const Grain& grain : insertion.grains) {
      radii_.push_back(bounding_radius(placed_.template_of(grain), insertion.diameter));
      if (2.0 * radii_.back() > edge) {
        throw std::invalid_argument(fmt::format("insert: a grain {:.3g} d long does not fit into the cell of edge "
                                                "{:.3g} d; use a smaller packing_fraction",
                                                2.0 * radii_.back(), edge));
      }
    }
    order_.resize(poses_.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return radii_[a] > radii_[b]; });
  }

  std::vector<Pose> run() {
    for (std::size_t n = 0; n < order_.size(); ++n) {
      bool is_in = add_at_random(order_[n]);
      for (int round = 0; !is_in && round < rounds; ++round) {
        shift_all(n);
        is_in = add_at_random(order_[n]);
      }
      if (!is_in) {
        throw std::runtime_error(fmt::format("insert: {} of {} grains found a place at packing_fraction = {:g}; use a "
                                             "smaller one, and compress afterwards",
                                             n, order_.size(), insertion_.packing_fraction));
      }
    }
    return poses_;
  }

private:
  bool add_at_random(int g) {
    for (int attempt = 0; attempt < tries; ++attempt) {
      const Vector3 centre = Vector3::Constant(0.5 * edge_) + random_.vector(0.5 * edge_);
      const Pose pose = {centre, insertion_.rotate ? random_rotation(random_) : Eigen::Quaterniond::Identity()};
      if (placed_.fits(g, pose)) {
        poses_[g] = pose;
        placed_.add(g, pose);
        return true;
      }
    }
    return false;
  }

  /// Small random steps of the first `n_placed` grains, each refused where it would make an overlap.
  void shift_all(std::size_t n_placed) {
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      for (std::size_t n = 0; n < n_placed; ++n) {
        const int g = order_[n];
        Pose pose = poses_[g];
        pose.centre += random_.vector(shift_share * radii_[g]);
        if (insertion_.rotate) {
          const Vector3 axis = random_.vector(1.0).normalized();
          pose.rotation = (Eigen::AngleAxisd(random_.uniform(0.0, largest_turn), axis) * pose.rotation).normalized();
        }
        placed_.remove(g);
        if (placed_.fits(g, pose)) {
          poses_[g] = pose;
        }
        placed_.add(g, poses_[g]);
      }
    }
  }

  const Insertion& insertion_;
  double edge_;
  PlacedNodes placed_;
  Random random_;
  std::vector<Pose> poses_;
  std::vector<double> radii_;
  std::vector<int> order_;
};

} // namespace

bool are_round(const Insertion& insertion) {
  return std::all_of(insertion.templates.begin(), insertion.templates.end(), [&](const auto& grain) {
    const double half = 0.5 * insertion.diameter, ball = std::sqrt(5.0 / 3.0) * gyration_radius(*grain) + half;
    return std::pow(bounding_radius(*grain, insertion.diameter) / ball, 3) <= roundest;
  });
}

Packing insert_by_nodes(const Insertion& insertion) {
  const double edge = insertion_edge(insertion);
  const std::vector<Pose> poses = Addition(insertion, edge).run();
  std::vector<Placement> placements;
  for (std::size_t g = 0; g < poses.size(); ++g) {
    placements.push_back({insertion.grains[g], poses[g].centre, poses[g].rotation});
  }
  return make_packing(Box(Vector3::Zero(), Vector3::Constant(edge)), insertion.templates, placements);
}

} // namespace boba

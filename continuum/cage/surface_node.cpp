// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/cage/surface_node.h"

#include <algorithm>
#include <numeric>

namespace boba::continuum {

Eigen::Vector3d normal_along_mirrors(Eigen::Vector3d normal, const SurfaceNode& node) {
  for (int c = 0; c < 3; ++c) {
    normal[c] = node.mirrored[std::size_t(c)] ? 0 : normal[c];
  }
  return normal;
}

namespace {

/// A normal adds a direction of its own when more than this share of it is across the others.
constexpr double independent_share = 0.02;

/// All planes, nearest to the undeformed node first.
std::vector<int> by_nearness(const SurfaceNode& node, const std::vector<Plane>& planes) {
  std::vector<int> order(planes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto reach = [&](int k) {
    const Plane& plane = planes[std::size_t(k)];
    return plane.normal.dot(node.place) / plane.distance;
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return reach(a) > reach(b) * (1 + 1e-12); });
  return order;
}

/// Orthonormal directions, grown one by one.
struct Directions {
  std::vector<Eigen::Vector3d> found;

  Eigen::Vector3d across(const Eigen::Vector3d& v) const {
    Eigen::Vector3d w = v;
    for (int pass = 0; pass < 2; ++pass) {
      for (const auto& q : found) {
        w -= q.dot(w) * q;
      }
    }
    return w;
  }
  bool add(const Eigen::Vector3d& v) {
    const Eigen::Vector3d w = across(v);
    if (!(w.norm() > independent_share * std::max(v.norm(), 0.1))) {
      return false;
    }
    found.push_back(w.normalized());
    return true;
  }
};

Directions directions_of(const SurfaceNode& node, const std::vector<Plane>& planes, const std::vector<int>& held) {
  Directions result;
  for (const int k : held) {
    result.add(normal_along_mirrors(planes[std::size_t(k)].normal, node));
  }
  return result;
}

int n_free(const SurfaceNode& node) {
  return int(std::count(node.mirrored.begin(), node.mirrored.end(), false));
}

void sort_held(SurfaceNode& node, const std::vector<int>& order) {
  std::sort(node.held.begin(), node.held.end(), [&](int a, int b) {
    return std::find(order.begin(), order.end(), a) < std::find(order.begin(), order.end(), b);
  });
}

/// Takes the place of the held plane whose normal is most nearly the same.
void replace_nearest(SurfaceNode& node, const std::vector<Plane>& planes, int k) {
  const Eigen::Vector3d n = normal_along_mirrors(planes[std::size_t(k)].normal, node).normalized();
  const auto likeness = [&](int l) {
    return n.dot(normal_along_mirrors(planes[std::size_t(l)].normal, node).normalized());
  };
  *std::max_element(node.held.begin(), node.held.end(), [&](int a, int b) { return likeness(a) < likeness(b); }) = k;
}

} // namespace

NodeFrame frame_of(const SurfaceNode& node, const std::vector<Plane>& planes) {
  NodeFrame frame;
  Directions directions = directions_of(node, planes, node.held);
  const auto free = std::size_t(n_free(node));
  for (const int k : by_nearness(node, planes)) {
    if (directions.found.size() < free) {
      directions.add(normal_along_mirrors(planes[std::size_t(k)].normal, node));
    }
  }
  for (int c = 0; c < 3 && directions.found.size() < free; ++c) {
    directions.add(normal_along_mirrors(Eigen::Vector3d::Unit(c), node));
  }
  std::size_t next = 0;
  std::array<int, 3> columns{};
  for (int c = 0; c < 3; ++c) {
    if (!node.mirrored[std::size_t(c)]) {
      columns[next] = c;
      frame.basis.col(c) = directions.found[next++];
    }
  }
  frame.column = columns;
  for (std::size_t k = 0; k < node.held.size(); ++k) {
    const Eigen::Vector3d n = normal_along_mirrors(planes[std::size_t(node.held[k])].normal, node);
    for (std::size_t j = 0; j <= k; ++j) {
      frame.triangle(Eigen::Index(j), Eigen::Index(k)) = n.dot(directions.found[j]);
    }
  }
  return frame;
}

std::vector<double> held_displacements(const SurfaceNode& node, const NodeFrame& frame,
                                       const std::vector<Plane>& planes) {
  std::vector<double> position, result;
  for (std::size_t k = 0; k < node.held.size(); ++k) {
    double rest = planes[std::size_t(node.held[k])].distance;
    for (std::size_t j = 0; j < k; ++j) {
      rest -= frame.triangle(Eigen::Index(j), Eigen::Index(k)) * position[j];
    }
    position.push_back(rest / frame.triangle(Eigen::Index(k), Eigen::Index(k)));
    result.push_back(position.back() - frame.basis.col(frame.column[k]).dot(node.place));
  }
  return result;
}

std::vector<double> plane_forces(const SurfaceNode& node, const NodeFrame& frame, const Eigen::Vector3d& force) {
  std::vector<double> result(node.held.size());
  for (std::size_t k = node.held.size(); k-- > 0;) {
    double rest = frame.basis.col(frame.column[k]).dot(force);
    for (std::size_t l = k + 1; l < node.held.size(); ++l) {
      rest -= frame.triangle(Eigen::Index(k), Eigen::Index(l)) * result[l];
    }
    result[k] = rest / frame.triangle(Eigen::Index(k), Eigen::Index(k));
  }
  return result;
}

Eigen::VectorXd shared_forces(const SurfaceNode& node, const std::vector<Plane>& planes, const Eigen::Vector3d& u,
                              const Eigen::Vector3d& force) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(Eigen::Index(planes.size()));
  const std::vector<double> forces = plane_forces(node, frame_of(node, planes), force);
  for (std::size_t k = 0; k < node.held.size(); ++k) {
    const Plane& held = planes[std::size_t(node.held[k])];
    const Eigen::Vector3d normal = normal_along_mirrors(held.normal, node);
    std::vector<Eigen::Index> sharing;
    for (std::size_t l = 0; l < planes.size(); ++l) {
      const bool alike = (normal_along_mirrors(planes[l].normal, node) - normal).norm() < 1e-9;
      if (alike && overlap(node, planes[l], u) > -1e-9 * held.distance) {
        sharing.push_back(Eigen::Index(l));
      }
    }
    for (const Eigen::Index l : sharing) {
      result[l] += forces[k] / double(sharing.size());
    }
  }
  return result;
}

double overlap(const SurfaceNode& node, const Plane& plane, const Eigen::Vector3d& u) {
  return normal_along_mirrors(plane.normal, node).dot(node.place + u) - plane.distance;
}

Contradiction& Contradiction::operator+=(const Contradiction& other) {
  changes += other.changes;
  pull = std::max(pull, other.pull);
  overlap = std::max(overlap, other.overlap);
  return *this;
}

Contradiction update_planes(SurfaceNode& node, const std::vector<Plane>& planes, const Eigen::Vector3d& u,
                            const Eigen::Vector3d& force, const Contradiction& smallest) {
  Contradiction found;
  const std::vector<double> forces = plane_forces(node, frame_of(node, planes), force);
  std::vector<int> kept;
  for (std::size_t k = 0; k < node.held.size(); ++k) {
    if (forces[k] < -smallest.pull) {
      found += {1, -forces[k], 0};
    } else {
      kept.push_back(node.held[k]);
    }
  }
  const std::vector<int> before = node.held;
  node.held = kept;
  const std::vector<int> order = by_nearness(node, planes);
  for (const int k : order) {
    const double beyond = overlap(node, planes[std::size_t(k)], u);
    if (beyond <= smallest.overlap || std::find(before.begin(), before.end(), k) != before.end()) {
      continue;
    }
    found += {1, 0, beyond};
    Directions directions = directions_of(node, planes, node.held);
    if (int(node.held.size()) < n_free(node) &&
        directions.add(normal_along_mirrors(planes[std::size_t(k)].normal, node))) {
      node.held.push_back(k);
    } else if (!node.held.empty()) {
      replace_nearest(node, planes, k);
    }
  }
  sort_held(node, order);
  return found;
}

void guess_planes(SurfaceNode& node, const std::vector<Plane>& planes, double radius) {
  node.held.clear();
  for (const int k : by_nearness(node, planes)) {
    const Plane& plane = planes[std::size_t(k)];
    if (plane.normal.dot(node.place) > 0.5 * (radius + plane.distance) && node.held.empty()) {
      node.held.push_back(k);
    }
  }
}

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/template_matching.h"

#include "bpm/measure/parallel_loop.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace boba::measure {

namespace {

constexpr int max_neighbours = 14;

/// Neighbours of one lattice site, the mean distance 1. Points 0 and 1 enclose a typical angle and start the search.
struct Template {
  Lattice lattice;
  std::vector<Vector3> points;
};

Template scaled_template(Lattice lattice, std::vector<Vector3> points) {
  double mean = 0.0;
  for (const Vector3& w : points) {
    mean += w.norm() / static_cast<double>(points.size());
  }
  for (Vector3& w : points) {
    w /= mean;
  }
  return {lattice, std::move(points)};
}

std::vector<Vector3> fcc_points() {
  std::vector<Vector3> points;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double a : {1.0, -1.0}) {
      for (const double b : {1.0, -1.0}) {
        Vector3 w = Vector3::Zero();
        w[axis] = a;
        w[(axis + 1) % 3] = b;
        points.push_back(w);
      }
    }
  }
  std::swap(points[1], points[4]); // (1, 1, 0) and (0, 1, 1)
  return points;
}

std::vector<Vector3> hcp_points() {
  std::vector<Vector3> points;
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::numbers::pi / 3.0;
    points.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  for (const double side : {1.0, -1.0}) {
    for (int k = 0; k < 3; ++k) {
      const double angle = (4 * k + 1) * std::numbers::pi / 6.0;
      points.emplace_back(std::cos(angle) / std::sqrt(3.0), std::sin(angle) / std::sqrt(3.0),
                          side * std::sqrt(2.0 / 3.0));
    }
  }
  return points;
}

std::vector<Vector3> axis_points(double length) {
  std::vector<Vector3> points;
  for (int axis = 0; axis < 3; ++axis) {
    points.push_back(length * Vector3::Unit(axis));
    points.push_back(-length * Vector3::Unit(axis));
  }
  return points;
}

std::vector<Vector3> bcc_points() {
  std::vector<Vector3> points = axis_points(1.0);
  for (int k = 0; k < 8; ++k) {
    points.emplace_back(k & 1 ? -0.5 : 0.5, k & 2 ? -0.5 : 0.5, k & 4 ? -0.5 : 0.5);
  }
  std::swap(points[1], points[6]); // a corner, beside (1, 0, 0)
  return points;
}

std::vector<Vector3> sc_points() {
  std::vector<Vector3> points = axis_points(1.0);
  std::swap(points[1], points[2]);
  return points;
}

std::vector<Vector3> icosahedron_points() {
  const double golden = (1.0 + std::sqrt(5.0)) / 2.0;
  std::vector<Vector3> points;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double tall : {golden, -golden}) {
      for (const double one : {1.0, -1.0}) {
        Vector3 w = Vector3::Zero();
        w[axis] = one;
        w[(axis + 1) % 3] = tall;
        points.push_back(w);
      }
    }
  }
  return points;
}

const std::array<Template, 5>& lattice_templates() {
  static const std::array<Template, 5> templates = {
      scaled_template(Lattice::fcc, fcc_points()), scaled_template(Lattice::hcp, hcp_points()),
      scaled_template(Lattice::bcc, bcc_points()), scaled_template(Lattice::sc, sc_points()),
      scaled_template(Lattice::icosahedral, icosahedron_points())};
  return templates;
}

using Assignment = std::array<std::int8_t, max_neighbours>; ///< per point of the template: which neighbour

/// Columns along the bisector of two directions, across it in their plane, and normal to it.
Matrix3 frame_of(const Vector3& a, const Vector3& b) {
  Matrix3 frame;
  frame.col(0) = (a.normalized() + b.normalized()).normalized();
  frame.col(1) = (a.normalized() - b.normalized()).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

/// Gives each turned point of the template its nearest neighbour; nothing when two points want the same one.
std::optional<Assignment> assign_nearest(const Template& shape, const Matrix3& turn, std::span<const Vector3> p) {
  Assignment assignment{};
  unsigned taken = 0;
  for (std::size_t i = 0; i < shape.points.size(); ++i) {
    const Vector3 w = turn * shape.points[i];
    int nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < shape.points.size(); ++j) {
      const double distance = (p[j] - w).squaredNorm();
      if (distance < least) {
        least = distance;
        nearest = static_cast<int>(j);
      }
    }
    if (taken & (1U << nearest)) {
      return std::nullopt;
    }
    taken |= 1U << nearest;
    assignment[i] = static_cast<std::int8_t>(nearest);
  }
  return assignment;
}

/// The best similarity from a template to the neighbours, for one assignment.
struct TemplateFit {
  Assignment assignment{};
  double rmsd = std::numeric_limits<double>::infinity();
  Matrix3 turn = Matrix3::Identity(); ///< template to neighbours, scaled to the neighbours' own mean distance
};

/// Sums over the grain itself and its neighbours; the template's points add up to nothing.
struct FitMoments {
  Matrix3 product = Matrix3::Zero(); ///< sum (p - mean p) w^T
  double p_square = 0.0, w_square = 0.0;
};

FitMoments fit_moments(const Template& shape, const Assignment& assignment, std::span<const Vector3> p) {
  FitMoments m;
  Vector3 mean = Vector3::Zero();
  const auto n = static_cast<double>(shape.points.size() + 1);
  for (std::size_t i = 0; i < shape.points.size(); ++i) {
    const Vector3& x = p[assignment[i]];
    m.product += x * shape.points[i].transpose();
    m.p_square += x.squaredNorm();
    m.w_square += shape.points[i].squaredNorm();
    mean += x / n;
  }
  m.p_square -= n * mean.squaredNorm();
  return m;
}

/// The rotation R with the largest sum of p . R w is the eigenvector, as a quaternion, of the largest eigenvalue of a
/// symmetric matrix; the sum is that eigenvalue. Source: Horn, J. Opt. Soc. Am. A 4, 629 (1987).
Eigen::Matrix4d horn_matrix(const Matrix3& product) {
  const Matrix3 s = product.transpose(); // sum w p^T
  const Matrix3 sum = s + s.transpose();
  const Vector3 axis(s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0));
  Eigen::Matrix4d n;
  n(0, 0) = s.trace();
  n.block<1, 3>(0, 1) = axis.transpose();
  n.block<3, 1>(1, 0) = axis;
  n.block<3, 3>(1, 1) = sum - s.trace() * Matrix3::Identity();
  return n;
}

TemplateFit fit_similarity(const Template& shape, const Assignment& assignment, std::span<const Vector3> p) {
  const FitMoments m = fit_moments(shape, assignment, p);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(horn_matrix(m.product));
  const double trace = solver.eigenvalues()[3];
  TemplateFit result{assignment, std::numeric_limits<double>::infinity(), Matrix3::Identity()};
  if (trace > 0.0) {
    const double square = m.w_square - trace * trace / m.p_square;
    result.rmsd = std::sqrt(std::max(0.0, square) / static_cast<double>(shape.points.size() + 1));
    const Eigen::Vector4d q = solver.eigenvectors().col(3);
    result.turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix() * (trace / m.w_square);
  }
  return result;
}

/// Equivalent shear of the best affine map from the template to the neighbours; infinite when it is singular.
double equivalent_shear(const Template& shape, const Assignment& assignment, std::span<const Vector3> p) {
  Matrix3 second = Matrix3::Zero();
  for (const Vector3& w : shape.points) {
    second += w * w.transpose();
  }
  const Matrix3 map = fit_moments(shape, assignment, p).product * second.inverse();
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(map.transpose() * map, Eigen::EigenvaluesOnly);
  const Vector3 squares = solver.eigenvalues();
  if (!(squares.minCoeff() > 0.0)) {
    return std::numeric_limits<double>::infinity();
  }
  const Eigen::Array3d logs = 0.5 * squares.array().log();
  return std::sqrt(2.0 * (logs - logs.mean()).square().sum());
}

/// Fits and assigns in turns, from a first turn of the template on, until nothing changes.
TemplateFit settled_fit(const Template& shape, const Matrix3& first_turn, std::span<const Vector3> p) {
  constexpr int max_rounds = 3;
  TemplateFit best;
  Matrix3 turn = first_turn;
  for (int round = 0; round < max_rounds; ++round) {
    const std::optional<Assignment> assignment = assign_nearest(shape, turn, p);
    if (!assignment || (round > 0 && *assignment == best.assignment)) {
      break;
    }
    const TemplateFit found = fit_similarity(shape, *assignment, p);
    if (found.rmsd >= best.rmsd) {
      break;
    }
    best = found;
    turn = found.turn;
  }
  return best;
}

/// The best fit over all ways to lay points 0 and 1 of the template onto two neighbours at about their angle.
TemplateFit best_fit(const Template& shape, std::span<const Vector3> p) {
  constexpr double angle_tolerance = 0.5; // rad
  // Ways that no symmetry of the template connects differ by about one neighbour distance for two points or more.
  constexpr double certain = 0.15;
  const std::size_t n = shape.points.size();
  const Vector3 &w0 = shape.points[0], &w1 = shape.points[1];
  const double angle = std::acos(std::clamp(w0.normalized().dot(w1.normalized()), -1.0, 1.0));
  const double least = std::cos(angle + angle_tolerance), most = std::cos(angle - angle_tolerance);
  const Matrix3 back = frame_of(w0, w1).transpose();
  TemplateFit best;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double cosine = p[i].dot(p[j]) / (p[i].norm() * p[j].norm());
      if (i == j || cosine < least || cosine > most) {
        continue;
      }
      const TemplateFit found = settled_fit(shape, frame_of(p[i], p[j]) * back, p);
      if (found.rmsd < best.rmsd) {
        best = found;
      }
      if (best.rmsd < certain) {
        return best;
      }
    }
  }
  return best;
}

/// The nearest neighbours in units of their mean distance.
std::vector<Vector3> scaled_vectors(std::span<const Neighbour> neighbours) {
  std::vector<Vector3> p;
  double mean = 0.0;
  for (const Neighbour& neighbour : neighbours) {
    p.push_back(neighbour.vector);
    mean += neighbour.vector.norm() / static_cast<double>(neighbours.size());
  }
  for (Vector3& x : p) {
    x /= mean;
  }
  return p;
}

/// Number of neighbours that the template of a lattice has.
std::size_t n_points(Lattice lattice) {
  const auto& templates = lattice_templates();
  const auto shape =
      std::find_if(templates.begin(), templates.end(), [&](const Template& t) { return t.lattice == lattice; });
  return shape == templates.end() ? 0 : shape->points.size();
}

void check_template_options(const TemplateOptions& options) {
  if (!(options.max_rmsd > 0.0) || !(options.max_shear > 0.0)) {
    throw std::invalid_argument(fmt::format("template matching: max_rmsd is {} and max_shear {}; both must be positive",
                                            options.max_rmsd, options.max_shear));
  }
}

} // namespace

std::string_view name_of(Lattice lattice) {
  constexpr std::array<std::string_view, n_lattices> names = {"unknown", "fcc", "hcp", "bcc", "sc", "icosahedral"};
  return names[static_cast<std::size_t>(lattice)];
}

TemplateMatch match_templates(std::span<const Neighbour> neighbours, const TemplateOptions& options) {
  TemplateMatch match;
  double least = std::numeric_limits<double>::infinity();
  for (const Template& shape : lattice_templates()) {
    if (neighbours.size() < shape.points.size()) {
      continue;
    }
    const std::vector<Vector3> p = scaled_vectors(neighbours.first(shape.points.size()));
    const TemplateFit found = best_fit(shape, p);
    if (found.rmsd < least) {
      least = found.rmsd;
      match.nearest = shape.lattice;
      match.rmsd = found.rmsd;
      match.shear = equivalent_shear(shape, found.assignment, p);
    }
  }
  if (match.rmsd <= options.max_rmsd && match.shear <= options.max_shear) {
    match.lattice = match.nearest;
  }
  return match;
}

std::vector<TemplateMatch> match_templates(const Box& box, std::span<const Vector3> centres,
                                           const TemplateOptions& options) {
  check_template_options(options);
  const NeighbourLists neighbours = nearest_neighbours(box, centres, max_neighbours);
  std::vector<TemplateMatch> matches(centres.size());
  parallel_loop(static_cast<std::int64_t>(centres.size()), [&](std::int64_t grain) {
    const std::vector<Neighbour>& list = neighbours[grain];
    TemplateMatch& match = matches[grain];
    match = match_templates(list, options);
    const auto compared = list.begin() + static_cast<std::ptrdiff_t>(n_points(match.nearest));
    if (std::any_of(list.begin(), compared, [&](const Neighbour& n) { return n.grain == grain; })) {
      match.lattice = Lattice::unknown;
    }
  });
  return matches;
}

std::array<int, n_lattices> count_lattices(const std::vector<TemplateMatch>& matches) {
  std::array<int, n_lattices> counts{};
  for (const TemplateMatch& match : matches) {
    ++counts[static_cast<std::size_t>(match.lattice)];
  }
  return counts;
}

} // namespace boba::measure

// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/specimen/bulk_cut.h"

#include "bpm/grain/bond_network.h"
#include "bpm/grain/outline.h"
#include "bpm/grain/random.h"
#include "bpm/grain/spatial_order.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::calibration {

namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

constexpr double firm_hold = 0.1; // of the smallest eigenvalue of sum e e^T; boba::floating_part asks for half of it
constexpr int fewest_bonds = 4;
constexpr int most_rounds = 20;

Vector3 period_of(const GrainTemplate& box) {
  if (!box.period) {
    throw std::invalid_argument("a bulk must be a periodic box");
  }
  return *box.period;
}

/// Uniform over all rotations: a normalised quaternion of uniform direction.
Matrix3 random_rotation(Random& random) {
  Eigen::Vector4d q;
  do {
    q = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  } while (q.squaredNorm() > 1.0 || q.squaredNorm() < 1e-4);
  return Eigen::Quaterniond(q.normalized()).toRotationMatrix();
}

/// Nodes of all images of the box inside the outline.
std::vector<Vector3> nodes_inside(const GrainTemplate& box, const Outline& outline, Random& random) {
  const Vector3 period = period_of(box), point = period.cwiseProduct(random.vector(0.5));
  const Matrix3 rotation = random_rotation(random);
  const Eigen::Vector3i images =
      (Vector3::Constant(outline.half_lengths().norm()).cwiseQuotient(period).array() + 1.0).ceil().cast<int>();
  std::vector<Vector3> inside;
  for (int a = -images.x(); a <= images.x(); ++a) {
    for (int b = -images.y(); b <= images.y(); ++b) {
      for (int c = -images.z(); c <= images.z(); ++c) {
        const Vector3 shift = period.cwiseProduct(Vector3(a, b, c)) - point;
        for (const Vector3& node : box.position) {
          const Vector3 x = rotation * (node + shift);
          if (outline.reach(x) <= 1.0) {
            inside.push_back(x);
          }
        }
      }
    }
  }
  return inside;
}

/// Whether each node is held firmly by its bonds.
std::vector<char> firmly_held(const std::vector<Vector3>& position, const std::vector<Bond>& bonds) {
  std::vector<Matrix3> hold(position.size(), Matrix3::Zero());
  std::vector<int> count(position.size(), 0);
  for (const Bond& bond : bonds) {
    const Vector3 e = (position[bond.i] - position[bond.j]) / bond.r0;
    for (const int n : {bond.i, bond.j}) {
      hold[n] += e * e.transpose();
      ++count[n];
    }
  }
  std::vector<char> firm(position.size());
  for (std::size_t n = 0; n < position.size(); ++n) {
    const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(hold[n], Eigen::EigenvaluesOnly);
    firm[n] = count[n] >= fewest_bonds && eigen.eigenvalues()[0] > firm_hold;
  }
  return firm;
}

} // namespace

BulkDensity bulk_density(const GrainTemplate& box) {
  const double volume = period_of(box).prod();
  BulkDensity density{box.n_nodes() / volume, 0.0};
  for (const Bond& bond : box.bonds) {
    density.bonds += bond.r0 * bond.r0 / volume;
  }
  return density;
}

GrainTemplate cut_from_bulk(const GrainTemplate& box, const TemplateSpec& spec, std::uint64_t sample) {
  validate(spec);
  const double density = bulk_density(box).nodes;
  Random random(sample);
  const Outline outline = spec.n_nodes ? Outline::with_volume(spec, *spec.n_nodes / density) : Outline(spec, 1.0);
  std::vector<Vector3> nodes = nodes_inside(box, outline, random);
  const double nominal = outline.volume();
  GrainTemplate body;
  for (int round = 0; round < most_rounds; ++round) {
    body = {};
    for (const int n : hilbert_order(nodes)) {
      body.position.push_back(nodes[n]);
    }
    body.bonds = bonds_closer_than(body.position, spec.bond_cutoff, std::nullopt);
    const std::vector<char> firm = firmly_held(body.position, body.bonds);
    nodes.clear();
    for (std::size_t n = 0; n < firm.size(); ++n) {
      if (firm[n]) {
        nodes.push_back(body.position[n]);
      }
    }
    if (nodes.size() == firm.size()) {
      break;
    }
  }
  body.reference_volume = nominal;
  if (const auto floating = floating_part(body)) {
    throw std::runtime_error(fmt::format("a body of {} nodes cut from the bulk: {}", body.n_nodes(), *floating));
  }
  return body;
}

} // namespace boba::calibration

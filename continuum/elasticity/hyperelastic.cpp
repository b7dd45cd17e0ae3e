// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/hyperelastic.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace boba::continuum {
namespace {

/// Change of the shear pair (i, j) of the Piola stress in the frame of the singular vectors.
struct ShearPair {
  double same, crossed;
};

ShearPair shear_pair(const StretchResponse& w, const Eigen::Vector3d& l, int i, int j) {
  const double gap = l[i] - l[j];
  // Equal stretches: the limit of the quotient, good to the square of the gap.
  const double symmetric = std::abs(gap) > 1e-6 * (l[i] + l[j])
                               ? (w.first[i] - w.first[j]) / gap
                               : 0.5 * (w.second(i, i) + w.second(j, j)) - w.second(i, j);
  const double skew = (w.first[i] + w.first[j]) / (l[i] + l[j]);
  return {0.5 * (symmetric + skew), 0.5 * (symmetric - skew)};
}

struct Polar {
  Eigen::Matrix2d left, right;
  Eigen::Vector3d stretches;
};

Polar polar(const Gradient& h) {
  Eigen::Matrix2d f;
  f << 1 + h[0], h[1], h[2], 1 + h[3];
  if (!(f.determinant() > 0) || !(1 + h[4] > 0)) {
    throw Inverted(fmt::format("a point of the body turned inside out: det F = {:.3e}, hoop stretch {:.3e}",
                               f.determinant(), 1 + h[4]));
  }
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.matrixV(), {svd.singularValues()[0], svd.singularValues()[1], 1 + h[4]}};
}

} // namespace

GradientResponse HyperelasticLaw::at(const Gradient& gradient) const {
  const Polar p = polar(gradient);
  const StretchResponse w = response(p.stretches);
  // Rows of `turn`: the gradient in the frame of the singular vectors, (11, 12, 21, 22, 33).
  GradientTangent turn = GradientTangent::Zero();
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
          turn(2 * a + b, 2 * i + j) = p.left(i, a) * p.right(j, b);
        }
      }
    }
  }
  turn(4, 4) = 1;
  GradientTangent local = GradientTangent::Zero();
  const int normal[] = {0, 3, 4};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      local(normal[i], normal[j]) = w.second(i, j);
    }
  }
  const ShearPair shear = shear_pair(w, p.stretches, 0, 1);
  local(1, 1) = local(2, 2) = shear.same;
  local(1, 2) = local(2, 1) = shear.crossed;
  Gradient stress;
  stress << w.first[0], 0, 0, w.first[1], w.first[2];
  return {turn.transpose() * stress, turn.transpose() * local * turn};
}

SolidResponse HyperelasticLaw::solid(const Eigen::Matrix3d& deformation) const {
  if (!(deformation.determinant() > 0)) {
    throw Inverted(fmt::format("a point of the body turned inside out: det F = {:.3e}", deformation.determinant()));
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(deformation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d left = svd.matrixU(), right = svd.matrixV();
  const Eigen::Vector3d l = svd.singularValues();
  const StretchResponse w = response(l);
  // Rows of `turn`: the deformation in the frame of the singular vectors.
  Eigen::Matrix<double, 9, 9> turn, local = Eigen::Matrix<double, 9, 9>::Zero();
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          turn(3 * a + b, 3 * i + j) = left(i, a) * right(j, b);
        }
      }
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      local(4 * i, 4 * j) = w.second(i, j);
      if (i != j) {
        const ShearPair pair = shear_pair(w, l, i, j);
        local(3 * i + j, 3 * i + j) = pair.same;
        local(3 * i + j, 3 * j + i) = pair.crossed;
      }
    }
  }
  return {left * w.first.asDiagonal() * right.transpose(), turn.transpose() * local * turn, energy(l)};
}

double HyperelasticLaw::lowest_acoustic(const Gradient& gradient) const {
  const Polar p = polar(gradient);
  const StretchResponse w = response(p.stretches);
  ShearPair pairs[3][3] = {};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i != j) {
        pairs[i][j] = shear_pair(w, p.stretches, i, j);
      }
    }
  }
  constexpr int steps = 8; // directions of one octant; the signs of N do not change the eigenvalues
  double lowest = std::numeric_limits<double>::infinity();
  for (int a = 0; a <= steps; ++a) {
    for (int b = 0; b <= steps; ++b) {
      const double theta = 0.5 * std::numbers::pi * a / steps, phi = 0.5 * std::numbers::pi * b / steps;
      const Eigen::Vector3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      Eigen::Matrix3d q;
      for (int i = 0; i < 3; ++i) {
        q(i, i) = w.second(i, i) * n[i] * n[i];
        for (int j = 0; j < 3; ++j) {
          if (i != j) {
            q(i, i) += pairs[i][j].same * n[j] * n[j];
            q(i, j) = (w.second(i, j) + pairs[i][j].crossed) * n[i] * n[j];
          }
        }
      }
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
      lowest = std::min(lowest, eigen.computeDirect(q, Eigen::EigenvaluesOnly).eigenvalues()[0]);
    }
  }
  return lowest;
}

StretchResponse NeoHookean::response(const Eigen::Vector3d& l) const {
  const double log_volume = std::log(l.prod());
  StretchResponse w;
  for (int i = 0; i < 3; ++i) {
    w.first[i] = shear_ * (l[i] - 1 / l[i]) + lame_ * log_volume / l[i];
    for (int j = 0; j < 3; ++j) {
      w.second(i, j) = lame_ / (l[i] * l[j]);
    }
    w.second(i, i) += shear_ + (shear_ - lame_ * log_volume) / (l[i] * l[i]);
  }
  return w;
}

double NeoHookean::energy(const Eigen::Vector3d& l) const {
  const double log_volume = std::log(l.prod());
  return 0.5 * shear_ * (l.squaredNorm() - 3) - shear_ * log_volume + 0.5 * lame_ * log_volume * log_volume;
}

Foam::Foam(std::vector<FoamTerm> terms) : terms_(std::move(terms)) {
  double shear = 0;
  for (const auto& term : terms_) {
    shear += term.shear;
    if (term.exponent == 0 || !std::isfinite(term.exponent)) {
      throw std::invalid_argument(fmt::format("exponent = {} is not allowed: it must not be 0", term.exponent));
    }
    check(Material{1, term.poisson});
  }
  if (!(shear > 0)) {
    throw std::invalid_argument(fmt::format("sum of mu = {} is not allowed: it must be > 0", shear));
  }
}

StretchResponse Foam::response(const Eigen::Vector3d& l) const {
  StretchResponse w{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  const double volume = l.prod();
  for (const auto& [shear, a, nu] : terms_) {
    const double beta = nu / (1 - 2 * nu);
    const double c = 2 * shear / a, g = std::pow(volume, -a * beta);
    for (int i = 0; i < 3; ++i) {
      const double power = std::pow(l[i], a);
      w.first[i] += c * (power - g) / l[i];
      for (int j = 0; j < 3; ++j) {
        w.second(i, j) += c * a * beta * g / (l[i] * l[j]);
      }
      w.second(i, i) += c * ((a - 1) * power + g) / (l[i] * l[i]);
    }
  }
  return w;
}

double Foam::energy(const Eigen::Vector3d& l) const {
  const double log_volume = std::log(l.prod());
  double result = 0;
  for (const auto& [shear, a, nu] : terms_) {
    const double beta = nu / (1 - 2 * nu);
    // (J^(-a beta) - 1) / beta, which tends to -a ln J.
    const double volumetric = beta == 0 ? -a * log_volume : std::expm1(-a * beta * log_volume) / beta;
    result += 2 * shear / (a * a) * (l.array().pow(a).sum() - 3 + volumetric);
  }
  return result;
}

UniaxialState uniaxial(const HyperelasticLaw& law, double axial_stretch) {
  double lateral = 1;
  for (int step = 0; step < 200; ++step) {
    const StretchResponse w = law.response({axial_stretch, lateral, lateral});
    const double change = -w.first[1] / (w.second(1, 1) + w.second(1, 2));
    lateral = std::clamp(lateral + change, 0.5 * lateral, 2 * lateral);
    if (std::abs(change) < 1e-14) {
      return {axial_stretch, lateral, law.response({axial_stretch, lateral, lateral}).first[0]};
    }
  }
  throw std::runtime_error(fmt::format("no free lateral stretch at axial stretch {}", axial_stretch));
}

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/contact/contact_surface.h"

#include "continuum/elasticity/meridian_parts.h"

#include <algorithm>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <map>
#include <numbers>
#include <vector>

namespace boba::continuum {
namespace {

struct Face {
  dealii::DoFHandler<2>::active_cell_iterator cell;
  unsigned number;
  double r() const { return std::max(cell->face(number)->vertex(0)[0], cell->face(number)->vertex(1)[0]); }
};

/// The boundary's faces, sorted outward from the axis, out to r_limit.
std::vector<Face> faces_of(const MeridianBody::Parts& parts, Boundary boundary, double r_limit) {
  std::vector<Face> faces;
  for (const auto& cell : parts.dofs.active_cell_iterators()) {
    for (const unsigned f : cell->face_indices()) {
      if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == boundary) {
        faces.push_back({cell, f});
      }
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.r() < b.r(); });
  const auto end = std::find_if(faces.begin() + 1, faces.end(), [&](const Face& face) { return face.r() > r_limit; });
  faces.erase(end, faces.end());
  return faces;
}

} // namespace

ContactSurface::ContactSurface(const MeridianBody& body, Boundary boundary, double r_limit) {
  const auto& parts = body.parts();
  const auto faces = faces_of(parts, boundary, r_limit);
  const auto n = Eigen::Index(faces.size()) + 1;
  r_.resize(n);
  z_.resize(n);
  area_ = Eigen::VectorXd::Zero(n);
  height_ = Eigen::VectorXd::Zero(n);
  std::vector<Eigen::Triplet<double>> entries;
  dealii::FEFaceValues<2> values(parts.mapping, parts.element, dealii::QGauss<1>(parts.discretisation.degree + 2),
                                 dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values);
  std::vector<dealii::types::global_dof_index> indices(parts.element.n_dofs_per_cell());
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    const auto& [cell, number] = faces[std::size_t(k)];
    const auto face = cell->face(number);
    const unsigned inner = face->vertex(0)[0] < face->vertex(1)[0] ? 0 : 1;
    for (const unsigned side : {0u, 1u}) {
      r_[k + side] = face->vertex(side == 0 ? inner : 1 - inner)[0];
      z_[k + side] = face->vertex(side == 0 ? inner : 1 - inner)[1];
    }
    values.reinit(cell, number);
    cell->get_dof_indices(indices);
    for (const unsigned q : values.quadrature_point_indices()) {
      const auto x = values.quadrature_point(q);
      const double weight = 2 * std::numbers::pi * x[0] * values.JxW(q);
      // Position along the face in the reference cell: the pressure is linear in it.
      const double along = values.get_quadrature().point(q)[0];
      const double t = inner == 0 ? along : 1 - along;
      const double share[] = {1 - t, t};
      for (const unsigned side : {0u, 1u}) {
        const double w = weight * share[side];
        area_[k + side] += w;
        height_[k + side] += w * x[1];
        for (unsigned i = 0; i < indices.size(); ++i) {
          if (parts.element.system_to_component_index(i).first == 1 && values.shape_value(i, q) != 0) {
            entries.emplace_back(int(indices[i]), int(k + side), w * values.shape_value(i, q));
          }
        }
      }
    }
  }
  loads_.resize(body.n_unknowns(), int(n));
  loads_.setFromTriplets(entries.begin(), entries.end());
  loads_.prune(0., 1e-14);
}

Eigen::VectorXd ContactSurface::overlap(double plate, const Eigen::VectorXd& u) const {
  return height_ + loads_.transpose() * u - plate * area_;
}

} // namespace boba::continuum

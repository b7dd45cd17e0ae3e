// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/field_output.h"

#include "continuum/elasticity/meridian_parts.h"

#include <array>
#include <cmath>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

namespace boba::continuum {
namespace {

constexpr std::array<const char*, 6> stress_names = {"stress_rr", "stress_zz",   "stress_hoop",
                                                     "stress_rz", "stress_mean", "stress_mises"};

std::array<double, 6> components(const StressPoint& s) {
  const double mean = (s.rr + s.zz + s.hoop) / 3;
  const double deviator = (s.rr - mean) * (s.rr - mean) + (s.zz - mean) * (s.zz - mean) +
                          (s.hoop - mean) * (s.hoop - mean) + 2 * s.rz * s.rz;
  return {s.rr, s.zz, s.hoop, s.rz, mean, std::sqrt(1.5 * deviator)};
}

std::ofstream opened(const std::filesystem::path& file) {
  std::ofstream stream(file);
  if (!stream) {
    throw std::runtime_error(fmt::format("cannot write {}", file.string()));
  }
  return stream;
}

} // namespace

void write_vtu(const std::filesystem::path& file, const MeridianBody& body, const Eigen::VectorXd& displacement,
               const std::vector<StressPoint>& stress) {
  const auto& parts = body.parts();
  // The stress lives at the Gauss points, so an element with its nodes there takes the values as they are.
  const dealii::FE_DGQArbitraryNodes<2> element{dealii::QGauss<1>(parts.discretisation.degree)};
  dealii::DoFHandler<2> dofs(*parts.mesh.triangulation);
  dofs.distribute_dofs(element);
  std::array<dealii::Vector<double>, 6> fields;
  fields.fill(dealii::Vector<double>(dofs.n_dofs()));
  std::vector<dealii::types::global_dof_index> indices(element.n_dofs_per_cell());
  std::size_t point = 0;
  for (const auto& cell : dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    for (const auto index : indices) {
      const auto values = components(stress.at(point++));
      for (std::size_t k = 0; k < values.size(); ++k) {
        fields[k][index] = values[k];
      }
    }
  }
  dealii::Vector<double> u(parts.dofs.n_dofs());
  std::copy(displacement.data(), displacement.data() + displacement.size(), u.begin());
  dealii::DataOut<2> out;
  out.add_data_vector(parts.dofs, u, std::vector<std::string>(2, "displacement"),
                      std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>(
                          2, dealii::DataComponentInterpretation::component_is_part_of_vector));
  for (std::size_t k = 0; k < fields.size(); ++k) {
    out.add_data_vector(dofs, fields[k], stress_names[k]);
  }
  out.build_patches(parts.mapping, parts.discretisation.degree, dealii::DataOut<2>::curved_boundary);
  auto stream = opened(file);
  out.write_vtu(stream);
}

void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& entries) {
  auto stream = opened(file);
  dealii::DataOutBase::write_pvd_record(stream, entries);
}

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/meridian_parts.h"
#include "continuum/octant/octant_body.h"
#include "continuum/octant/octant_system.h"

#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>
#include <fmt/format.h>

namespace boba::continuum {
namespace {

/// Cauchy stress from the displacement gradient at the points of the output.
class Stress : public dealii::DataPostprocessor<3> {
public:
  explicit Stress(const Material& material) : material_(material) {}

  std::vector<std::string> get_names() const override {
    return {"stress_xx", "stress_yy", "stress_zz",   "stress_yz",
            "stress_xz", "stress_xy", "stress_mean", "stress_mises"};
  }
  std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>
  get_data_component_interpretation() const override {
    return std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>(
        get_names().size(), dealii::DataComponentInterpretation::component_is_scalar);
  }
  dealii::UpdateFlags get_needed_update_flags() const override { return dealii::update_gradients; }

  void evaluate_vector_field(const dealii::DataPostprocessorInputs::Vector<3>& input,
                             std::vector<dealii::Vector<double>>& output) const override {
    for (std::size_t q = 0; q < output.size(); ++q) {
      Eigen::Matrix3d h;
      for (unsigned i = 0; i < 3; ++i) {
        for (unsigned j = 0; j < 3; ++j) {
          h(i, j) = input.solution_gradients[q][i][j];
        }
      }
      const Eigen::Matrix3d s =
          material_.shear() * (h + h.transpose()) + material_.lame() * h.trace() * Eigen::Matrix3d::Identity();
      const double mean = s.trace() / 3;
      const double mises = std::sqrt(1.5) * (s - mean * Eigen::Matrix3d::Identity()).norm();
      const double values[] = {s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1), mean, mises};
      std::copy(std::begin(values), std::end(values), output[q].begin());
    }
  }

private:
  Material material_;
};

} // namespace

void OctantBody::write(const std::string& folder, unsigned number) const {
  const OctantSystem& system = *system_;
  const Stress stress(material_);
  dealii::DataOut<3> out;
  out.attach_dof_handler(system.dofs);
  out.add_data_vector(system.u, std::vector<std::string>(3, "displacement"), dealii::DataOut<3>::type_dof_data,
                      std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>(
                          3, dealii::DataComponentInterpretation::component_is_part_of_vector));
  out.add_data_vector(system.u, stress);
  out.build_patches(system.mapping, system.element.degree, dealii::DataOut<3>::curved_boundary);
  out.write_vtu_with_pvtu_record(fmt::format("{}/", folder), "fields", number, system.communicator, 4, 1);
}

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/octant_body.h"
#include "continuum/contact/condensed_contact.h"

#include <cmath>
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/manifold_lib.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/petsc_precondition.h>
#include <deal.II/lac/petsc_solver.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/numerics/data_out.h>
#include <fmt/format.h>
#include <map>
#include <numbers>
#include <stdexcept>

namespace boba::continuum {
namespace {

using dealii::types::global_dof_index;
using Vector = dealii::PETScWrappers::MPI::Vector;
using Mesh = dealii::parallel::distributed::Triangulation<3>;

constexpr double solver_tolerance = 1e-9;
constexpr int max_active_set = 40;

void name_boundaries(dealii::Triangulation<3>& mesh, const OctantShape& shape) {
  const double small = 1e-8 * shape.radius;
  for (const auto& face : mesh.active_face_iterators()) {
    if (face->at_boundary()) {
      const auto x = face->center();
      const bool end = shape.height > 0 && std::abs(x[2] - shape.height / 2) < small;
      face->set_boundary_id(x[0] < small            ? mirror_x
                            : x[1] < small          ? mirror_y
                            : x[2] < small          ? mirror_z
                            : end                   ? octant_plate_side
                            : shape.height > 0      ? octant_lateral
                                                    : octant_plate_side);
    }
  }
}

void make_mesh(Mesh& mesh, const OctantShape& shape) {
  if (shape.height > 0) {
    dealii::Triangulation<2> disk;
    dealii::GridGenerator::quarter_hyper_ball(disk, dealii::Point<2>(), shape.radius);
    disk.reset_all_manifolds();
    const double half = shape.height / 2;
    const auto layers = unsigned(std::max(1., std::round(2 * half / shape.radius)));
    dealii::Triangulation<3> serial;
    dealii::GridGenerator::extrude_triangulation(disk, layers + 1, half, serial);
    mesh.copy_triangulation(serial);
    name_boundaries(mesh, shape);
    for (const auto& face : mesh.active_face_iterators()) {
      if (face->at_boundary() && face->boundary_id() == octant_lateral) {
        face->set_all_manifold_ids(1);
      }
    }
    mesh.set_manifold(1, dealii::CylindricalManifold<3>(2));
  } else {
    dealii::GridGenerator::quarter_hyper_ball(mesh, dealii::Point<3>(), shape.radius);
    name_boundaries(mesh, shape);
  }
  mesh.refine_global(shape.refinements);
  for (bool refined = shape.wanted != nullptr; refined;) {
    bool here = false;
    for (const auto& cell : mesh.active_cell_iterators()) {
      const auto x = cell->center();
      if (cell->is_locally_owned() && cell->diameter() / std::sqrt(3.) > shape.wanted(x[0], x[1], x[2])) {
        cell->set_refine_flag();
        here = true;
      }
    }
    refined = dealii::Utilities::MPI::max(int(here), MPI_COMM_WORLD) > 0;
    mesh.execute_coarsening_and_refinement();
  }
}

dealii::ComponentMask component(unsigned k) {
  dealii::ComponentMask mask(3, false);
  mask.set(k, true);
  return mask;
}

unsigned checked(unsigned degree) {
  if (degree < 1 || degree > 2) {
    throw std::invalid_argument(fmt::format("degree = {} is not allowed in three dimensions: it must be 1 or 2", degree));
  }
  return degree;
}

} // namespace

struct MpiSession::Handle {
  // One thread a rank: the ranks share the cores already.
  Handle() : init(argc, argv, 1) {}
  int argc = 0;
  char** argv = nullptr;
  dealii::Utilities::MPI::MPI_InitFinalize init;
};

MpiSession::MpiSession() : handle_(std::make_unique<Handle>()) {}
MpiSession::~MpiSession() = default;
int MpiSession::rank() const { return int(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)); }
int MpiSession::size() const { return int(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD)); }

struct OctantBody::Parts {
  Parts(const OctantShape& given, unsigned degree)
      : shape(given), mesh(MPI_COMM_WORLD), element(dealii::FE_Q<3>(checked(degree)), 3), mapping(degree),
        dofs(mesh) {
    make_mesh(mesh, shape);
    dofs.distribute_dofs(element);
    owned = dofs.locally_owned_dofs();
    dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    hanging.reinit(relevant);
    dealii::DoFTools::make_hanging_node_constraints(dofs, hanging);
    hanging.close();
    u.reinit(owned, relevant, MPI_COMM_WORLD);
    residual.reinit(owned, MPI_COMM_WORLD);
    for (const auto& cell : dofs.active_cell_iterators()) {
      if (cell->is_locally_owned()) {
        cells.push_back(cell);
      }
    }
    locate_boundary();
  }

  /// One node of the pressed boundary: its vertical unknown, place, and the area of its shape function.
  struct Node {
    dealii::Point<3> x;
    double area = 0;
  };

  void locate_boundary() {
    Vector area(owned, MPI_COMM_WORLD);
    const dealii::Quadrature<2> points(element.base_element(0).get_unit_face_support_points());
    dealii::FEFaceValues<3> support(mapping, element.base_element(0), points, dealii::update_quadrature_points);
    dealii::FEFaceValues<3> values(mapping, element, dealii::QGauss<2>(element.degree + 2),
                                   dealii::update_values | dealii::update_JxW_values);
    std::vector<global_dof_index> indices(element.n_dofs_per_cell()), on_face(element.n_dofs_per_face());
    std::vector<double> local(indices.size());
    for (const auto& cell : cells) {
      for (const unsigned f : cell->face_indices()) {
        if (!cell->face(f)->at_boundary() || cell->face(f)->boundary_id() != octant_plate_side) {
          continue;
        }
        support.reinit(cell, f);
        values.reinit(cell, f);
        cell->get_dof_indices(indices);
        cell->face(f)->get_dof_indices(on_face);
        for (unsigned i = 0; i < on_face.size(); ++i) {
          const auto [c, k] = element.face_system_to_component_index(i);
          if (c == 2) {
            nodes[on_face[i]].x = support.quadrature_point(k);
          }
        }
        std::fill(local.begin(), local.end(), 0.);
        for (unsigned i = 0; i < indices.size(); ++i) {
          if (element.system_to_component_index(i).first == 2) {
            for (const unsigned q : values.quadrature_point_indices()) {
              local[i] += values.shape_value(i, q) * values.JxW(q);
            }
          }
        }
        hanging.distribute_local_to_global(local, indices, area);
      }
    }
    area.compress(dealii::VectorOperation::add);
    Vector all(owned, relevant, MPI_COMM_WORLD);
    all = area;
    for (auto& [index, node] : nodes) {
      node.area = all[index];
    }
  }

  void add_mirrors(dealii::AffineConstraints<double>& constraints) const {
    constraints.merge(hanging);
    for (const unsigned k : {0u, 1u, 2u}) {
      dealii::DoFTools::make_zero_boundary_constraints(dofs, k, constraints, component(k));
    }
  }

  /// Assembles K (with the constraints) and the right-hand side that their inhomogeneities make.
  void assemble(const Material& material, const dealii::AffineConstraints<double>& constraints) {
    dealii::DynamicSparsityPattern pattern(relevant);
    dealii::DoFTools::make_sparsity_pattern(dofs, pattern, constraints, false);
    dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned, MPI_COMM_WORLD, relevant);
    matrix.clear();
    matrix.reinit(owned, owned, pattern, MPI_COMM_WORLD);
    rhs.reinit(owned, MPI_COMM_WORLD);
    const dealii::Vector<double> zero(element.n_dofs_per_cell());
    std::vector<global_dof_index> indices(element.n_dofs_per_cell());
    for_each_stiffness(material, [&](const auto& cell, const dealii::FullMatrix<double>& local) {
      cell->get_dof_indices(indices);
      constraints.distribute_local_to_global(local, zero, indices, matrix, rhs, true);
    });
    matrix.compress(dealii::VectorOperation::add);
    rhs.compress(dealii::VectorOperation::add);
  }

  /// Nodal forces K u before the held and pressed nodes are constrained.
  void compute_residual(const Material& material) {
    residual = 0;
    std::vector<global_dof_index> indices(element.n_dofs_per_cell());
    dealii::Vector<double> local_u(indices.size()), local_force(indices.size());
    for_each_stiffness(material, [&](const auto& cell, const dealii::FullMatrix<double>& local) {
      cell->get_dof_indices(indices);
      for (unsigned i = 0; i < indices.size(); ++i) {
        local_u[i] = u[indices[i]];
      }
      local.vmult(local_force, local_u);
      hanging.distribute_local_to_global(local_force, indices, residual);
    });
    residual.compress(dealii::VectorOperation::add);
  }

  template <class Work> void for_each_stiffness(const Material& material, Work&& work) {
    using Strain = Eigen::Matrix<double, 6, Eigen::Dynamic>;
    dealii::FEValues<3> values(mapping, element, dealii::QGauss<3>(element.degree + 1),
                               dealii::update_gradients | dealii::update_JxW_values);
    const unsigned n = element.n_dofs_per_cell();
    Eigen::Matrix<double, 6, 6> law = Eigen::Matrix<double, 6, 6>::Zero();
    law.topLeftCorner<3, 3>().setConstant(material.lame());
    law.diagonal() << Eigen::Vector3d::Constant(material.lame() + 2 * material.shear()),
        Eigen::Vector3d::Constant(material.shear());
    Strain b(6, n);
    Eigen::MatrixXd k(n, n);
    dealii::FullMatrix<double> local(n, n);
    for (const auto& cell : cells) {
      values.reinit(cell);
      k.setZero();
      for (const unsigned q : values.quadrature_point_indices()) {
        b.setZero();
        for (unsigned i = 0; i < n; ++i) {
          const unsigned c = element.system_to_component_index(i).first;
          const auto g = values.shape_grad(i, q);
          b(c, i) = g[c];
          for (unsigned d = 1; d <= 2; ++d) { // shear strains: rows 3 yz, 4 xz, 5 xy
            const unsigned other = (c + d) % 3;
            b(3 + (3 - c - other), i) = g[other];
          }
        }
        k.noalias() += b.transpose() * ((values.JxW(q) * law) * b);
      }
      for (unsigned i = 0; i < n; ++i) {
        for (unsigned j = 0; j < n; ++j) {
          local(i, j) = k(i, j);
        }
      }
      work(cell, local);
    }
  }

  /// Solves with the assembled matrix, from the present u; returns the iterations.
  int solve(const dealii::AffineConstraints<double>& constraints, OctantSolution& solution) {
    dealii::Timer timer;
    // Three unknowns a node, numbered together: hypre coarsens each component on its own; without it the iterations
    // grow with refinement. Its classical defaults fill the coarse levels in three dimensions: the others keep them
    // sparse, several times faster at three more iterations (docs/performance-continuum.md).
    for (const auto& [name, value] : {std::pair{"numfunctions", "3"}, {"coarsen_type", "PMIS"},
                                      {"interp_type", "ext+i"}, {"P_max", "4"}, {"truncfactor", "0.3"}}) {
      dealii::PETScWrappers::set_option_value(std::string("-pc_hypre_boomeramg_") + name, value);
    }
    dealii::PETScWrappers::PreconditionBoomerAMG::AdditionalData data;
    data.symmetric_operator = true;
    data.strong_threshold = 0.5;
    dealii::PETScWrappers::PreconditionBoomerAMG preconditioner(matrix, data);
    solution.precondition_seconds += timer.wall_time();
    timer.restart();
    Vector x(owned, MPI_COMM_WORLD);
    x = u;
    constraints.set_zero(x);
    dealii::SolverControl control(2000, solver_tolerance * rhs.l2_norm());
    dealii::PETScWrappers::SolverCG cg(control, MPI_COMM_WORLD);
    try {
      cg.solve(matrix, x, rhs, preconditioner);
    } catch (const dealii::SolverControl::NoConvergence& error) {
      throw NotSettled(fmt::format("conjugate gradients did not settle in {} iterations: residual {:.3e} (goal {:.3e})",
                                   error.last_step, error.last_residual, solver_tolerance * rhs.l2_norm()));
    }
    constraints.distribute(x);
    u = x;
    solution.solve_seconds += timer.wall_time();
    return int(control.last_step());
  }

  double sum(double value) const { return dealii::Utilities::MPI::sum(value, MPI_COMM_WORLD); }

  /// Sum of the vertical nodal forces of the pressed boundary: a quarter of the force. The equator is left out: there
  /// the mirror plane reacts.
  double quarter_force() const {
    double force = 0;
    for (const auto& entry : nodes) {
      if (owned.is_element(entry.first) && !hanging.is_constrained(entry.first) &&
          entry.second.x[2] > 1e-8 * shape.radius) {
        force -= residual[entry.first];
      }
    }
    return sum(force);
  }

  /// Radial displacement at (R, 0, 0).
  double midheight_radial() const {
    double found = -1e300;
    for (const auto& cell : cells) {
      for (const unsigned v : cell->vertex_indices()) {
        if (cell->vertex(v).distance(dealii::Point<3>(shape.radius, 0, 0)) < 1e-8 * shape.radius) {
          found = u[cell->vertex_dof_index(v, 0)];
        }
      }
    }
    return dealii::Utilities::MPI::max(found, MPI_COMM_WORLD);
  }

  OctantShape shape;
  Mesh mesh;
  dealii::FESystem<3> element;
  dealii::MappingQ<3> mapping;
  dealii::DoFHandler<3> dofs;
  dealii::IndexSet owned, relevant;
  dealii::AffineConstraints<double> hanging;
  dealii::PETScWrappers::MPI::SparseMatrix matrix;
  Vector rhs, u, residual;
  std::vector<dealii::DoFHandler<3>::active_cell_iterator> cells;
  std::map<global_dof_index, Node> nodes;
};

OctantBody::OctantBody(const OctantShape& shape, unsigned degree) : parts_(std::make_unique<Parts>(shape, degree)) {}
OctantBody::~OctantBody() = default;

OctantSolution OctantBody::solve_held(const Material& material, double shortening, bool bonded) {
  Parts& p = *parts_;
  OctantSolution solution;
  solution.n_unknowns = long(p.dofs.n_dofs());
  dealii::AffineConstraints<double> constraints(p.relevant);
  p.add_mirrors(constraints);
  if (bonded) {
    for (const unsigned k : {0u, 1u}) {
      dealii::DoFTools::make_zero_boundary_constraints(p.dofs, octant_plate_side, constraints, component(k));
    }
  }
  dealii::IndexSet end =
      dealii::DoFTools::extract_boundary_dofs(p.dofs, component(2), {octant_plate_side});
  for (const auto index : end) {
    if (p.relevant.is_element(index) && !constraints.is_constrained(index)) {
      constraints.add_line(index);
      constraints.set_inhomogeneity(index, -shortening / 2);
    }
  }
  constraints.close();
  dealii::Timer timer;
  p.assemble(material, constraints);
  solution.assemble_seconds = timer.wall_time();
  solution.iterations = p.solve(constraints, solution);
  p.compute_residual(material);
  solution.force = 4 * p.quarter_force();
  solution.midheight_radial = p.midheight_radial();
  return solution;
}

OctantSolution OctantBody::press(const Material& material, double plate, double first_radius) {
  Parts& p = *parts_;
  OctantSolution solution;
  solution.n_unknowns = long(p.dofs.n_dofs());
  std::map<global_dof_index, bool> active;
  for (const auto& [index, node] : p.nodes) {
    if (!p.hanging.is_constrained(index)) {
      active[index] = std::hypot(node.x[0], node.x[1]) < first_radius;
    }
  }
  for (solution.active_set_iterations = 1;; ++solution.active_set_iterations) {
    dealii::AffineConstraints<double> constraints(p.relevant);
    p.add_mirrors(constraints);
    for (const auto& [index, pressed] : active) {
      if (pressed && !constraints.is_constrained(index)) {
        constraints.add_line(index);
        constraints.set_inhomogeneity(index, plate - p.nodes[index].x[2]);
      }
    }
    constraints.close();
    dealii::Timer timer;
    p.assemble(material, constraints);
    solution.assemble_seconds += timer.wall_time();
    solution.iterations = p.solve(constraints, solution);
    p.compute_residual(material);
    Vector force(p.owned, p.relevant, MPI_COMM_WORLD);
    force = p.residual;
    double scale = std::abs(p.quarter_force());
    int changed = 0;
    for (auto& [index, pressed] : active) {
      const bool next = pressed ? force[index] < 1e-9 * scale : p.nodes[index].x[2] + p.u[index] > plate;
      changed += next != pressed && p.owned.is_element(index);
      pressed = next;
    }
    changed = dealii::Utilities::MPI::sum(changed, MPI_COMM_WORLD);
    if (changed == 0) {
      break;
    }
    if (solution.active_set_iterations == max_active_set) {
      throw NotSettled(fmt::format("the active set did not settle in {} iterations: {} nodes still change",
                                   max_active_set, changed));
    }
  }
  double area = 0, central = 0;
  for (const auto& [index, pressed] : active) {
    if (pressed && p.owned.is_element(index)) {
      const auto& node = p.nodes[index];
      area += 4 * node.area;
      if (std::hypot(node.x[0], node.x[1]) < 1e-8 * p.shape.radius) {
        central = -p.residual[index] / node.area;
      }
    }
  }
  solution.force = 4 * p.quarter_force();
  solution.contact_radius = std::sqrt(p.sum(area) / std::numbers::pi);
  solution.central_pressure = p.sum(central);
  solution.midheight_radial = p.midheight_radial();
  return solution;
}

void OctantBody::write(const std::string& folder) const {
  const Parts& p = *parts_;
  dealii::DataOut<3> out;
  out.add_data_vector(p.dofs, p.u, std::vector<std::string>(3, "displacement"),
                      std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>(
                          3, dealii::DataComponentInterpretation::component_is_part_of_vector));
  out.build_patches(p.mapping, p.element.degree);
  out.write_vtu_with_pvtu_record(folder + "/", "fields", 0, MPI_COMM_WORLD, 4);
}

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/app/commands.h"

#include "continuum/app/octant_run.h"
#include "continuum/app/report.h"
#include "continuum/app/summary.h"
#include "continuum/app/uniaxial_file.h"
#include "continuum/octant/mpi_session.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>
#include <iostream>
#include <optional>
#include <stdexcept>

namespace boba::continuum {
namespace {

using nlohmann::json;

/// Linear kinematics are doubtful beyond this a/R, and beyond this nominal strain of a cylinder.
constexpr double largest_linear_contact = 0.3;
constexpr double largest_linear_strain = 0.1;

/// Beyond this ratio rounding keeps Newton's method of finite kinematics from its tolerance: spheres and cylinders
/// settle at 0.4995 by both laws, spheres do not at 0.4999.
constexpr double largest_poisson_of_finite = 0.4995;

struct Options {
  double radius = 1, height = 2, young = 1, poisson = 0.25, slab = 0;
  double c1 = 0, c3 = 0;
  std::optional<double> elements_across;
  unsigned dimension = 2, refinements = 2;
  std::optional<double> corner;
  unsigned degree = 2;
  std::vector<double> approaches, strains;
  std::string kinematics = "linear", law = "neo-hookean", curve;
  double exponent = 2;
  int foam_terms = 1, active_sets = most_active_sets;
  std::string ends = "bonded", against = "plates", interface = "rigid", formulation = "automatic", multigrid = "gamg",
              output;
  bool force = false, no_fields = false;
};

class CommandsImpl : public Commands {
public:
  explicit CommandsImpl(CLI::App& app) {
    sphere_ = app.add_subcommand("sphere", "a sphere between two rigid frictionless plates");
    common(*sphere_);
    sphere_->add_option("--approach", options_.approaches, "approaches of the two plates (total), comma separated")
        ->delimiter(',')
        ->required();
    sphere_->add_option("--against", options_.against, "plates, or sphere: two equal spheres, approach of the centres")
        ->check(CLI::IsMember({"plates", "sphere"}));
    sphere_->add_option("--elements-across", options_.elements_across,
                        "elements across the contact radius, >= 8 (48; 10 in three dimensions)");
    sphere_->add_option("--active-sets", options_.active_sets,
                        "changes of the set of pressed nodes after which a load of linear kinematics has failed");
    cylinder_ = app.add_subcommand("cylinder", "a cylinder between two plates, held or sliding");
    common(*cylinder_);
    cylinder_->add_option("--height", options_.height, "height between the held ends")->required();
    cylinder_->add_option("--slab", options_.slab, "thickness of the rigid end slabs beyond the height");
    cylinder_->add_option("--ends", options_.ends, "bonded or sliding")->check(CLI::IsMember({"bonded", "sliding"}));
    cylinder_->add_option("--strain", options_.strains, "nominal compressive strains, comma separated")
        ->delimiter(',')
        ->required();
    cylinder_->add_option("--corner", options_.corner,
                          "element size at the held corner, in units of min(R, h/2); 0.001, finite 0.02");
  }

  int run(std::ostream& warnings) override { return sphere_->parsed() ? run_sphere(warnings) : run_cylinder(warnings); }

private:
  void common(CLI::App& app) {
    app.add_option("--radius", options_.radius, "radius")->required();
    app.add_option("--young", options_.young, "Young's modulus")->required();
    app.add_option("--poisson", options_.poisson, "Poisson's ratio, in (-1, 0.5)")->required();
    app.add_option("--output", options_.output, "folder for the results")->required();
    app.add_flag("--force", options_.force, "write over earlier results");
    app.add_flag("--no-fields", options_.no_fields, "leave out the .vtu files");
    app.add_option("--interface", options_.interface, "rigid or compliant")
        ->check(CLI::IsMember({"rigid", "compliant"}));
    app.add_option("--c1", options_.c1, "compliant: p = c1 g + c3 g^3, stress per length");
    app.add_option("--c3", options_.c3, "compliant: stress per length^3");
    app.add_option("--kinematics", options_.kinematics, "linear (small strain) or finite")
        ->check(CLI::IsMember({"linear", "finite"}));
    app.add_option("--law", options_.law, "finite kinematics: neo-hookean or foam")
        ->check(CLI::IsMember({"neo-hookean", "foam"}));
    app.add_option("--exponent", options_.exponent, "foam: exponent alpha of its one term");
    app.add_option("--fit", options_.curve,
                   "foam: fit to a uniaxial test, CSV of compressive strain, stress, lateral strain");
    app.add_option("--fit-terms", options_.foam_terms, "foam: terms of the fit, 1 or 2");
    app.add_option("--dimension", options_.dimension, "2: axisymmetric meridian; 3: octant, under MPI")
        ->check(CLI::IsMember({2, 3}));
    app.add_option("--refinements", options_.refinements, "dimension 3: even refinements of the coarse octant")
        ->check(CLI::Range(0, 8));
    app.add_option("--multigrid", options_.multigrid, "dimension 3: gamg (PETSc) or boomer (hypre BoomerAMG)")
        ->check(CLI::IsMember({"gamg", "boomer"}));
    app.add_option("--degree", options_.degree, "degree of the displacement, 1 to 4");
    app.add_option("--formulation", options_.formulation, "automatic, displacement or projected")
        ->check(CLI::IsMember({"automatic", "displacement", "projected"}));
  }

  InterfaceLaw interface() const {
    return options_.interface == "rigid" ? InterfaceLaw{} : InterfaceLaw{options_.c1, options_.c3};
  }

  Discretisation discretisation() const {
    const Formulation formulation = options_.formulation == "automatic"      ? Formulation::automatic
                                    : options_.formulation == "displacement" ? Formulation::displacement
                                                                             : Formulation::projected;
    return {options_.degree, formulation};
  }

  /// The law of finite kinematics, or null.
  std::shared_ptr<const HyperelasticLaw> finite_law(std::ostream& warnings) const {
    const Material material{options_.young, options_.poisson};
    if (options_.kinematics == "linear") {
      return nullptr;
    }
    check(material);
    if (material.poisson > largest_poisson_of_finite) {
      throw std::invalid_argument(fmt::format("poisson = {} is not allowed with finite kinematics: it must lie in (-1, "
                                              "{}]; beyond, the rounding of the change of volume keeps Newton's "
                                              "method from settling. Linear kinematics take all below 0.5",
                                              material.poisson, largest_poisson_of_finite));
    }
    if (options_.law == "neo-hookean") {
      if (material.poisson < 0) {
        warnings
            << "boba-continuum: warning: with poisson < 0 the neo-Hookean energy falls without bound as the volume "
               "goes to 0, and free sides collapse at a limit load; --law foam does not\n";
      }
      return std::make_shared<NeoHookean>(material);
    }
    if (!options_.curve.empty()) {
      return std::make_shared<Foam>(fitted_foam(read_uniaxial_test(options_.curve), material, options_.foam_terms));
    }
    return std::make_shared<Foam>(std::vector<FoamTerm>{{material.shear(), options_.exponent, material.poisson}});
  }

  json parameters(const std::shared_ptr<const HyperelasticLaw>& law) const {
    json result = {{"radius", options_.radius},         {"young", options_.young},
                   {"poisson", options_.poisson},       {"interface", options_.interface},
                   {"kinematics", options_.kinematics}, {"degree", options_.degree},
                   {"dimension", options_.dimension},   {"formulation", options_.formulation}};
    if (options_.interface == "compliant") {
      result["c1"] = options_.c1;
      result["c3"] = options_.c3;
    }
    if (law) {
      result["law"] = options_.law;
      if (const auto* foam = dynamic_cast<const Foam*>(law.get())) {
        for (const auto& term : foam->terms()) {
          result["foam_terms"].push_back({{"mu", term.shear}, {"alpha", term.exponent}, {"nu", term.poisson}});
        }
      }
    }
    return result;
  }

  /// One warning for the first load that small strain cannot mean.
  void warn_of_large_strain(const json& document, std::ostream& warnings) const {
    if (options_.kinematics != "linear") {
      return;
    }
    for (const auto& load : document.at("loads")) {
      const double edge = load.value("contact_radius", 0.) / options_.radius;
      const double strain = std::abs(load.value("strain", 0.));
      if (edge > largest_linear_contact) {
        warnings << fmt::format("boba-continuum: warning: at approach {} the contact radius is {:.3g} R, beyond what "
                                "small strain can mean (about {} R); use --kinematics finite\n",
                                load.at("approach").get<double>(), edge, largest_linear_contact);
        return;
      }
      if (strain > largest_linear_strain) {
        warnings << fmt::format("boba-continuum: warning: strain {} is beyond what small strain can mean (about {}); "
                                "use --kinematics finite\n",
                                load.at("strain").get<double>(), largest_linear_strain);
        return;
      }
    }
  }

  template <class Problem>
  int run_in_three_dimensions(const Problem& problem, double elements_across, std::ostream& warnings) {
    const MpiSession session;
    if (session.rank() == 0) {
      prepare_folder(options_.output, options_.force);
    }
    json chosen = parameters(problem.finite_law);
    chosen["refinements"] = options_.refinements;
    chosen["multigrid"] = options_.multigrid;
    chosen["ranks"] = session.size();
    const OctantChoice choice{options_.refinements, elements_across,
                              options_.multigrid == "gamg" ? Multigrid::gamg : Multigrid::boomer,
                              options_.no_fields ? "" : options_.output};
    const json document = run_octant(problem, choice, chosen);
    if (session.rank() == 0) {
      warn_of_large_strain(document, warnings);
      write_summary(options_.output, document);
      for (const auto& load : document.at("loads")) {
        fmt::print("{}\n", load.dump());
      }
    }
    return 0;
  }

  int run_sphere(std::ostream& warnings) {
    SphereProblem problem;
    problem.radius = options_.radius;
    problem.material = {options_.young, options_.poisson};
    problem.approaches = options_.approaches;
    problem.interface = interface();
    problem.finite_law = finite_law(warnings);
    problem.discretisation = discretisation();
    problem.elements_across = options_.elements_across.value_or(options_.dimension == 2 ? 48 : 10);
    problem.max_active_sets = options_.active_sets;
    check(problem);
    if (options_.dimension == 3) {
      return run_in_three_dimensions(problem, problem.elements_across, warnings);
    }
    prepare_folder(options_.output, options_.force);
    const auto loads = solve(problem);
    json chosen = parameters(problem.finite_law);
    chosen["against"] = options_.against;
    chosen["elements_across"] = problem.elements_across;
    const json document = report(loads, problem, chosen);
    warn_of_large_strain(document, warnings);
    write_summary(options_.output, document);
    if (!options_.no_fields) {
      write_fields(options_.output, loads, problem);
    }
    for (const auto& load : loads) {
      fmt::print("approach {:<12g} force {:<14.8g} F/F_Hertz {:<10.6f} a/R {:<10.6f} peak pressure {:<12.7g}\n",
                 load.approach, load.force, load.force / load.hertz.force, load.contact_radius / problem.radius,
                 load.peak_pressure);
    }
    return 0;
  }

  int run_cylinder(std::ostream& warnings) {
    CylinderProblem problem;
    problem.radius = options_.radius;
    problem.height = options_.height;
    problem.material = {options_.young, options_.poisson};
    problem.ends = options_.ends == "bonded" ? Ends::bonded : Ends::sliding;
    problem.strains = options_.strains;
    problem.interface = interface();
    problem.finite_law = finite_law(warnings);
    problem.discretisation = discretisation();
    // A finely resolved corner folds over under finite strain: there the field is singular.
    problem.mesh.corner = options_.corner.value_or(problem.finite_law ? 0.02 : CylinderMeshSize{}.corner);
    check(problem);
    if (!(options_.slab >= 0)) {
      throw std::invalid_argument(fmt::format("slab = {} is not allowed: it must be >= 0", options_.slab));
    }
    if (!(problem.mesh.corner > 0 && problem.mesh.corner <= 1)) {
      throw std::invalid_argument(
          fmt::format("corner = {} is not allowed: it must lie in (0, 1]", problem.mesh.corner));
    }
    if (options_.dimension == 3) {
      return run_in_three_dimensions(problem, 0, warnings);
    }
    prepare_folder(options_.output, options_.force);
    const auto result = solve(problem);
    json chosen = parameters(problem.finite_law);
    chosen["height"] = options_.height;
    chosen["slab"] = options_.slab;
    chosen["ends"] = options_.ends;
    const json document = report(result, problem, chosen);
    warn_of_large_strain(document, warnings);
    write_summary(options_.output, document);
    if (!options_.no_fields) {
      write_fields(options_.output, result, problem);
    }
    for (const auto& load : result.loads) {
      fmt::print("strain {:<10g} force {:<14.8g} apparent modulus {:<12.8g} mid-height Poisson ratio {:<10.6f}\n",
                 load.strain, load.force, load.apparent_modulus, load.midheight_poisson);
    }
    return 0;
  }

  Options options_;
  CLI::App* sphere_ = nullptr;
  CLI::App* cylinder_ = nullptr;
};

} // namespace

std::unique_ptr<Commands> add_commands(CLI::App& app) {
  return std::make_unique<CommandsImpl>(app);
}

} // namespace boba::continuum

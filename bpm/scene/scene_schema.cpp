// SPDX-License-Identifier: GPL-3.0-or-later
// The scene format, as a table. Nothing else in the program lists its keys.
#include "bpm/scene/schema.h"

namespace boba {

namespace {

constexpr double most_nodes = 2e8;
constexpr double largest_seed = 9007199254740992.0; // 2^53: survives a trip through a double

std::vector<SceneKey> interval_keys(const std::string& what, const std::string& time_fallback,
                                    const std::string& strain_fallback) {
  return {
      above_key("every_strain", "", 0.0, 1e3, strain_fallback,
                what + " whenever the shear strain has grown by this much"),
      above_key("every_time", "tau", 0.0, 1e12, time_fallback, what + " whenever this much time has passed"),
  };
}

std::vector<SceneKey> joined(std::vector<SceneKey> first, const std::vector<SceneKey>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<SceneKey> barostat_keys(const std::string& without) {
  return {
      above_key("pressure", "k/d", 0.0, 100.0, "", "pressure to hold" + without),
      above_key(
          "normalised_pressure", "", 0.0, 10.0, "",
          "the same as P~ = P (2 - 2 nu^2) / E; E and nu from the installed table (mean of E / (2 - 2 nu^2) over all "
          "nodes when species differ)"),
      above_key("gain", "d/(k tau)", 0.0, 10.0, "",
                "gain g of the barostat, d ln L / dt = g (P - P_target); default 1 / (3 K t_c), see docs/notation.md"),
      above_key("rate_cap", "1/tau", 0.0, 0.1, "1e-3", "largest |d ln L / dt| of the barostat"),
  };
}

std::vector<SceneKey> alpha_keys(bool needed) {
  const std::string note = needed ? " (this or `poisson`)" : " (default: as stored with the trajectory, else 0)";
  SceneKey alpha = above_key("alpha", "k d", -1.1, 100.0, "",
                             "many-body coefficient" + note + "; at about -1.1 the network loses its rigidity");
  SceneKey poisson =
      real_key("poisson", "", -1.0, 0.5, "",
               "Poisson's ratio; alpha follows by monotone interpolation in the installed table, without "
               "extrapolation");
  poisson.above_lowest = true;
  return {alpha, poisson};
}

SceneSection section(std::string path, std::string doc, std::vector<SceneKey> keys) {
  return {std::move(path), "", false, std::move(doc), std::move(keys)};
}

SceneSection repeated(std::string path, std::string doc, std::vector<SceneKey> keys) {
  return {std::move(path), "", true, std::move(doc), std::move(keys)};
}

SceneSection stage(std::string kind, std::string doc, std::vector<SceneKey> keys) {
  return {"stage", std::move(kind), true, std::move(doc), std::move(keys)};
}

std::vector<SceneSection> general_sections() {
  return {
      section("", "",
              {text_key("title", "", "what the scene is; copied into the results"),
               integer_key("seed", 0.0, largest_seed, "1", "placement and rotation of the grains")}),
      section("run", "How the run is computed.",
              {or_word(above_key("dt", "tau", 0.0, 1.0, "0.1",
                                 "time step; \"auto\" takes 0.6 of the largest step at which the grains' bonds are "
                                 "stable (docs/stability.md). A step beyond that is refused"),
                       {"auto"}),
               integer_key("threads", 0.0, 1024.0, "0", "threads; 0 takes all cores. The result does not depend on it"),
               choice_key("precision", {"double", "mixed"}, "\"double\"",
                          "mixed: positions in 32-bit fixed point from their grain's centre, the rest in floats; "
                          "faster, with forces to six or seven digits"),
               real_key("skin", "d", 0.02, 2.0, "0.3",
                        "margin of the contact list; the result does not depend on it "
                        "beyond rounding"),
               above_key("wall_time", "s", 0.0, 1e9, "", "stop with a checkpoint (exit code 75) after this long")}),
      section("output",
              "What is written besides the table, the log and the checkpoints. `--output DIR` replaces `directory`.",
              {text_key("directory", "out/NAME of the scene file",
                        "output folder below the current one: a relative path without `..`")}),
      section("output.table", "Rows of table.csv; one more at the beginning and the end of every stage.",
              interval_keys("a row", "100", "0.01")),
      section("output.trajectory",
              "trajectory.h5 (H5MD): written when this table exists. Frames at the beginning and the end of every "
              "stage, and:",
              joined(interval_keys("a frame", "", ""),
                     {boolean_key("velocities", "false", "store the nodes' velocities too")})),
      section("output.dump", "dump.lammpstrj for OVITO: written when this table exists; frames as for the trajectory.",
              joined(interval_keys("a frame", "", ""),
                     {boolean_key("velocities", "false", "store the nodes' velocities too")})),
      section("output.vtk",
              "vtk/packing.pvd for ParaView: written when this table exists; frames as for the trajectory.",
              interval_keys("a frame", "", "")),
      section(
          "output.checkpoint",
          "The last two checkpoints are kept; one is written at the end and when the run is stopped.",
          {above_key("every_seconds", "s", 0.0, 1e9, "600",
                     "a checkpoint whenever so many seconds of real time have passed"),
           above_key("every_time", "tau", 0.0, 1e12, "", "a checkpoint whenever this much simulated time has passed")}),
      repeated(
          "measure",
          "Measures taken while the run goes, into the tables of the folder `measures` (docs/formats-measure.md): at "
          "the beginning and the end of every stage, and:",
          joined(interval_keys("a measurement", "", ""),
                 {required(text_key("what", "",
                                    "all, or some of stress, packing-fraction, shape, scattering, order, "
                                    "contacts, motion, separated by commas; each in one `[[measure]]` only")),
                  integer_key("points", 1.0, 1e9, "100000", "random points of the packing fraction"),
                  real_key("target_error", "", 1e-5, 0.5, "",
                           "draw points until the packing fraction's standard error is at most this"),
                  above_key("q_max", "1/d", 0.0, 20.0, "1", "scattering: largest wave number"),
                  choice_key("neighbours", {"solid-angle", "voronoi"}, "\"solid-angle\"",
                             "rule for neighbours of order and motion"),
                  boolean_key("sensitivity", "false", "count facets at other thresholds too")})),
  };
}

std::vector<SceneSection> material_sections() {
  return {
      section("material", "Constants that all grains share.",
              {above_key("k", "k", 0.0, 1e6, "1", "stiffness of bonds and contacts (1 in the engine's units)"),
               real_key("gamma", "sqrt(k m)", 0.0, 100.0, "1", "damping of bonds and contacts"),
               real_key("k3", "k/d^2", 0.0, 1e6, "50", "cubic part of the contact repulsion"),
               above_key(
                   "hertz_modulus", "k/d", 0.0, 1e6, "",
                   "contacts of rigid spheres by Hertz's law with this E / (2 - 2 nu^2), instead of k and k3; gamma is "
                   "then the share of critical damping. For grains of one node only")}),
      repeated(
          "template", "An undeformed grain. Built once, then read from the cache (`~/.cache/boba`, or BOBA_CACHE_DIR).",
          {required(text_key("name", "", "what [[species]] calls it")),
           choice_key("shape", {"sphere", "cylinder", "box", "periodic_box"}, "\"sphere\"", "its shape"),
           above_key("radius", "d", 0.5, 500.0, "10", "of a sphere or cylinder"),
           above_key("height", "d", 1.0, 2000.0, "40", "of a cylinder (along z)"),
           vector_key("size", "d", 1.0, 2000.0, "[20, 20, 20]", "edges of a box"),
           integer_key("nodes", 1.0, most_nodes, "",
                       "scale the shape so that it holds this many nodes; a sphere of 1 node is rigid, of diameter d"),
           choice_key("surface", {"cut", "wall"}, "\"cut\"",
                      "cut from a bulk arrangement, or relaxed inside a smooth wall"),
           integer_key("seed", 0.0, largest_seed, "1", "of the arrangement")}),
      repeated("species", "So many grains of a template with one Poisson's ratio.",
               joined({text_key("name", "", "for messages and tables"),
                       text_key("template", "the only one", "name of a [[template]]"),
                       required(integer_key("count", 1.0, most_nodes, "", "number of grains"))},
                      alpha_keys(true))),
      section("start",
              "Start from files instead of an `insert` stage: a LAMMPS data file of undeformed bonded grains (bond "
              "rest lengths "
              "from there) with the state of a dump file, or a frame of a trajectory that Boba wrote.",
              joined({text_key("lammps_reference", "", "LAMMPS data file, also .gz"),
                      text_key("lammps_state", "the reference itself",
                               "LAMMPS dump (or data) file with the present state, also .gz"),
                      text_key("trajectory", "", "trajectory.h5 of an earlier run"),
                      integer_key("frame", -1e9, 1e9, "-1",
                                  "frame of the trajectory or dump, counted from 0; negative from the end")},
                     alpha_keys(false))),
  };
}

std::vector<SceneSection> stage_sections() {
  return {
      stage("insert",
            "Places all grains at random, without overlap and at random angles, in a cubic periodic cell. First stage "
            "only.",
            {real_key("packing_fraction", "", 1e-9, 0.74, "0.4",
                      "sum of the grains' reference volumes over the cell's volume"),
             boolean_key("rotate", "true", "turn every grain at random")}),
      stage("specimen",
            "Places one grain as it is in the middle of an open cell (a `periodic_box`: in its own cell). First stage "
            "only.",
            {above_key("margin", "d", 0.0, 1e4, "5", "free space around the grain")}),
      stage(
          "compress",
          "Isotropic compression at a constant rate up to the pressure, then a hold under the barostat until both "
          "tolerances are met.",
          joined(barostat_keys(" (this or `normalised_pressure`)"),
                 {above_key("rate", "1/tau", 0.0, 0.1, "5e-4", "-d ln L / dt of the ramp"),
                  above_key("pressure_tolerance", "", 0.0, 1.0, "1e-3", "|P / P_target - 1| at the end"),
                  above_key("kinetic_tolerance", "", 0.0, 1e3, "1e-4", "kinetic over elastic energy at the end"),
                  above_key("max_time", "tau", 0.0, 1e12, "1e6", "the stage fails when it has not settled by then")})),
      stage("hold", "A fixed cell, or a held pressure, for a time.",
            joined({required(above_key("time", "tau", 0.0, 1e12, "", "how long"))},
                   barostat_keys("; without it the cell is fixed"))),
      stage("shear", "Simple shear in x with gradient y.",
            joined({required(real_key("rate", "1/tau", -0.1, 0.1, "", "shear rate, not 0; negative shears backwards")),
                    required(above_key("strain", "", 0.0, 1e6, "", "strain to add")),
                    choice_key("remap", {"positions", "velocities"}, "\"positions\"",
                               "nodes follow the cell affinely, or only images across the cell carry its velocity")},
                   barostat_keys("; without it the volume is constant"))),
      stage("press", "Squeezes a specimen along z between two walls or two clamped ends.",
            {required(above_key("strain", "", 0.0, 0.9, "",
                                "displacement of both ends together over the specimen's height")),
             choice_key("ends", {"walls", "clamps"}, "\"walls\"", "rigid walls, or end layers that move rigidly"),
             real_key("velocity", "d/tau", -0.1, 0.1, "1e-3", "of each end, not 0; negative pulls (clamps only)"),
             above_key("clamp_thickness", "d", 0.0, 1e3, "2", "nodes within this distance of an end are clamped")}),
  };
}

} // namespace

const std::vector<SceneSection>& scene_schema() {
  static const std::vector<SceneSection> schema = [] {
    std::vector<SceneSection> all = general_sections();
    for (const std::vector<SceneSection>& part : {material_sections(), stage_sections()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return schema;
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory_head.h"

namespace boba::trajectory {

using hdf5::File;

namespace {

/// Small datasets keep many frames in one chunk, so that a frame touches few places of the file.
constexpr hsize_t small_chunk = 256;

/// An H5MD element of doubles that shares step and time with the positions.
void make_element(const File& file, const char* element, const File::Growing& layout, const std::string& unit) {
  file.make_growing<double>(value_of(element), layout, not_written);
  file.set_attribute(value_of(element), "boba_unit", unit);
  if (element != position) {
    file.link(step_name(), std::string(element) + "/step");
    file.link(time_name(), std::string(element) + "/time");
  }
}

void write_head(const File& file, const TrajectoryOrigin& origin_of_file) {
  file.make_group("/h5md/author");
  file.make_group("/h5md/creator");
  const std::vector<std::int32_t> version = {1, 1};
  file.set_attribute("/h5md", "version", version);
  file.set_attribute("/h5md/author", "name", origin_of_file.author);
  file.set_attribute("/h5md/creator", "name", std::string("boba"));
  file.set_attribute("/h5md/creator", "version", origin_of_file.version);
  file.make_group("/parameters");
  file.write_text("/parameters/scene", origin_of_file.scene);
  file.write_text("/parameters/version", origin_of_file.version);
  file.write_text("/parameters/git_hash", origin_of_file.git_hash);
  // As text: a seed may use all 64 bits.
  file.write_text("/parameters/seed", std::to_string(origin_of_file.seed));
  const std::int32_t not_closed = 0;
  file.write<std::int32_t>(closed, {&not_closed, 1});
}

template <typename T> std::vector<std::int64_t> widened(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

/// Nodes of the undeformed templates one after the other, with the range of each.
void write_undeformed(const File& file, const Topology& topology) {
  std::vector<std::int64_t> first = {0};
  std::vector<double> all_nodes;
  for (const std::vector<Vector3>& nodes : topology.undeformed) {
    for (const Vector3& x : nodes) {
      all_nodes.insert(all_nodes.end(), x.data(), x.data() + 3);
    }
    first.push_back(static_cast<std::int64_t>(all_nodes.size() / 3));
  }
  if (!all_nodes.empty()) {
    file.write<std::int64_t>(std::string(grains) + "/undeformed_first_node", first);
    file.write<double>(std::string(grains) + "/undeformed_position", all_nodes, 3);
    file.set_attribute(std::string(grains) + "/undeformed_position", "boba_unit", std::string("d"));
  }
}

void write_grains(const File& file, const Topology& topology) {
  const std::string folder = std::string(grains) + "/";
  file.make_group(grains);
  const auto write = [&](const char* name, const std::vector<std::int64_t>& values) {
    file.write<std::int64_t>(folder + name, values);
  };
  write("first_node", topology.first_node);
  write("molecule", topology.molecule);
  write("species", widened(topology.species));
  write("template", widened(topology.template_index));
  write_undeformed(file, topology);
  file.write<double>(folder + "alpha", topology.alpha);
  file.set_attribute(folder + "alpha", "boba_unit", std::string("k d"));
}

void write_particles(const File& file, const Topology& topology) {
  const std::string folder = std::string(all) + "/";
  std::vector<std::int64_t> grain;
  std::vector<std::int32_t> species;
  for (const int g : topology.grain_of_node()) {
    grain.push_back(topology.molecule[g]);
    species.push_back(topology.species[g]);
  }
  const std::vector<double> mass(topology.id.size(), 1.0);
  file.write<std::int64_t>(folder + "id", topology.id);
  file.write<std::int64_t>(folder + "grain", grain);
  file.write<std::int32_t>(folder + "species", species);
  file.write<double>(folder + "mass", mass);
  file.set_attribute(folder + "mass", "boba_unit", std::string("m"));
}

void write_bonds(const File& file, const Topology& topology) {
  std::vector<std::int64_t> pairs;
  std::vector<double> r0;
  pairs.reserve(2 * topology.bonds.size());
  r0.reserve(topology.bonds.size());
  for (const Topology::Pair& bond : topology.bonds) {
    pairs.push_back(topology.id[bond.i]);
    pairs.push_back(topology.id[bond.j]);
    r0.push_back(bond.r0);
  }
  file.make_group("/connectivity");
  file.write<std::int64_t>("/connectivity/bonds", pairs, 2);
  file.set_reference("/connectivity/bonds", "particles_group", all);
  file.write<double>("/connectivity/bonds_r0", r0);
  file.set_attribute("/connectivity/bonds_r0", "boba_unit", std::string("d"));
}

void make_elements(const File& file, const Topology& topology, const TrajectoryOptions& options) {
  const auto n = static_cast<hsize_t>(topology.n_nodes());
  const auto n_grains = static_cast<hsize_t>(topology.n_grains());
  const File::Growing nodes{{n, 3}, 1, options.compression};
  file.make_group(position);
  file.make_growing<std::int64_t>(step_name(), {{}, small_chunk, 0}, std::int64_t{-1});
  file.make_growing<double>(time_name(), {{}, small_chunk, 0}, not_written);
  file.set_attribute(time_name(), "boba_unit", std::string("tau"));
  make_element(file, position, nodes, "d");
  file.make_growing<std::int32_t>(value_of(image), nodes, image_not_written);
  file.link(step_name(), std::string(image) + "/step");
  file.link(time_name(), std::string(image) + "/time");
  if (options.velocity) {
    make_element(file, velocity, nodes, "d/tau");
  }
  if (options.bonds_yield) {
    file.set_attribute(std::string(grains) + "/alpha", trajectory::bonds_yield, std::string("yes"));
  }
  if (options.damage) {
    make_element(file, damage, {{n}, 1, options.compression}, "1");
  }
  make_element(file, edges, {{3, 3}, small_chunk, 0}, "d");
  make_element(file, box_origin, {{3}, small_chunk, 0}, "d");
  make_element(file, strain, {{}, small_chunk, 0}, "1");
  make_element(file, streaming_rate, {{}, small_chunk, 0}, "1/tau");
  make_element(file, grain_centre, {{n_grains, 3}, 1, 0}, "d");
  make_element(file, grain_stress, {{n_grains, 6}, 1, 0}, "k d");
  file.set_attribute(value_of(grain_stress), "components", std::string("xx yy zz xy xz yz"));
}

} // namespace

void write_once(const File& file, const Topology& topology, const TrajectoryOrigin& origin,
                const TrajectoryOptions& options) {
  write_head(file, origin);
  file.make_group(box);
  const std::vector<std::int32_t> dimension = {3};
  file.set_attribute(box, "dimension", dimension);
  write_particles(file, topology);
  write_grains(file, topology);
  write_bonds(file, topology);
  make_elements(file, topology, options);
}

} // namespace boba::trajectory

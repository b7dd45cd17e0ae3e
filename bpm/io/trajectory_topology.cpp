// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory_topology.h"

#include "bpm/grain/sound_template.h"
#include "bpm/io/id_table.h"
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory_layout.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <type_traits>
#include <utility>

namespace boba::trajectory {

using hdf5::File;

namespace {

const std::string grains_folder = std::string(grains) + "/";
constexpr std::int64_t largest_int = std::numeric_limits<int>::max();

/// Offsets: from 0 to `total`, rising by `step` at least.
void check_offsets(const File& file, const std::string& name, const std::vector<std::int64_t>& first,
                   std::int64_t total, std::int64_t step) {
  bool rises = !first.empty() && first.front() == 0 && first.back() == total;
  for (std::size_t k = 0; k + 1 < first.size() && rises; ++k) {
    rises = first[k + 1] - step >= first[k];
  }
  if (!rises) {
    refuse_file(file, fmt::format("{} must rise from 0 to {} in steps of {} at least", name, total, step));
  }
}

template <typename T> std::vector<T> read_per_grain(const File& file, const std::string& name, std::int64_t n_grains) {
  using Stored = std::conditional_t<std::is_floating_point_v<T>, T, std::int64_t>;
  const std::vector<Stored> values = file.read<Stored>(name);
  if (std::ssize(values) != n_grains) {
    refuse_file(file, fmt::format("{} has {} values for {} grains", name, values.size(), n_grains));
  }
  return {values.begin(), values.end()};
}

/// Numbers from 0 to `largest`, one a grain.
std::vector<int> read_numbers(const File& file, const std::string& name, std::int64_t n_grains, std::int64_t largest) {
  const std::vector<std::int64_t> values = read_per_grain<std::int64_t>(file, name, n_grains);
  for (std::size_t g = 0; g < values.size(); ++g) {
    if (values[g] < 0 || values[g] > largest) {
      refuse_file(file, fmt::format("{}: grain {} has {}; allowed: 0 to {}", name, g, values[g], largest));
    }
  }
  return {values.begin(), values.end()};
}

/// Node numbers and grains fit each other; bonds are still missing.
Topology read_grains(const File& file) {
  Topology topology;
  topology.id = file.read<std::int64_t>(std::string(all) + "/id");
  const std::int64_t n_nodes = topology.n_nodes();
  if (n_nodes < 1 || n_nodes > largest_int) {
    refuse_file(file, fmt::format("{}/id holds {} nodes; allowed: 1 to {}", all, n_nodes, largest_int));
  }
  if (*std::min_element(topology.id.begin(), topology.id.end()) < 1) {
    refuse_file(file, fmt::format("{}/id holds a number below 1", all));
  }
  topology.first_node = file.read<std::int64_t>(grains_folder + "first_node");
  check_offsets(file, grains_folder + "first_node", topology.first_node, n_nodes, 1);
  const std::int64_t n_grains = topology.n_grains();
  topology.molecule = read_per_grain<std::int64_t>(file, grains_folder + "molecule", n_grains);
  topology.species = read_numbers(file, grains_folder + "species", n_grains, largest_int - 1);
  topology.alpha = read_per_grain<double>(file, grains_folder + "alpha", n_grains);
  for (std::size_t g = 0; g < topology.alpha.size(); ++g) {
    if (!(std::abs(topology.alpha[g]) <= 1e12)) {
      refuse_file(file, fmt::format("{}alpha: grain {} has {:g} k d; allowed: -1e12 to 1e12", grains_folder, g,
                                    topology.alpha[g]));
    }
  }
  return topology;
}

/// Template numbers, and that their grains have one size. Returns one grain of each template, or -1.
std::vector<int> read_templates(const File& file, Topology& topology) {
  const auto most = std::max<std::int64_t>(topology.n_grains(), std::ssize(topology.undeformed));
  topology.template_index = read_numbers(file, grains_folder + "template", topology.n_grains(), most - 1);
  const int n = 1 + *std::max_element(topology.template_index.begin(), topology.template_index.end());
  std::vector<int> model(static_cast<std::size_t>(n), -1);
  const auto nodes_of = [&](int g) { return topology.first_node[g + 1] - topology.first_node[g]; };
  for (int g = 0; g < topology.n_grains(); ++g) {
    int& first = model[topology.template_index[g]];
    first = first < 0 ? g : first;
    if (nodes_of(g) != nodes_of(first)) {
      refuse_file(file,
                  fmt::format("grains {} and {} are of template {} and have {} and {} nodes; they must have the same",
                              first, g, topology.template_index[g], nodes_of(first), nodes_of(g)));
    }
  }
  for (std::size_t t = 0; t < topology.undeformed.size() && t < model.size(); ++t) {
    const std::int64_t n_undeformed = std::ssize(topology.undeformed[t]);
    if (n_undeformed > 0 && model[t] >= 0 && n_undeformed != nodes_of(model[t])) {
      refuse_file(file, fmt::format("{}undeformed_position: template {} has {} nodes, its grains have {}",
                                    grains_folder, t, n_undeformed, nodes_of(model[t])));
    }
  }
  return model;
}

std::vector<std::vector<Vector3>> read_undeformed(const File& file) {
  const std::string name = grains_folder + "undeformed_position", first_name = grains_folder + "undeformed_first_node";
  std::vector<std::vector<Vector3>> undeformed;
  if (!file.has(name)) {
    return undeformed;
  }
  const std::vector<double> numbers = file.read<double>(name);
  const std::vector<std::int64_t> first = file.read<std::int64_t>(first_name);
  if (numbers.size() % 3 != 0) {
    refuse_file(file, fmt::format("{} holds {} numbers; three a node are needed", name, numbers.size()));
  }
  check_offsets(file, first_name, first, std::ssize(numbers) / 3, 0);
  for (std::size_t t = 0; t + 1 < first.size(); ++t) {
    std::vector<Vector3>& nodes = undeformed.emplace_back();
    for (std::int64_t node = first[t]; node < first[t + 1]; ++node) {
      nodes.emplace_back(numbers[3 * node], numbers[3 * node + 1], numbers[3 * node + 2]);
      if (!is_usable_position(nodes.back())) {
        refuse_file(file, fmt::format("{}: node {} lies beyond {:g} d", name, node, largest_coordinate));
      }
    }
  }
  return undeformed;
}

void read_bonds(const File& file, Topology& topology) {
  const std::vector<std::int64_t> pairs = file.read<std::int64_t>("/connectivity/bonds");
  const std::vector<double> r0 = file.read<double>("/connectivity/bonds_r0");
  if (pairs.size() != 2 * r0.size()) {
    refuse_file(file, "/connectivity/bonds and bonds_r0 have different lengths");
  }
  const IdTable nodes(topology.id);
  if (nodes.duplicate() != IdTable::none) {
    refuse_file(file, fmt::format("{}/id: {} stands twice", all, topology.id[nodes.duplicate()]));
  }
  const std::vector<int> grain_of = topology.grain_of_node();
  topology.bonds.reserve(r0.size());
  for (std::size_t bond = 0; bond < r0.size(); ++bond) {
    const Topology::Pair pair{nodes.row(pairs[2 * bond]), nodes.row(pairs[2 * bond + 1]), r0[bond]};
    const auto name = [&] { return fmt::format("bond {} - {}", pairs[2 * bond], pairs[2 * bond + 1]); };
    if (pair.i == IdTable::none || pair.j == IdTable::none) {
      refuse_file(file, fmt::format("{} joins nodes that are not there", name()));
    }
    if (pair.i == pair.j || grain_of[pair.i] != grain_of[pair.j]) {
      refuse_file(file, fmt::format("{} does not join two nodes of one grain", name()));
    }
    if (!(pair.r0 >= shortest_rest_length && pair.r0 <= longest_rest_length)) {
      refuse_file(file, fmt::format("{} has the rest length {:g} d; allowed: {:g} to {:g}", name(), pair.r0,
                                    shortest_rest_length, longest_rest_length));
    }
    topology.bonds.push_back(pair);
  }
}

/// Bonds of each grain between places in it, sorted.
std::vector<std::vector<Bond>> bonds_of_grains(const Topology& topology) {
  std::vector<std::vector<Bond>> bonds(static_cast<std::size_t>(topology.n_grains()));
  const std::vector<int> grain_of = topology.grain_of_node();
  for (const Topology::Pair& bond : topology.bonds) {
    const int g = grain_of[bond.i];
    const auto a = static_cast<int>(bond.i - topology.first_node[g]),
               b = static_cast<int>(bond.j - topology.first_node[g]);
    bonds[g].push_back({std::min(a, b), std::max(a, b), bond.r0});
  }
  for (std::vector<Bond>& of_grain : bonds) {
    std::sort(of_grain.begin(), of_grain.end(),
              [](const Bond& a, const Bond& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  }
  return bonds;
}

/// Undeformed nodes are stored where every bond of theirs is at rest; a lone grain may be bonded to its own images.
void check_at_rest(const File& file, const Topology& topology, int t, const std::vector<Bond>& bonds) {
  if (t >= std::ssize(topology.undeformed) || topology.undeformed[t].empty()) {
    return;
  }
  constexpr double tolerance = 1e-6;
  const std::vector<Vector3>& nodes = topology.undeformed[t];
  for (const Bond& bond : bonds) {
    const double stretch = (nodes[bond.i] - nodes[bond.j]).norm() / bond.r0 - 1.0;
    if (std::abs(stretch) > tolerance && (stretch < 0.0 || topology.n_grains() > 1)) {
      refuse_file(file,
                  fmt::format("the bond of nodes {} and {} of template {} has the rest length {:g} d; the undeformed "
                              "nodes are {:g} d apart",
                              bond.i, bond.j, t, bond.r0, bond.r0 * (1.0 + stretch)));
    }
  }
}

void check_networks(const File& file, const Topology& topology, const std::vector<int>& model) {
  const std::vector<std::vector<Bond>> bonds = bonds_of_grains(topology);
  const auto same_ends = [](const Bond& a, const Bond& b) { return a.i == b.i && a.j == b.j; };
  for (int g = 0; g < topology.n_grains(); ++g) {
    const int first = model[topology.template_index[g]];
    if (g != first) {
      const auto same = [&](const Bond& a, const Bond& b) {
        return same_ends(a, b) && std::abs(a.r0 - b.r0) <= 1e-9 * b.r0;
      };
      if (!std::equal(bonds[g].begin(), bonds[g].end(), bonds[first].begin(), bonds[first].end(), same)) {
        refuse_file(file, fmt::format("grains {} and {} are of one template and have different bonds or rest lengths",
                                      first, g));
      }
      continue;
    }
    if (std::adjacent_find(bonds[g].begin(), bonds[g].end(), same_ends) != bonds[g].end()) {
      refuse_file(file, fmt::format("a bond of grain {} is given twice", g));
    }
    check_at_rest(file, topology, topology.template_index[g], bonds[g]);
  }
}

} // namespace

Topology read_topology(const File& file) {
  Topology topology = read_grains(file);
  topology.undeformed = read_undeformed(file);
  const std::vector<int> model = read_templates(file, topology);
  read_bonds(file, topology);
  check_networks(file, topology, model);
  return topology;
}

} // namespace boba::trajectory

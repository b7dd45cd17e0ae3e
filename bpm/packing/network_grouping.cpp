// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/network_grouping.h"

#include "bpm/packing/node_order.h"
#include "bpm/packing/whole_grains.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

namespace boba {

namespace {

/// One grain of the file: its rows in order of id, and its bonds between places in `rows`, sorted.
struct FileGrain {
  std::int64_t molecule = 0;
  std::vector<std::int64_t> rows;
  std::vector<Bond> bonds;
  double sum_r0 = 0.0; ///< tells most different networks apart at once
};

/// A template being looked for again, in the order of its first grain's `rows`.
struct KnownNetwork {
  std::vector<Bond> bonds;
  double sum_r0 = 0.0;
  std::vector<int> by_volume;     ///< places sorted by sum r0^3
  std::vector<int> place_of_node; ///< template node -> place
  int template_index = 0;
};

bool before(const Bond& a, const Bond& b) {
  return a.i != b.i ? a.i < b.i : a.j < b.j;
}

/// Smallest row of each row's connected piece.
std::vector<std::int64_t> connected_pieces(const BondedNodes& nodes) {
  std::vector<std::int64_t> parent(nodes.id.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int64_t row) {
    while (parent[row] != row) {
      row = parent[row] = parent[parent[row]];
    }
    return row;
  };
  for (const auto& [i, j] : nodes.bonds) {
    const auto [low, high] = std::minmax({root(i), root(j)});
    parent[high] = low;
  }
  std::vector<std::int64_t> piece(parent.size());
  for (std::size_t row = 0; row < parent.size(); ++row) {
    piece[row] = root(static_cast<std::int64_t>(row));
  }
  return piece;
}

bool molecules_are_grains(const BondedNodes& nodes, const std::vector<std::int64_t>& piece) {
  const auto [least, most] = std::minmax_element(nodes.molecule.begin(), nodes.molecule.end());
  if (*least <= 0) {
    return false;
  }
  const bool is_one_piece = std::all_of(piece.begin(), piece.end(), [&](std::int64_t p) { return p == piece[0]; });
  if (*least == *most && !is_one_piece) {
    return false; // one number for everything is what files hold that do not use it
  }
  return std::all_of(nodes.bonds.begin(), nodes.bonds.end(),
                     [&](const auto& bond) { return nodes.molecule[bond[0]] == nodes.molecule[bond[1]]; });
}

/// The file's nodes by grain, in order of molecule; bonds are still missing.
std::vector<FileGrain> split_into_grains(const BondedNodes& nodes) {
  const std::vector<std::int64_t> piece = connected_pieces(nodes);
  const bool by_molecule = molecules_are_grains(nodes, piece);
  std::vector<std::int64_t> order(nodes.id.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) { return nodes.id[a] < nodes.id[b]; });
  std::map<std::int64_t, FileGrain> grains;
  std::map<std::int64_t, std::int64_t> number_of_piece;
  for (const std::int64_t row : order) {
    const std::int64_t number = by_molecule
                                    ? nodes.molecule[row]
                                    : number_of_piece.emplace(piece[row], number_of_piece.size() + 1).first->second;
    FileGrain& grain = grains[number];
    grain.molecule = number;
    grain.rows.push_back(row);
  }
  std::vector<FileGrain> list;
  list.reserve(grains.size());
  for (auto& [number, grain] : grains) {
    list.push_back(std::move(grain));
  }
  return list;
}

void add_bonds(const BondedNodes& nodes, std::vector<FileGrain>& grains) {
  std::vector<int> grain_of(nodes.id.size()), place_of(nodes.id.size());
  for (std::size_t grain = 0; grain < grains.size(); ++grain) {
    for (std::size_t place = 0; place < grains[grain].rows.size(); ++place) {
      grain_of[grains[grain].rows[place]] = static_cast<int>(grain);
      place_of[grains[grain].rows[place]] = static_cast<int>(place);
    }
  }
  for (const auto& [row_i, row_j] : nodes.bonds) {
    const double r0 = nodes.box.minimum_image(nodes.position[row_i] - nodes.position[row_j]).norm();
    if (!(r0 > 0.0)) {
      throw std::invalid_argument(fmt::format("bond between nodes {} and {} has length {}; it must be positive",
                                              nodes.id[row_i], nodes.id[row_j], r0));
    }
    const auto [i, j] = std::minmax(place_of[row_i], place_of[row_j]);
    grains[grain_of[row_i]].bonds.push_back({i, j, r0});
  }
  for (FileGrain& grain : grains) {
    std::sort(grain.bonds.begin(), grain.bonds.end(), before);
    for (const Bond& bond : grain.bonds) {
      grain.sum_r0 += bond.r0;
    }
    const auto twice = std::adjacent_find(grain.bonds.begin(), grain.bonds.end(),
                                          [](const Bond& a, const Bond& b) { return a.i == b.i && a.j == b.j; });
    if (twice != grain.bonds.end()) {
      throw std::invalid_argument(fmt::format("bond between nodes {} and {} is given twice",
                                              nodes.id[grain.rows[twice->i]], nodes.id[grain.rows[twice->j]]));
    }
  }
}

std::vector<int> places_by_volume(const FileGrain& grain) {
  const std::vector<double> volume = reference_node_volumes(static_cast<int>(grain.rows.size()), grain.bonds);
  std::vector<int> places(grain.rows.size());
  std::iota(places.begin(), places.end(), 0);
  std::stable_sort(places.begin(), places.end(), [&](int a, int b) { return volume[a] < volume[b]; });
  return places;
}

/// Do the grain's bonds, with their places renamed by `place_in_known`, agree with the known ones?
bool same_bonds(const FileGrain& grain, const std::vector<int>& place_in_known, const std::vector<Bond>& known,
                double tolerance) {
  std::vector<Bond> renamed;
  renamed.reserve(grain.bonds.size());
  for (const Bond& bond : grain.bonds) {
    const auto [i, j] = std::minmax(place_in_known[bond.i], place_in_known[bond.j]);
    renamed.push_back({i, j, bond.r0});
  }
  std::sort(renamed.begin(), renamed.end(), before);
  return std::equal(renamed.begin(), renamed.end(), known.begin(), known.end(), [&](const Bond& a, const Bond& b) {
    return a.i == b.i && a.j == b.j && std::abs(a.r0 - b.r0) <= tolerance;
  });
}

/// For each place of the grain the place of the same node in the known network; empty when they differ.
std::vector<int> matching(const FileGrain& grain, const KnownNetwork& known, double tolerance) {
  const double sum_tolerance = tolerance * static_cast<double>(known.bonds.size());
  if (grain.bonds.size() != known.bonds.size() || grain.rows.size() != known.by_volume.size() ||
      std::abs(grain.sum_r0 - known.sum_r0) > sum_tolerance) {
    return {};
  }
  std::vector<int> place_in_known(grain.rows.size());
  std::iota(place_in_known.begin(), place_in_known.end(), 0);
  if (same_bonds(grain, place_in_known, known.bonds, tolerance)) {
    return place_in_known;
  }
  const std::vector<int> by_volume = places_by_volume(grain);
  for (std::size_t k = 0; k < by_volume.size(); ++k) {
    place_in_known[by_volume[k]] = known.by_volume[k];
  }
  if (same_bonds(grain, place_in_known, known.bonds, tolerance)) {
    return place_in_known;
  }
  return {};
}

/// Template of a grain that is the first of its kind; positions are filled in once the grain is whole.
GrainTemplate template_without_positions(const FileGrain& grain, const std::vector<int>& place_of_node) {
  GrainTemplate result;
  const int n_nodes = static_cast<int>(grain.rows.size());
  std::vector<int> node_of_place(n_nodes);
  for (int node = 0; node < n_nodes; ++node) {
    node_of_place[place_of_node[node]] = node;
  }
  for (const Bond& bond : grain.bonds) {
    const auto [i, j] = std::minmax(node_of_place[bond.i], node_of_place[bond.j]);
    result.bonds.push_back({i, j, bond.r0});
  }
  std::sort(result.bonds.begin(), result.bonds.end(), before);
  result.position.assign(n_nodes, Vector3::Zero());
  result.reference_volume = nominal_volume(n_nodes);
  return result;
}

double rounding_tolerance(const Box& box) {
  return 16.0 * std::numeric_limits<double>::epsilon() * (box.origin().norm() + box.h().colwise().norm().sum());
}

int species_of(const BondedNodes& nodes, const FileGrain& grain) {
  int smallest = std::numeric_limits<int>::max();
  for (const std::int64_t row : grain.rows) {
    smallest = std::min(smallest, nodes.type[row]);
  }
  return smallest - 1;
}

/// Is the grain, placed by walking its bonds, joined to its own image? Its bonds then do not all close.
bool winds_round_cell(const GroupedNetwork& grouped, int grain, const Box& box, std::span<const Vector3> whole) {
  for (const Bond& bond : grouped.packing.template_of(grain).bonds) {
    const Vector3 difference = whole[bond.i] - whole[bond.j];
    if ((difference - box.minimum_image(difference)).norm() > 0.25 * box.face_distances().minCoeff()) {
      return true;
    }
  }
  return false;
}

/// Makes the reference positions whole and gives them to the templates, centred.
void fill_positions(GroupedNetwork& grouped, std::vector<std::shared_ptr<GrainTemplate>>& templates) {
  Packing& packing = grouped.packing;
  const std::vector<std::int64_t> first = packing.first_nodes();
  // Walked as if every template were periodic, which allows bonds that do not close; those are then looked at.
  for (const auto& grain_template : templates) {
    grain_template->period = packing.box.lengths();
  }
  packing.position = whole_positions(packing, packing.box, packing.position);
  std::vector<bool> is_periodic(templates.size(), false), is_filled(templates.size(), false);
  for (int grain = 0; grain < packing.n_grains(); ++grain) {
    const auto nodes = std::span(packing.position).subspan(first[grain], first[grain + 1] - first[grain]);
    const int index = packing.grains[grain].template_index;
    const bool winds = winds_round_cell(grouped, grain, packing.box, nodes);
    if (winds && (packing.box.h() - Matrix3(packing.box.lengths().asDiagonal())).norm() > 0.0) {
      throw std::invalid_argument(
          fmt::format("grain {} is bonded to its own periodic image through a tilted cell; the "
                      "cell of the undeformed grains must be upright (xy = xz = yz = 0) for that",
                      packing.grains[grain].molecule));
    }
    is_periodic[index] = is_periodic[index] || winds;
    if (!is_filled[index]) {
      is_filled[index] = true;
      Vector3 mean = Vector3::Zero();
      for (const Vector3& x : nodes) {
        mean += x / static_cast<double>(nodes.size());
      }
      std::transform(nodes.begin(), nodes.end(), templates[index]->position.begin(),
                     [&](const Vector3& x) { return Vector3(x - mean); });
    }
  }
  for (std::size_t index = 0; index < templates.size(); ++index) {
    if (!is_periodic[index]) {
      templates[index]->period.reset();
    }
  }
}

} // namespace

GroupedNetwork group_network(const BondedNodes& nodes) {
  if (nodes.id.empty()) {
    throw std::invalid_argument("no nodes; at least one is needed");
  }
  std::vector<FileGrain> grains = split_into_grains(nodes);
  add_bonds(nodes, grains);
  const double tolerance = rounding_tolerance(nodes.box);
  std::vector<KnownNetwork> known_networks;
  std::vector<std::shared_ptr<GrainTemplate>> templates;
  GroupedNetwork grouped;
  grouped.packing.box = nodes.box;
  for (const FileGrain& grain : grains) {
    std::vector<int> place_in_known;
    const KnownNetwork* network = nullptr;
    for (std::size_t k = 0; k < known_networks.size() && network == nullptr; ++k) {
      place_in_known = matching(grain, known_networks[k], tolerance);
      network = place_in_known.empty() ? nullptr : &known_networks[k];
    }
    if (network == nullptr) {
      const std::vector<int> order = local_node_order(static_cast<int>(grain.rows.size()), grain.bonds);
      templates.push_back(std::make_shared<GrainTemplate>(template_without_positions(grain, order)));
      known_networks.push_back(
          {grain.bonds, grain.sum_r0, places_by_volume(grain), order, static_cast<int>(templates.size()) - 1});
      network = &known_networks.back();
      place_in_known.resize(grain.rows.size());
      std::iota(place_in_known.begin(), place_in_known.end(), 0);
    }
    grouped.packing.grains.push_back({network->template_index, species_of(nodes, grain), 0.0, grain.molecule});
    std::vector<std::int64_t> row_at(grain.rows.size());
    for (std::size_t place = 0; place < grain.rows.size(); ++place) {
      row_at[place_in_known[place]] = grain.rows[place];
    }
    for (const int place : network->place_of_node) {
      grouped.row.push_back(row_at[place]);
    }
  }
  grouped.packing.templates.assign(templates.begin(), templates.end());
  for (const std::int64_t row : grouped.row) {
    grouped.packing.id.push_back(nodes.id[row]);
    grouped.packing.position.push_back(nodes.position[row]);
  }
  grouped.packing.velocity.assign(grouped.row.size(), Vector3::Zero());
  fill_positions(grouped, templates);
  return grouped;
}

} // namespace boba

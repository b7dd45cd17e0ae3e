// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/contact_network.h"

#include "bpm/forces/contact_laws.h"
#include "bpm/forces/contact_search.h"
#include "bpm/forces/grain_neighbours.h"
#include "bpm/measure/footprint.h"
#include "bpm/measure/parallel_loop.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>
#include <tuple>

namespace boba::measure {

namespace {

std::vector<Bounds> bounds_of(const GrainNodes& grains) {
  std::vector<Bounds> bounds(grains.n_grains());
  for (int grain = 0; grain < grains.n_grains(); ++grain) {
    for (const Vector3& x : grains.nodes_of(grain)) {
      bounds[grain].include(x);
    }
  }
  return bounds;
}

/// Every pair of grains is looked at from the side of the lower number; a grain's own images from the positive side.
bool is_first_side(int grain, const NeighbourGrain& neighbour) {
  return neighbour.other > grain || (neighbour.other == grain && neighbour.image > ImageVector{});
}

class NetworkBuilder {
public:
  /// For the contacts of these grains.
  NetworkBuilder(const Box& box, const GrainNodes& grains, const Material& material, const DealtItems& items)
      : box_(box), grains_(grains), material_(material), law_(contact_model(between_grains(material))),
        bounds_(bounds_of(grains)), centres_(grain_centres(grains)), neighbours_(grains.n_grains()),
        grids_(grains.n_grains()) {
    const GrainNeighbours all(bounds_, box, law_->range());
    parallel_loop(items, [&](std::int64_t g) { neighbours_[g] = first_side_neighbours(all, static_cast<int>(g)); });
    std::vector<char> needed(grains.n_grains(), 0);
    for (std::int64_t k = 0; k < items.n_own(); ++k) {
      for (const NeighbourGrain& neighbour : neighbours_[items.own(k)]) {
        needed[items.own(k)] = needed[neighbour.other] = 1;
      }
    }
    parallel_loop(grains.n_grains(), [&](std::int64_t g) {
      if (needed[g]) {
        grids_[g] = GrainGrid(grains.nodes_of(static_cast<int>(g)), bounds_[g], law_->range());
      }
    });
  }

  std::vector<GrainContact> contacts_of(int grain) const {
    std::vector<GrainContact> contacts;
    std::vector<kernels::NodePair> pairs;
    for (const NeighbourGrain& neighbour : neighbours_[grain]) {
      const Vector3 shift = box_.h() * Vector3(neighbour.image.a, neighbour.image.b, neighbour.image.c);
      pairs.clear();
      add_pairs_between(grids_[grain], grids_[neighbour.other], GrainFrame{}.displaced(shift), law_->range(), pairs);
      GrainContact contact = contact_from(grain, neighbour.other, shift, pairs);
      if (contact.n_pairs > 0) {
        contact.image = {neighbour.image.a, neighbour.image.b, neighbour.image.c};
        contacts.push_back(contact);
      }
    }
    return contacts;
  }

private:
  /// By grain and image.
  static std::vector<NeighbourGrain> first_side_neighbours(const GrainNeighbours& all, int grain) {
    auto neighbours = all.of(grain);
    std::erase_if(neighbours, [&](const NeighbourGrain& neighbour) { return !is_first_side(grain, neighbour); });
    std::sort(neighbours.begin(), neighbours.end(), [](const NeighbourGrain& a, const NeighbourGrain& b) {
      return std::tie(a.other, a.image) < std::tie(b.other, b.image);
    });
    return neighbours;
  }

  GrainContact contact_from(int grain, int other, const Vector3& shift,
                            const std::vector<kernels::NodePair>& pairs) const {
    GrainContact contact{.grain = grain, .other = other};
    contact.branch = centres_[other] + shift - centres_[grain];
    const auto own = grains_.nodes_of(grain), others = grains_.nodes_of(other);
    std::vector<Vector3> midpoints;
    for (const kernels::NodePair& pair : pairs) {
      const Vector3 from_other = own[pair.i] - (others[pair.j] + shift);
      const double r = from_other.norm();
      if (!(r < law_->range())) {
        continue;
      }
      const double force = law_->force(r, 0.0);
      contact.force += force * (r > 0.0 ? Vector3(from_other / r) : Vector3(Vector3::Zero()));
      contact.largest_overlap = std::max(contact.largest_overlap, law_->range() - r);
      midpoints.push_back(own[pair.i] - 0.5 * from_other);
    }
    if (midpoints.empty()) {
      return contact;
    }
    contact.n_pairs = static_cast<int>(midpoints.size());
    contact.point = mean_position(midpoints);
    // Forces that cancel leave no direction of their own; the centres' line is then the best there is.
    contact.normal = contact.force.norm() > 0.0 ? Vector3(-contact.force.normalized()) : contact.branch.normalized();
    contact.area = footprint_area(midpoints, contact.normal, 0.5 * material_.diameter);
    return contact;
  }

  const Box& box_;
  const GrainNodes& grains_;
  const Material& material_;
  std::shared_ptr<const ContactModel> law_;
  std::vector<Bounds> bounds_;
  std::vector<Vector3> centres_;
  std::vector<std::vector<NeighbourGrain>> neighbours_;
  std::vector<GrainGrid> grids_; ///< of grains whose contacts are looked for, and of their neighbours
};

} // namespace

std::vector<GrainContact> contact_network(const Box& box, const GrainNodes& grains, const Material& material,
                                          const Ranks& ranks) {
  if (!(material.diameter > 0.0) || !std::isfinite(material.diameter)) {
    throw std::invalid_argument(
        fmt::format("contact network: the contact distance is {}; it must be positive", material.diameter));
  }
  const DealtItems items(ranks, grains.n_grains());
  const NetworkBuilder builder(box, grains, material, items);
  std::vector<std::vector<GrainContact>> of_grain(grains.n_grains());
  parallel_loop(items, [&](std::int64_t g) { of_grain[g] = builder.contacts_of(static_cast<int>(g)); });
  items.share(of_grain);
  std::vector<GrainContact> contacts;
  for (const auto& list : of_grain) {
    contacts.insert(contacts.end(), list.begin(), list.end());
  }
  return contacts;
}

Coordination coordination(int n_grains, const std::vector<GrainContact>& contacts, int min_contacts) {
  Coordination result;
  result.n_contacts.assign(n_grains, 0);
  result.is_rattler.assign(n_grains, 0);
  const auto count = [&](std::vector<int>& n) {
    for (const GrainContact& contact : contacts) {
      if (!result.is_rattler[contact.grain] && !result.is_rattler[contact.other]) {
        ++n[contact.grain];
        ++n[contact.other];
      }
    }
  };
  count(result.n_contacts);
  std::vector<int> carrying = result.n_contacts;
  for (bool found = true; found;) {
    found = false;
    for (int grain = 0; grain < n_grains; ++grain) {
      if (!result.is_rattler[grain] && carrying[grain] < min_contacts) {
        result.is_rattler[grain] = 1;
        ++result.n_rattlers;
        found = true;
      }
    }
    carrying.assign(n_grains, 0);
    count(carrying);
  }
  double all = 0.0, held = 0.0;
  for (int grain = 0; grain < n_grains; ++grain) {
    all += result.n_contacts[grain];
    held += carrying[grain];
  }
  result.mean = n_grains > 0 ? all / n_grains : 0.0;
  const int n_held = n_grains - result.n_rattlers;
  result.mean_without_rattlers = n_held > 0 ? held / n_held : 0.0;
  return result;
}

Matrix3 fabric_tensor(const std::vector<GrainContact>& contacts) {
  Matrix3 sum = Matrix3::Zero();
  for (const GrainContact& contact : contacts) {
    sum += contact.normal * contact.normal.transpose();
  }
  return contacts.empty() ? sum : Matrix3(sum / static_cast<double>(contacts.size()));
}

double fabric_anisotropy(const Matrix3& fabric) {
  const Matrix3 deviator = fabric - fabric.trace() / 3.0 * Matrix3::Identity();
  return std::sqrt(1.5 * deviator.cwiseProduct(deviator).sum());
}

} // namespace boba::measure

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/force_sums.h"

#include "bpm/forces/contact_pair.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

constexpr int grain_width = 14, contact_width = 9;

/// The rows of all grains after `distribution` has shared them.
void share_all(std::vector<GrainSums>& grains, const Distribution& distribution) {
  std::vector<double> rows;
  rows.reserve(grain_width * grains.size());
  for (const GrainSums& sums : grains) {
    rows.insert(rows.end(), sums.virial.begin(), sums.virial.end());
    rows.insert(rows.end(), sums.kinetic.begin(), sums.kinetic.end());
    rows.insert(rows.end(), {sums.virial_trace, sums.kinetic_trace});
  }
  distribution.ranks->share_rows(rows, grain_width, distribution.ownership);
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const double* row = &rows[grain_width * g];
    std::copy_n(row, 6, grains[g].virial.begin());
    std::copy_n(row + 6, 6, grains[g].kinetic.begin());
    grains[g].virial_trace = row[12];
    grains[g].kinetic_trace = row[13];
  }
}

} // namespace

void ForceSums::reset(int n_grains) {
  grains.assign(n_grains, {});
  contacts.assign(n_grains, no_contacts);
}

void share_grain_sums(ForceSums& sums, kernels::Virial virial, const LaneLayout& layout,
                      const Distribution& distribution) {
  if (!distribution.is_distributed() || virial == kernels::Virial::none) {
    return;
  }
  if (virial == kernels::Virial::full) {
    share_all(sums.grains, distribution);
    return;
  }
  std::vector<double> traces(2 * sums.grains.size());
  for (const int g : layout.grains()) {
    traces[2 * g] = sums.grains[g].virial_trace;
    traces[2 * g + 1] = sums.grains[g].kinetic_trace;
  }
  distribution.ranks->share_rows(traces, 2, distribution.ownership);
  for (std::size_t g = 0; g < sums.grains.size(); ++g) {
    sums.grains[g].virial_trace = traces[2 * g];
    sums.grains[g].kinetic_trace = traces[2 * g + 1];
  }
}

ForceSums shared_copy(const ForceSums& sums, const Distribution& distribution) {
  ForceSums all = sums;
  std::vector<double> rows;
  rows.reserve(contact_width * all.contacts.size());
  for (const kernels::ContactSums& contact : all.contacts) {
    rows.insert(rows.end(), contact.virial, contact.virial + 6);
    rows.insert(rows.end(), {contact.smallest_r2, contact.potential, static_cast<double>(contact.n_touching)});
  }
  distribution.ranks->share_rows(rows, contact_width, distribution.ownership);
  for (std::size_t g = 0; g < all.contacts.size(); ++g) {
    const double* row = &rows[contact_width * g];
    std::copy_n(row, 6, all.contacts[g].virial);
    all.contacts[g].smallest_r2 = row[6];
    all.contacts[g].potential = row[7];
    all.contacts[g].n_touching = static_cast<std::int64_t>(row[8]);
  }
  share_all(all.grains, distribution);
  return all;
}

ContactTotals contact_totals(const ForceSums& sums, const LaneLayout& layout, const Distribution& distribution,
                             double contact_range) {
  std::vector<double> energy(layout.n_grains());
  double smallest_r2 = no_contact_r2;
  std::int64_t sides = 0;
  for (const int g : layout.grains()) {
    const kernels::ContactSums& contact = sums.contacts[g];
    energy[g] = contact.potential;
    sides += contact.n_touching;
    smallest_r2 = std::min(smallest_r2, contact.smallest_r2);
  }
  distribution.ranks->share_rows(energy, 1, distribution.ownership);
  smallest_r2 = distribution.ranks->smallest(smallest_r2);
  ContactTotals totals;
  for (const double e : energy) { // grain by grain: the same sum for any number of threads and ranks
    totals.energy += e;
  }
  totals.n_touching = distribution.ranks->sum(sides) / 2;
  totals.largest_overlap = smallest_r2 < no_contact_r2 ? contact_range - std::sqrt(smallest_r2) : 0.0;
  return totals;
}

} // namespace boba

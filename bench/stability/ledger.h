// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stepper.h"

#include <cstdint>
#include <vector>

namespace boba::bench {

/// Energies and powers of a state, from the laws by plain loops over bonds and contacts, apart from the engine's
/// kernels.
struct Powers {
  double kinetic = 0.0;     ///< k d^2
  double bonds = 0.0;       ///< elastic energy of the springs, k d^2
  double contacts = 0.0;    ///< elastic energy of contacts, k d^2
  double many_body = 0.0;   ///< power of the many-body forces along the whole motion, k d^2 / tau
  double damping = 0.0;     ///< dissipated, gamma (e . v)^2 over bonds and contacts, k d^2 / tau
  double damping_box = 0.0; ///< -(damping force) along the affine motion: the box pays it, nothing receives it
  double box = 0.0;         ///< work of the box on bonds and contacts, damping included, k d^2 / tau
};

/// Evaluates a packing that the cell deforms with a velocity gradient.
class Ledger {
public:
  Ledger(const Packing& packing, const Material& material);
  Powers at(const Snapshot& snapshot, const Matrix3& gradient) const;

private:
  void bonds(const Snapshot& s, const Matrix3& gradient, Powers& powers) const;
  void contacts(const Snapshot& s, const Matrix3& gradient, Powers& powers) const;

  const Packing& packing_;
  Material material_;
  std::vector<std::int64_t> first_;
  std::vector<std::vector<std::uint8_t>> bonded_; ///< per template, n x n
  bool periodic_template_ = false;
};

/// The same integrated over time: what went where.
struct Account {
  double box = 0.0, many_body = 0.0, damping = 0.0, damping_box = 0.0; ///< k d^2, since the beginning
  Powers begin, end;

  double stored() const {
    return end.kinetic + end.bonds + end.contacts - begin.kinetic - begin.bonds - begin.contacts;
  }
  /// What the entries leave unexplained: the error of the time integration, not of the law.
  double residue() const { return stored() - (box - damping_box + many_body - damping); }
};

} // namespace boba::bench

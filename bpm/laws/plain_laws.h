// SPDX-License-Identifier: GPL-3.0-or-later
// Laws behind virtual functions, for code that evaluates one bond or contact at a time and leaves the hot loops to the
// kernels: walls, the contact network, the static solver.
#pragma once

#include "bpm/laws/bond.h"
#include "bpm/laws/contact.h"

#include <optional>

namespace boba {

/// A contact law in doubles; functions as in ContactLaw.
class PlainContact {
public:
  virtual ~PlainContact() = default;
  virtual double range() const = 0;
  virtual double force(double r, double normal_velocity) const = 0;
  virtual ContactSlopes<double> slopes(double r, double normal_velocity) const = 0;
  virtual double energy(double r) const = 0;
  /// E / (2 - 2 nu^2) of the grains where the law itself is that of elastic spheres, k/d.
  virtual std::optional<double> effective_modulus() const = 0;
};

/// The functions of an interface derived from PlainContact, by a law.
template <class Law, class Interface = PlainContact> class PlainContactOf : public Interface {
public:
  explicit PlainContactOf(const Law& law) : law_(law) {}
  double range() const override { return law_.range(); }
  double force(double r, double normal_velocity) const override { return law_.force(r, normal_velocity); }
  ContactSlopes<double> slopes(double r, double normal_velocity) const override {
    return law_.slopes(r, normal_velocity);
  }
  double energy(double r) const override { return law_.energy(r); }
  std::optional<double> effective_modulus() const override {
    if constexpr (requires { law_.effective_modulus(); }) {
      return law_.effective_modulus();
    } else {
      return std::nullopt;
    }
  }

protected:
  const Law& law() const { return law_; }

private:
  Law law_;
};

/// What the force of a bond depends on; members as the arguments of BondLaw.
struct BondState {
  double alpha, r, r0, cbrt_ratio = 1.0, normal_velocity = 0.0;
};

/// A bond law in doubles; functions as in BondLaw.
class PlainBond {
public:
  virtual ~PlainBond() = default;
  virtual double force(const BondState& bond) const = 0;
  virtual BondSlopes<double> slopes(const BondState& bond) const = 0;
};

template <class Law> class PlainBondOf final : public PlainBond {
public:
  explicit PlainBondOf(const Law& law) : law_(law) {}
  double force(const BondState& b) const override {
    return law_.force(b.alpha, b.r, b.r0, 1.0 / b.r0, b.cbrt_ratio, b.normal_velocity);
  }
  BondSlopes<double> slopes(const BondState& b) const override {
    return law_.slopes(b.alpha, b.r, b.r0, 1.0 / b.r0, b.cbrt_ratio, b.normal_velocity);
  }

private:
  Law law_;
};

} // namespace boba

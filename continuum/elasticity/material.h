// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba::continuum {

/// An isotropic, linearly elastic material. Units: Young's modulus in the unit of stress that the caller chose.
struct Material {
  double young = 1;
  double poisson = 0.25;

  /// Shear modulus E / (2 (1 + nu)).
  double shear() const { return young / (2 * (1 + poisson)); }
  /// Lame's first parameter E nu / ((1 + nu)(1 - 2 nu)); negative for auxetic materials.
  double lame() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }
  /// Modulus of uniaxial strain lambda + 2 mu = E (1 - nu) / ((1 + nu)(1 - 2 nu)).
  double uniaxial_strain() const { return lame() + 2 * shear(); }
  /// E / (1 - nu^2): the modulus of a body pressed on a rigid plane.
  double plane() const { return young / (1 - poisson * poisson); }
};

/// Throws std::invalid_argument unless E > 0 and -1 < nu < 0.5, naming the value and the range.
void check(const Material& material);

/// Throws std::invalid_argument unless value > 0 and finite; name as the user knows it.
void check_positive(const char* name, double value);

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// One number of a law, as a scene's reader and its reference page need it: name, unit, range and default.
struct Parameter {
  const char* name;
  const char* unit;
  double lowest, highest;
  bool above_lowest; ///< the lowest value itself is not allowed
  double usual;      ///< the default; a number outside the range means that there is none
  const char* meaning;
};

} // namespace boba

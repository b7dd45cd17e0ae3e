// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/template_spec.h"

#include <stdexcept>
#include <string>

namespace boba {

/// What is said of a specification; "" where it makes sense.
inline std::string complaint(const TemplateSpec& spec) {
  try {
    validate(spec);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>

namespace boba {

/// A file that somebody gave us cannot be used. The message is one line: file, line, what was found, what is allowed.
class InputError : public std::invalid_argument {
public:
  using std::invalid_argument::invalid_argument;
};

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace boba {

/// The text as one line that a terminal and a log can be given: control characters (also those of Latin-1 in UTF-8,
/// U+0080 to U+009F) as \n, \t or \xNN. A text from a file must not end a line, move the cursor or colour the rest.
std::string printable(std::string_view text);

} // namespace boba

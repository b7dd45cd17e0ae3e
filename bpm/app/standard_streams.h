// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace boba {

/// Makes the three standard streams safe to use, and a file that grows too large an error like a full disk.
///
/// A stream that the caller has closed is opened on /dev/null, so that no file of a run can get its number: what goes
/// to a closed standard output then fails as it should, what goes to a closed standard error is dropped. SIGXFSZ is
/// ignored: the write fails and is reported. To be called first.
void secure_standard_streams();

/// From now on a standard output that nobody reads any more does not end the process (SIGPIPE is ignored). For commands
/// whose result is in files.
void outlive_standard_output();

/// A line of text on standard output for the person who watches, at once. When it cannot be written, nothing happens.
void print_line(const std::string& line) noexcept;
/// The same without a line end.
void print_text(const std::string& text) noexcept;
/// A line on standard error, likewise.
void print_error(const std::string& line) noexcept;

/// Why standard output does not hold all that was written to it; "" when it does. For commands whose result it is.
std::string standard_output_failure();

} // namespace boba

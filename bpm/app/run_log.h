// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace spdlog {
class logger;
}

namespace boba {

/// The log of a run: lines with time and level in run.log. What a person should see is printed as well.
///
/// \throws std::runtime_error from any member but `last_words` when a line cannot be written.
class RunLog {
public:
  /// Appends to the file; "" for none. \throws std::runtime_error when it cannot be opened.
  RunLog(const std::filesystem::path& file, bool quiet);

  void note(const std::string& text); ///< file only
  void say(const std::string& text);  ///< file and standard output
  /// Why the run ends, in the file alone (the program prints that itself), and what the user can do, printed too. Both
  /// in the file only if it still takes them.
  void last_words(const std::string& why, const std::string& advice) noexcept;

private:
  std::shared_ptr<spdlog::logger> logger_;
  bool quiet_;
};

} // namespace boba

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
class RunLog {
public:
  /// Appends to the file; "" for none. \throws std::runtime_error when it cannot be opened.
  RunLog(const std::filesystem::path& file, bool quiet);

  void note(const std::string& text);  ///< file only
  void say(const std::string& text);   ///< file and standard output
  void warn(const std::string& text);  ///< file and standard error
  void error(const std::string& text); ///< file only: the program prints its own last words

private:
  std::shared_ptr<spdlog::logger> logger_;
  bool quiet_;
};

} // namespace boba

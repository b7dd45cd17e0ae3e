// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/run_log.h"

#include <cstdio>
#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/null_sink.h>
#include <spdlog/spdlog.h>
#include <stdexcept>

namespace boba {

RunLog::RunLog(const std::filesystem::path& file, bool quiet) : quiet_(quiet) {
  if (file.empty()) {
    logger_ = std::make_shared<spdlog::logger>("run", std::make_shared<spdlog::sinks::null_sink_mt>());
    return;
  }
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string());
    logger_ = std::make_shared<spdlog::logger>("run", sink);
  } catch (const spdlog::spdlog_ex& error) {
    throw std::runtime_error(fmt::format("{}: the log cannot be written: {}", file.string(), error.what()));
  }
  logger_->set_pattern("%Y-%m-%d %H:%M:%S %l %v");
  logger_->flush_on(spdlog::level::info);
}

// Texts are handed over as arguments, never as format strings: they may hold braces from a scene.
void RunLog::note(const std::string& text) {
  logger_->info("{}", text);
}

void RunLog::say(const std::string& text) {
  note(text);
  if (!quiet_) {
    fmt::print("{}\n", text);
    std::fflush(stdout);
  }
}

void RunLog::warn(const std::string& text) {
  logger_->warn("{}", text);
  fmt::print(stderr, "boba: warning: {}\n", text);
}

void RunLog::error(const std::string& text) {
  logger_->error("{}", text);
}

} // namespace boba

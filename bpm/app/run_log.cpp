// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/run_log.h"

#include "bpm/app/standard_streams.h"
#include "bpm/io/output_file.h"
#include "bpm/io/printable.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/null_sink.h>
#include <spdlog/spdlog.h>
#include <stdexcept>

namespace boba {

namespace {

/// Every line goes to the operating system at once, and a refusal is heard: spdlog's own files try to write a line
/// later again, and say nothing when there is no later.
class CheckedFileSink : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
public:
  explicit CheckedFileSink(const std::filesystem::path& file) : file_(file, FileMode::append) {}

protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    file_.write({line.data(), line.size()});
  }
  void flush_() override {}

private:
  OutputFile file_;
};

} // namespace

RunLog::RunLog(const std::filesystem::path& file, bool quiet) : quiet_(quiet) {
  if (file.empty()) {
    logger_ = std::make_shared<spdlog::logger>("run", std::make_shared<spdlog::sinks::null_sink_mt>());
    return;
  }
  logger_ = std::make_shared<spdlog::logger>("run", std::make_shared<CheckedFileSink>(file));
  logger_->set_pattern("%Y-%m-%d %H:%M:%S %l %v");
  logger_->set_error_handler([](const std::string& what) { throw std::runtime_error(what); });
}

// Texts are handed over as arguments, never as format strings: they may hold braces from a scene.
void RunLog::note(const std::string& text) {
  logger_->info("{}", printable(text));
}

void RunLog::say(const std::string& text) {
  note(text);
  if (!quiet_) {
    print_line(printable(text));
  }
}

void RunLog::last_words(const std::string& why, const std::string& advice) noexcept {
  try {
    logger_->error("{}", printable(why));
    say(advice);
  } catch (const std::exception&) { // the log may be what could not be written; that is told by whoever caught it first
  }
}

} // namespace boba

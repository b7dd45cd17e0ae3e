// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/uncaught_errors.h"

#include "bpm/app/exit_code.h"

#include <atomic>
#include <cstring>
#include <exception>
#include <new>
#include <unistd.h>

namespace boba {

namespace {

/// Without memory of its own. What cannot be written has nobody to be told to.
void write_text(const char* text) {
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
}

void tell(const char* message) {
  write_text("boba: ");
  write_text(message);
  write_text("\n");
}

[[noreturn]] void end_with_message() {
  static std::atomic<bool> is_told = false;
  while (is_told.exchange(true)) { // several threads at once: one speaks and ends the process
    pause();
  }
  try {
    if (const std::exception_ptr error = std::current_exception()) {
      std::rethrow_exception(error);
    }
    tell("the program ended itself without a reason");
  } catch (const std::bad_alloc&) {
    tell(out_of_memory);
  } catch (const std::exception& error) {
    tell(error.what());
  } catch (...) {
    tell("an error of an unknown kind");
  }
  _exit(static_cast<int>(ExitCode::failed)); // without cleaning up: other threads are at work
}

} // namespace

void tell_uncaught_errors() {
  std::set_terminate(end_with_message);
}

} // namespace boba

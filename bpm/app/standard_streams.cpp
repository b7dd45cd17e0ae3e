// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/standard_streams.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <iostream>
#include <unistd.h>

namespace boba {

void secure_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF) {
      // The lowest free number is this one. Standard output only for reading: who writes to it hears of the failure.
      const int opened = ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
      if (opened >= 0 && opened != stream) {
        dup2(opened, stream);
        ::close(opened);
      }
    }
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

void outlive_standard_output() {
  std::signal(SIGPIPE, SIG_IGN);
}

void print_text(const std::string& text) noexcept {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    std::clearerr(stdout);
  }
}

void print_line(const std::string& line) noexcept {
  print_text(line);
  print_text("\n");
}

void print_error(const std::string& line) noexcept {
  std::fputs(line.c_str(), stderr);
  std::fputs("\n", stderr);
  std::fflush(stderr);
}

std::string standard_output_failure() {
  errno = 0;
  std::cout.flush();
  const bool is_written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
  return is_written ? "" : errno != 0 ? std::strerror(errno) : "write error";
}

} // namespace boba

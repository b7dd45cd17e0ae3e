// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace boba {

/// Defined in programs outside the tree, by find_package(boba): the share/boba of the installation that they link.
extern const char* const linked_data_folder __attribute__((weak));

namespace {

constexpr const char* running_program = "/proc/self/exe";

/// A program's name and arguments as the system takes them: pointers into `words`, then a null.
struct ArgumentVector {
  std::vector<std::string> words;
  std::vector<char*> pointers;

  ArgumentVector(const std::filesystem::path& program, const std::vector<std::string>& arguments)
      : words{program.string()} {
    words.insert(words.end(), arguments.begin(), arguments.end());
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) {
      pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
  }
};

[[noreturn]] void cannot_start(const std::filesystem::path& program, int error) {
  throw std::runtime_error(fmt::format("{}: cannot be started: {}", program.string(), std::strerror(error)));
}

} // namespace

std::filesystem::path program_folder() {
  return std::filesystem::read_symlink(running_program).parent_path();
}

std::filesystem::path data_folder() {
  if (&linked_data_folder != nullptr) {
    return linked_data_folder;
  }
  return program_folder().parent_path() / "share/boba";
}

std::filesystem::path program_beside(const std::string& name) {
  std::filesystem::path path = program_folder() / name;
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(fmt::format(
        "{}: there is no such program; it was not built (see CMakeLists.txt, BOBA_BUILD_...)", path.string()));
  }
  return path;
}

void replace_process(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  ArgumentVector argv(program, arguments);
  execv(program.c_str(), argv.pointers.data());
  cannot_start(program, errno);
}

void restart_process(char** argv) {
  // By its own path, so that the process keeps its name.
  std::error_code error;
  if (const std::filesystem::path own = std::filesystem::read_symlink(running_program, error); !error) {
    execv(own.c_str(), argv);
  }
  execv(running_program, argv);
}

int run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                const std::filesystem::path& log) {
  ArgumentVector argv(program, arguments);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!log.empty()) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  }
  pid_t child = 0;
  const int failed = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    cannot_start(program, failed);
  }
  int status = 0;
  while (waitpid(child, &status, 0) != child) {
    if (errno != EINTR) {
      cannot_start(program, errno);
    }
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace boba

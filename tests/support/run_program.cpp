// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/run_program.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace boba::test {

namespace {

std::string take(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  std::filesystem::remove(path);
  return text;
}

[[noreturn]] void become(const std::vector<std::string>& command, const std::string& folder, const std::string& out,
                         const std::string& err) {
  const std::string cache = std::filesystem::temp_directory_path() / "boba-test-cache";
  setenv("BOBA_CACHE_DIR", cache.c_str(), 1);
  // Idle threads must not spin: several tests share the machine.
  setenv("OMP_WAIT_POLICY", "passive", 1);
  if (chdir(folder.c_str()) != 0) {
    _exit(126);
  }
  dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
  dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
  std::vector<char*> argv;
  for (const std::string& word : command) {
    argv.push_back(const_cast<char*>(word.c_str()));
  }
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  _exit(127);
}

} // namespace

ProgramResult run_program(const std::vector<std::string>& command, const std::string& folder,
                          std::optional<Disturbance> disturbance) {
  static int n_runs = 0;
  const std::string base = std::filesystem::temp_directory_path() /
                           ("boba-output-" + std::to_string(getpid()) + "-" + std::to_string(n_runs++));
  const pid_t child = fork();
  if (child == 0) {
    become(command, folder, base + ".out", base + ".err");
  }
  if (disturbance) {
    for (int i = 0; i < 6000 && !disturbance->once_exists.empty() && !std::filesystem::exists(disturbance->once_exists);
         ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(disturbance->after_seconds));
    kill(child, disturbance->signal);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ProgramResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  result.out = take(base + ".out");
  result.err = take(base + ".err");
  return result;
}

} // namespace boba::test

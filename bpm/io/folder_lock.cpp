// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/folder_lock.h"

#include "bpm/io/input_error.h"
#include "bpm/io/write_all.h"

#include <array>
#include <charconv>
#include <chrono>
#include <csignal>
#include <ctime>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <utility>

namespace boba {

namespace {

std::string machine_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown machine";
}

std::string local_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  std::array<char, 64> text{};
  const std::size_t n = std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S %z", localtime_r(&now, &parts));
  return {text.data(), n};
}

std::string lock_note(const std::string& holder) {
  return fmt::format("process {} on {}, since {} ({})\n", getpid(), machine_name(), local_time(), holder);
}

/// First line of the file. A holder writes it just after it has taken the lock, so an empty file is looked at again.
std::string note_in(const std::filesystem::path& file) {
  std::string line;
  for (int look = 0; look < 20 && line.empty(); ++look) {
    if (look > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::ifstream in(file);
    std::getline(in, line);
  }
  return line.empty() ? "a process that has not said its name" : line;
}

struct flock whole_file(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

bool is_file_of(int descriptor, const std::filesystem::path& file) {
  struct stat open_file {
  }, named_file{};
  return fstat(descriptor, &open_file) == 0 && stat(file.c_str(), &named_file) == 0 &&
         open_file.st_dev == named_file.st_dev && open_file.st_ino == named_file.st_ino;
}

int open_lock(const std::filesystem::path& file, int how) {
  return ::open(file.c_str(), how | O_RDWR | O_CREAT | O_CLOEXEC, 0666);
}

[[noreturn]] void refuse_second(const std::filesystem::path& file, const std::string& advice) {
  const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
  throw InputError(fmt::format("output: {} is in use by {}; one process at a time may write there{}", folder.string(),
                               note_in(file), advice));
}

/// The process that a record names belongs to this machine and has ended.
bool is_left_behind(const std::string& note) {
  constexpr std::string_view begin = "process ";
  if (!note.starts_with(begin) || note.find(" on " + machine_name() + ", since ") == std::string::npos) {
    return false;
  }
  pid_t process = 0;
  const auto [end, error] = std::from_chars(note.data() + begin.size(), note.data() + note.size(), process);
  return error == std::errc() && process > 0 && ::kill(process, 0) != 0 && errno == ESRCH;
}

} // namespace

FolderLock::FolderLock(std::filesystem::path file, const std::string& holder, Means means)
    : file_(std::move(file)), note_(lock_note(holder)) {
  if (means == Means::record || !take_from_system()) {
    take_by_record();
  }
  try {
    write_all(note_, file_, [this](const char* from, std::size_t n) { return ::write(descriptor_, from, n); });
  } catch (const std::exception&) {
    ::unlink(file_.c_str());
    ::close(descriptor_);
    throw;
  }
}

/// False where the file system has no locks.
bool FolderLock::take_from_system() {
  while (true) {
    descriptor_ = open_lock(file_, 0);
    if (descriptor_ < 0) {
      cannot_be_written(file_, errno);
    }
    struct flock lock = whole_file(F_WRLCK);
    const bool is_taken = fcntl(descriptor_, F_OFD_SETLK, &lock) == 0;
    const int code = errno;
    if (is_taken && is_file_of(descriptor_, file_)) {
      if (ftruncate(descriptor_, 0) != 0) {
        const int why = errno;
        ::close(descriptor_);
        cannot_be_written(file_, why);
      }
      return true;
    }
    ::close(std::exchange(descriptor_, -1));
    if (is_taken) {
      continue; // the holder before removed the file between our opening and locking it
    }
    if (code == EAGAIN || code == EACCES) {
      refuse_second(file_, "");
    }
    return false;
  }
}

void FolderLock::take_by_record() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    descriptor_ = open_lock(file_, O_EXCL);
    if (descriptor_ >= 0) {
      return;
    }
    if (errno != EEXIST) {
      cannot_be_written(file_, errno);
    }
    if (!is_left_behind(note_in(file_))) {
      break;
    }
    ::unlink(file_.c_str());
  }
  refuse_second(file_, fmt::format("; if that process has ended, remove {}", file_.string()));
}

FolderLock::~FolderLock() {
  // While the lock is held nobody else can have made another file of this name.
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

std::string FolderLock::holder_of(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) {
    return "";
  }
  struct flock lock = whole_file(F_WRLCK);
  const bool is_known = fcntl(descriptor, F_OFD_GETLK, &lock) == 0;
  ::close(descriptor);
  return is_known && lock.l_type == F_UNLCK ? "" : note_in(file);
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/on_ranks.h"

#include "bpm/parallel/message_passing.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>
#include <thread>

namespace boba {

namespace {

/// How long a rank waits with its last words for another that has the same to say.
constexpr std::chrono::milliseconds patience(1500);

void tell(int rank, const std::string& message) {
  fmt::print(stderr, "boba: rank {}: {}\n", rank, message);
  std::fflush(stderr);
}

/// An error that the others may not know of.
[[noreturn]] void end_all(const MessagePassing& mpi, const std::string& message, ExitCode code) {
  if (!mpi.ranks().is_root()) {
    std::this_thread::sleep_for(patience);
  }
  tell(mpi.ranks().rank(), message);
  mpi.abort(static_cast<int>(code));
}

} // namespace

ExitCode on_all_ranks(const std::function<ExitCode(const Ranks&)>& work) {
  const MessagePassing mpi;
  if (!mpi.ranks().is_distributed()) {
    return work(mpi.ranks());
  }
  try {
    return work(mpi.ranks());
  } catch (const RankError& error) { // all know of it
    if (mpi.ranks().is_root()) {
      tell(error.rank, error.what());
    }
    return error.is_wrong_input ? ExitCode::wrong_input : ExitCode::failed;
  } catch (const std::invalid_argument& error) {
    end_all(mpi, error.what(), ExitCode::wrong_input);
  } catch (const std::bad_alloc&) {
    end_all(mpi, "out of memory", ExitCode::failed);
  } catch (const std::exception& error) {
    end_all(mpi, error.what(), ExitCode::failed);
  }
}

bool is_other_rank() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    if (const char* rank = std::getenv(name); rank != nullptr) {
      return std::string_view(rank) != "0";
    }
  }
  return false;
}

} // namespace boba

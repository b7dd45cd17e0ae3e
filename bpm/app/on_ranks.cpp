// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/on_ranks.h"

#include "bpm/app/standard_streams.h"
#include "bpm/app/uncaught_errors.h"
#include "bpm/io/printable.h"
#include "bpm/parallel/message_passing.h"

#include <chrono>
#include <cstdlib>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>
#include <thread>

namespace boba {

namespace {

void tell(int rank, const std::string& message) {
  print_error(fmt::format("boba: rank {}: {}", rank, printable(message)));
}

/// An error that the others may not know of.
[[noreturn]] void end_all(const MessagePassing& mpi, const std::string& message, ExitCode code) {
  if (!mpi.ranks().is_root()) {
    wait_for_first_rank(1500);
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
    end_all(mpi, out_of_memory, ExitCode::failed);
  } catch (const std::exception& error) {
    end_all(mpi, error.what(), ExitCode::failed);
  }
}

void wait_for_first_rank(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/parallel/message_passing.h"

#include "bpm/parallel/star_forest.h"
#include "bpm/parallel/usable_cores.h"

#include <algorithm>
#include <cstdlib>
#include <mpi.h>
#include <stdexcept>
#include <unistd.h>

namespace boba {

namespace {

/// Set by mpirun (Open MPI), by any starter that speaks PMIx, and by srun with PMI-2.
bool started_by_mpi() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"}) {
    if (std::getenv(name) != nullptr) {
      return true;
    }
  }
  return false;
}

} // namespace

MessagePassing::MessagePassing() {
  if (started_by_mpi()) {
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    started_ = true;
    ranks_ = Ranks::of_world();
    const char* started = std::getenv("PMI_SIZE");
    if (!ranks_.is_distributed() && started != nullptr && std::strtol(started, nullptr, 10) > 1) {
      throw std::invalid_argument(
          "started several times by a launcher that MPI does not know; use mpirun, or srun --mpi=pmix");
    }
  }
}

MessagePassing::~MessagePassing() {
  if (started_) {
    finalise_star_forests();
    MPI_Finalize();
  }
}

void MessagePassing::abort(int exit_code) const {
  if (started_) {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
  }
  std::_Exit(exit_code);
}

int threads_of_a_rank(const Ranks& ranks) {
  if (!ranks.is_distributed()) {
    return usable_cores();
  }
  const int cores = cores_of_mask(); // those it is bound to
  const int on_machine = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int ranks_here = 1;
  MPI_Comm_size(machine, &ranks_here);
  MPI_Comm_free(&machine);
  const int bound = cores < on_machine ? cores : std::max(1, on_machine / ranks_here);
  const int quota = cores_of_quota(); // of all ranks here together
  return quota > 0 ? std::min(bound, std::max(1, quota / ranks_here)) : bound;
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/octant/mpi_session.h"

#include <deal.II/base/mpi.h>

namespace boba::continuum {

struct MpiSession::Handle {
  // One thread a rank: the ranks share the cores already.
  Handle() : init(argc, argv, 1) {}
  int argc = 0;
  char** argv = nullptr;
  dealii::Utilities::MPI::MPI_InitFinalize init;
};

MpiSession::MpiSession() : handle_(std::make_unique<Handle>()) {}
MpiSession::~MpiSession() = default;
int MpiSession::rank() const {
  return int(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
}
int MpiSession::size() const {
  return int(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
}

} // namespace boba::continuum

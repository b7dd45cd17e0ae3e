// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

namespace boba::continuum {

/// MPI and PETSc for the life of this object; nothing that runs in three dimensions may outlive it.
class MpiSession {
public:
  MpiSession();
  ~MpiSession();
  /// Number of this rank, from 0, and how many there are.
  int rank() const;
  int size() const;

private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/petsc_handle.h"

#include <slepcsys.h>

namespace boba::calibration {

Vector new_vector(int n) {
  Vector v;
  check(VecCreateSeq(PETSC_COMM_SELF, n, v.address()), "VecCreateSeq");
  check(VecSetBlockSize(v, 3), "VecSetBlockSize");
  check(VecSet(v, 0.0), "VecSet");
  return v;
}

PetscSession::PetscSession() {
  check(SlepcInitialize(nullptr, nullptr, nullptr, nullptr), "SlepcInitialize");
  check(PetscPopSignalHandler(), "PetscPopSignalHandler"); // a crash is the debugger's, not PETSc's
}

PetscSession::~PetscSession() {
  SlepcFinalize();
}

} // namespace boba::calibration

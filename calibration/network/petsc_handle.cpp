// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/petsc_handle.h"

#include <slepcsys.h>

namespace boba::calibration {

PetscSession::PetscSession() {
  check(SlepcInitialize(nullptr, nullptr, nullptr, nullptr), "SlepcInitialize");
  check(PetscPopSignalHandler(), "PetscPopSignalHandler"); // a crash is the debugger's, not PETSc's
}

PetscSession::~PetscSession() {
  SlepcFinalize();
}

} // namespace boba::calibration

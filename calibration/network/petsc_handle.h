// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <petscksp.h>
#include <stdexcept>
#include <string>
#include <utility>

namespace boba::calibration {

/// Throws std::runtime_error when a PETSc call failed; PETSc has printed its own trace by then.
inline void check(PetscErrorCode code, const char* what) {
  if (code != 0) {
    throw std::runtime_error(std::string("PETSc: ") + what + " failed with code " + std::to_string(code));
  }
}

/// Owns a PETSc or SLEPc object and destroys it.
template <class T, PetscErrorCode (*destroy)(T*)> class PetscHandle {
public:
  PetscHandle() = default;
  explicit PetscHandle(T object) : object_(object) {}
  PetscHandle(PetscHandle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  PetscHandle& operator=(PetscHandle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  PetscHandle(const PetscHandle&) = delete;
  PetscHandle& operator=(const PetscHandle&) = delete;
  ~PetscHandle() {
    if (object_) {
      destroy(&object_);
    }
  }

  operator T() const { return object_; } // NOLINT: passed to PETSc calls
  T* address() { return &object_; }

private:
  T object_ = nullptr;
};

using Matrix = PetscHandle<Mat, MatDestroy>;
using Vector = PetscHandle<Vec, VecDestroy>;
using Solver = PetscHandle<KSP, KSPDestroy>;
using NullSpace = PetscHandle<MatNullSpace, MatNullSpaceDestroy>;

/// A vector of n zeros in blocks of three, on this process. \throws std::runtime_error when PETSc cannot.
Vector new_vector(int n);

/// Starts PETSc and SLEPc (and MPI) for the life of the object; one per program. They read the environment
/// (PETSC_OPTIONS) but no command line.
class PetscSession {
public:
  PetscSession();
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

} // namespace boba::calibration

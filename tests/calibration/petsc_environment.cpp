// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/petsc_handle.h"

#include <gtest/gtest.h>
#include <memory>

namespace boba::calibration {
namespace {

/// PETSc lives as long as the test program's cases.
class PetscEnvironment : public testing::Environment {
public:
  void SetUp() override { session_ = std::make_unique<PetscSession>(); }
  void TearDown() override { session_.reset(); }

private:
  std::unique_ptr<PetscSession> session_;
};

const auto* const environment = testing::AddGlobalTestEnvironment(new PetscEnvironment);

} // namespace
} // namespace boba::calibration

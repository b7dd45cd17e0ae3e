// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/comparison/comparison_case.h"

#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

} // namespace
} // namespace boba::calibration

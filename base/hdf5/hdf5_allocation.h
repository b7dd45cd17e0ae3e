// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <hdf5.h>

namespace boba::hdf5 {

/// Files opened with these access properties allow File::allocate_frame. \throws std::runtime_error.
void use_allocation_driver(hid_t access);

} // namespace boba::hdf5

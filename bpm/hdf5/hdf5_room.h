// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <hdf5.h>

namespace boba::hdf5 {

/// Files opened with these access properties can have rooms (File::make_room). \throws std::runtime_error.
void use_room_driver(hid_t access);

} // namespace boba::hdf5

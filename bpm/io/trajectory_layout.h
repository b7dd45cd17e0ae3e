// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/hdf5/hdf5_file.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace boba::trajectory {

// Names that the writer and the reader of trajectories share.
inline constexpr const char* all = "/particles/all";
inline constexpr const char* box = "/particles/all/box";
inline constexpr const char* position = "/particles/all/position";
inline constexpr const char* image = "/particles/all/image";
inline constexpr const char* velocity = "/particles/all/velocity";
inline constexpr const char* damage = "/particles/all/boba_damage";
inline constexpr const char* bonds_yield = "boba_bonds_yield"; ///< attribute of the grains' alpha
inline constexpr const char* edges = "/particles/all/box/edges";
inline constexpr const char* box_origin = "/particles/all/box/boba_origin";
inline constexpr const char* strain = "/observables/strain";
inline constexpr const char* grain_centre = "/observables/grain_centre";
inline constexpr const char* grain_stress = "/observables/grain_stress";
inline constexpr const char* streaming_rate = "/observables/streaming_rate";
inline constexpr const char* grains = "/parameters/grains";

inline std::string value_of(const char* element) {
  return std::string(element) + "/value";
}
inline std::string step_name() {
  return std::string(position) + "/step";
}
inline std::string time_name() {
  return std::string(position) + "/time";
}

/// 1 once the writer has closed the file, 0 while it writes and after a kill.
inline constexpr const char* closed = "/parameters/closed";

// Fill values: what a reader sees of a frame that was never written.
inline constexpr double not_written = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::int32_t image_not_written = std::numeric_limits<std::int32_t>::min();

/// \throws InputError with the file's name in front.
[[noreturn]] void refuse_file(const hdf5::File& file, const std::string& why);

/// Steps of the frames that are complete: every dataset has them, and no value is still the fill value.
std::vector<std::int64_t> complete_steps(const hdf5::File& file);

/// The growing datasets a file holds (with `/value`); velocities and streaming rates only when they are stored.
std::vector<std::string> growing_values(const hdf5::File& file);

} // namespace boba::trajectory

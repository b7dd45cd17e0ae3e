// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace boba::fuzz {

/// A file in memory that holds these bytes; the path is good until the next call.
/// \throws std::runtime_error when there is no memory for it.
std::filesystem::path file_of(std::span<const std::uint8_t> bytes);

} // namespace boba::fuzz

/// What each target defines: reads the bytes as its format. Refusals (InputError) are caught, anything else is a
/// finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

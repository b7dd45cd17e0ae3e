// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

#include <filesystem>
#include <optional>
#include <string>

namespace boba {

/// Writes a template and the text that names it to an HDF5 file, with a checksum over all of it; an existing file is
/// replaced in one step (rename).
/// \throws std::runtime_error with the file's name when it cannot be written.
void write_template(const std::filesystem::path& file, const GrainTemplate& grain, const std::string& text);

/// The template in `file`, or nothing if the file is absent, damaged, or holds another text.
std::optional<GrainTemplate> read_template(const std::filesystem::path& file, const std::string& text);

} // namespace boba

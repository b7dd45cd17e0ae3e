// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/app/uniaxial_file.h"

#include <CLI/StringTools.hpp>
#include <CLI/TypeTools.hpp>
#include <fmt/format.h>
#include <fstream>

namespace boba::continuum {

std::vector<UniaxialState> read_uniaxial_test(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) {
    throw std::invalid_argument(fmt::format("fit = {} cannot be read", file.string()));
  }
  std::vector<UniaxialState> result;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const auto fields = CLI::detail::split(line, ',');
    double values[3];
    bool right = fields.size() == 3;
    for (std::size_t k = 0; right && k < 3; ++k) {
      right = CLI::detail::lexical_cast(CLI::detail::trim_copy(fields[k]), values[k]);
    }
    if (right) {
      result.push_back({1 - values[0], 1 + values[2], -values[1]});
    } else if (number > 1) {
      throw std::invalid_argument(fmt::format("fit = {}, line {}: \"{}\" is not `strain, stress, lateral strain`",
                                              file.string(), number, line));
    }
  }
  return result;
}

} // namespace boba::continuum

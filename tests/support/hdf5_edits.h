// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace boba::test {

/// One change to an HDF5 file that a library of HDF5 can make: the file stays sound, what it says does not.
struct Hdf5Edit {
  enum class What {
    remove,
    replace,       ///< another dataset of `shape` and `type`, all of its values `value`
    set_value,     ///< the value at place `at` (modulo their number) becomes `value`
    resize,        ///< the first length of a dataset that can grow becomes `at`
    soft_link,     ///< to `other`
    external_link, ///< to another file
    group,
    share,     ///< a second name of the dataset `other`
    attribute, ///< all text attributes of the object's group become "periodic x"
  };
  enum class Type { int8, int32, int64, uint64, float32, float64, text, long_text, variable_text, compound };

  What what = What::remove;
  std::string dataset;
  std::vector<std::uint64_t> shape;
  Type type = Type::float64;
  double value = 0.0;
  std::uint64_t at = 0;
  std::string other;
};

/// Names of all datasets, sorted.
std::vector<std::string> hdf5_datasets(const std::filesystem::path& file);

/// Makes the change; one that cannot be made (no such dataset any more) is left out.
void apply(const std::filesystem::path& file, const std::vector<Hdf5Edit>& edits);

} // namespace boba::test

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace boba::continuum {

/// A new HDF5 file of one-dimensional arrays of doubles; replaces a file of the same name.
/// All functions throw std::runtime_error when HDF5 refuses.
class Hdf5File {
public:
  explicit Hdf5File(const std::filesystem::path& path);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Writes an array; missing groups of its name are made. unit becomes the attribute boba_unit.
  void array(const std::string& name, const std::vector<double>& values, const std::string& unit);
  /// Writes a text attribute of an object.
  void attribute(const std::string& object, const std::string& name, const std::string& text);

private:
  long file_;
};

} // namespace boba::continuum

// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/app/hdf5_file.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <stdexcept>

namespace boba::continuum {
namespace {

template <class Id> Id checked(Id id, const char* what, const std::string& name) {
  if (id < 0) {
    throw std::runtime_error(fmt::format("HDF5 cannot {} {}", what, name));
  }
  return id;
}

} // namespace

Hdf5File::Hdf5File(const std::filesystem::path& path)
    : file_(checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), "create", path.string())) {}

Hdf5File::~Hdf5File() {
  H5Fclose(file_);
}

void Hdf5File::array(const std::string& name, const std::vector<double>& values, const std::string& unit) {
  const hsize_t size = values.size();
  const hid_t space = checked(H5Screate_simple(1, &size, nullptr), "make a space for", name);
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  const hid_t set =
      checked(H5Dcreate2(file_, name.c_str(), H5T_IEEE_F64LE, space, links, H5P_DEFAULT, H5P_DEFAULT), "create", name);
  checked(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "write", name);
  H5Dclose(set);
  H5Pclose(links);
  H5Sclose(space);
  attribute(name, "boba_unit", unit);
}

void Hdf5File::attribute(const std::string& object, const std::string& name, const std::string& text) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, text.size() + 1);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t id = checked(
      H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      "create the attribute", name);
  checked(H5Awrite(id, type, text.c_str()), "write the attribute", name);
  H5Aclose(id);
  H5Sclose(space);
  H5Tclose(type);
}

} // namespace boba::continuum

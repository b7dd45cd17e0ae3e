// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hdf5_edits.h"

#include "base/hdf5/hdf5_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <hdf5.h>
#include <limits>
#include <stdexcept>

namespace boba::test {

namespace {

using hdf5::Handle;
using Type = Hdf5Edit::Type;

Handle type_of(Type wanted) {
  switch (wanted) {
  case Type::int8:
    return Handle(H5Tcopy(H5T_NATIVE_INT8));
  case Type::int32:
    return Handle(H5Tcopy(H5T_NATIVE_INT32));
  case Type::int64:
    return Handle(H5Tcopy(H5T_NATIVE_INT64));
  case Type::uint64:
    return Handle(H5Tcopy(H5T_NATIVE_UINT64));
  case Type::float32:
    return Handle(H5Tcopy(H5T_NATIVE_FLOAT));
  case Type::float64:
    return Handle(H5Tcopy(H5T_NATIVE_DOUBLE));
  case Type::compound: {
    Handle type(H5Tcreate(H5T_COMPOUND, 16));
    H5Tinsert(type, "a", 0, H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "b", 8, H5T_NATIVE_INT32);
    return type;
  }
  default: {
    Handle type(H5Tcopy(H5T_C_S1));
    H5Tset_size(type, wanted == Type::variable_text ? H5T_VARIABLE : std::size_t{wanted == Type::text ? 3U : 70000U});
    return type;
  }
  }
}

bool is_number(Type type) {
  return type <= Type::float64;
}

/// A number as HDF5 turns it into whatever the dataset holds.
void write_at(hid_t dataset, std::uint64_t at, double value) {
  const Handle space(H5Dget_space(dataset));
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  if (n <= 0 || H5Tget_class(Handle(H5Dget_type(dataset))) > H5T_FLOAT) {
    return;
  }
  std::array<hsize_t, H5S_MAX_RANK> shape{}, place{};
  const int rank = H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  std::uint64_t rest = at % static_cast<std::uint64_t>(n);
  for (int axis = rank - 1; axis >= 0; --axis) {
    place[axis] = rest % shape[axis];
    rest /= shape[axis];
  }
  if (rank > 0) {
    H5Sselect_elements(space, H5S_SELECT_SET, 1, place.data());
  }
  const Handle memory(H5Screate(H5S_SCALAR));
  H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value);
}

void replace(hid_t file, const Hdf5Edit& edit) {
  H5Ldelete(file, edit.dataset.c_str(), H5P_DEFAULT);
  const Handle type = type_of(edit.type), creation(H5Pcreate(H5P_DATASET_CREATE));
  if (is_number(edit.type)) {
    H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &edit.value);
  }
  H5Pset_fill_time(creation, H5D_FILL_TIME_ALLOC);
  std::uint64_t n = 1;
  for (const std::uint64_t length : edit.shape) {
    n *= std::min<std::uint64_t>(length, 1 << 20);
  }
  // Large ones keep no values in the file: only their shape is large.
  H5Pset_alloc_time(creation, n < 4096 ? H5D_ALLOC_TIME_EARLY : H5D_ALLOC_TIME_INCR);
  const Handle space(edit.shape.empty()
                         ? H5Screate(H5S_SCALAR)
                         : H5Screate_simple(static_cast<int>(edit.shape.size()),
                                            std::vector<hsize_t>(edit.shape.begin(), edit.shape.end()).data(),
                                            nullptr));
  const Handle dataset(H5Dcreate2(file, edit.dataset.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
}

void set_attributes(hid_t file, const std::string& object) {
  const Handle owner(H5Oopen(file, object.substr(0, object.rfind('/', object.rfind('/') - 1)).c_str(), H5P_DEFAULT));
  if (owner < 0) {
    return;
  }
  for (const char* name : {"boundary", "name"}) {
    if (H5Aexists(owner, name) > 0) {
      H5Adelete(owner, name);
      const Handle type = type_of(Type::text);
      const std::array<hsize_t, 1> shape = {2};
      const Handle space(H5Screate_simple(1, shape.data(), nullptr));
      const Handle attribute(H5Acreate2(owner, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
      H5Awrite(attribute, type, "abcdef");
    }
  }
}

void make(hid_t file, const Hdf5Edit& edit) {
  using What = Hdf5Edit::What;
  const char* name = edit.dataset.c_str();
  switch (edit.what) {
  case What::replace:
    replace(file, edit);
    return;
  case What::set_value:
    if (const Handle dataset(H5Dopen2(file, name, H5P_DEFAULT)); dataset >= 0) {
      write_at(dataset, edit.at, edit.value);
    }
    return;
  case What::resize:
    if (const Handle dataset(H5Dopen2(file, name, H5P_DEFAULT)); dataset >= 0) {
      std::array<hsize_t, H5S_MAX_RANK> shape{};
      H5Sget_simple_extent_dims(Handle(H5Dget_space(dataset)), shape.data(), nullptr);
      shape[0] = edit.at;
      H5Dset_extent(dataset, shape.data());
    }
    return;
  case What::attribute:
    set_attributes(file, edit.dataset);
    return;
  default:
    break;
  }
  H5Ldelete(file, name, H5P_DEFAULT);
  if (edit.what == What::soft_link) {
    H5Lcreate_soft(edit.other.c_str(), file, name, H5P_DEFAULT, H5P_DEFAULT);
  } else if (edit.what == What::external_link) {
    H5Lcreate_external("elsewhere.h5", edit.other.c_str(), file, name, H5P_DEFAULT, H5P_DEFAULT);
  } else if (edit.what == What::group) {
    const Handle group(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  } else if (edit.what == What::share) {
    H5Lcreate_hard(file, edit.other.c_str(), file, name, H5P_DEFAULT, H5P_DEFAULT);
  }
}

Handle open(const std::filesystem::path& file, unsigned mode) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_file_locking(access, false, true);
  Handle opened(H5Fopen(file.c_str(), mode, access));
  if (opened < 0) {
    throw std::runtime_error("hdf5_edits: cannot open " + file.string());
  }
  return opened;
}

} // namespace

std::vector<std::string> hdf5_datasets(const std::filesystem::path& file) {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* data) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) {
      static_cast<std::vector<std::string>*>(data)->push_back("/" + std::string(name));
    }
    return 0;
  };
  H5Ovisit2(open(file, H5F_ACC_RDONLY), H5_INDEX_NAME, H5_ITER_INC, visit, &names, H5O_INFO_BASIC);
  std::sort(names.begin(), names.end());
  return names;
}

void apply(const std::filesystem::path& file, const std::vector<Hdf5Edit>& edits) {
  const Handle opened = open(file, H5F_ACC_RDWR);
  for (const Hdf5Edit& edit : edits) {
    make(opened, edit);
  }
}

} // namespace boba::test

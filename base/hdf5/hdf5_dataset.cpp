// SPDX-License-Identifier: GPL-3.0-or-later
// What a file says of its datasets, checked before memory is taken for their values: it may come from anywhere.
#include "base/hdf5/hdf5_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::hdf5 {

namespace {

/// Bytes that a filter (deflate) may make of one stored byte, at most.
constexpr std::uint64_t most_expansion = 1100;
/// Bytes that may be read beyond what is stored: values never written read as the fill value.
constexpr std::uint64_t most_fill = 1 << 20;

std::string shown(const std::vector<hsize_t>& shape) {
  return fmt::format("[{}]", fmt::join(shape, " x "));
}

File::Content content_of_type(hid_t type) {
  const std::size_t size = H5Tget_size(type);
  switch (H5Tget_class(type)) {
  case H5T_INTEGER:
    return size <= 8 ? File::Content::integer : File::Content::other;
  case H5T_FLOAT:
    return size == 4 || size == 8 ? File::Content::real : File::Content::other;
  case H5T_STRING:
    return H5Tis_variable_str(type) == 0 ? File::Content::text : File::Content::other;
  default:
    return File::Content::other;
  }
}

} // namespace

bool File::has(const std::string& name) const {
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    const std::string part = name.substr(0, slash);
    H5L_info_t link;
    if (H5Lexists(id_, part.c_str(), H5P_DEFAULT) <= 0 || H5Lget_info(id_, part.c_str(), &link, H5P_DEFAULT) < 0) {
      return false;
    }
    if (link.type != H5L_TYPE_HARD) { // of another file, maybe
      throw std::runtime_error(
          fmt::format("{}: {} is a link to somewhere else; it must be in the file itself", path_.string(), part));
    }
    if (slash == std::string::npos) {
      return true;
    }
  }
}

File::Dataset File::look(const std::string& name) const {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("{}: {} {}", path_.string(), name, why));
  };
  if (!has(name)) {
    refuse("is not there");
  }
  const Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  const Handle creation(H5Dget_create_plist(dataset)), type(H5Dget_type(dataset)), space(H5Dget_space(dataset));
  if (H5Pget_layout(creation) == H5D_VIRTUAL || H5Pget_external_count(creation) > 0) {
    refuse("has its values in other files; they must be in the file itself");
  }
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0 || H5Sget_simple_extent_type(space) == H5S_NULL) {
    refuse("holds nothing");
  }
  Dataset result;
  result.shape.resize(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space, result.shape.data(), nullptr);
  result.content = content_of_type(type);
  result.value_size = H5Tget_size(type);
  const std::uint64_t stored = std::min<std::uint64_t>(H5Dget_storage_size(dataset), file_length());
  result.most_bytes = stored * (H5Pget_nfilters(creation) > 0 ? most_expansion : 1) + most_fill;
  return result;
}

std::uint64_t File::file_length() const {
  hsize_t length = 0;
  check(H5Fget_filesize(id_, &length), "asking for the length");
  return length;
}

/// Product of the lengths from `from` on, when so many values can be in the dataset.
hsize_t File::values_in(const std::string& name, std::size_t from, Content wanted) const {
  const Dataset dataset = look(name);
  if (dataset.content != wanted) {
    throw std::runtime_error(fmt::format("{}: {} does not hold {} numbers", path_.string(), name,
                                         wanted == Content::integer ? "whole" : "real"));
  }
  if (dataset.shape.size() < from) {
    throw std::runtime_error(fmt::format("{}: {} has no frames", path_.string(), name));
  }
  hsize_t n = 1;
  for (std::size_t axis = from; axis < dataset.shape.size(); ++axis) {
    const hsize_t length = dataset.shape[axis];
    if (length > 0 && n > dataset.most_bytes / dataset.value_size / length) {
      throw std::runtime_error(fmt::format("{}: {} of shape {} has more values than the file can hold", path_.string(),
                                           name, shown(dataset.shape)));
    }
    n *= length;
  }
  return n;
}

hsize_t File::n_values(const std::string& name, Content wanted) const {
  return values_in(name, 0, wanted);
}

hsize_t File::frame_size(const std::string& name, Content wanted) const {
  return values_in(name, 1, wanted);
}

} // namespace boba::hdf5

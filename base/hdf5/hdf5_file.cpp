// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/hdf5/hdf5_file.h"

#include "base/hdf5/hdf5_allocation.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace boba::hdf5 {

namespace {

/// The innermost entry of HDF5's error stack: the one with the cause.
std::string reason() {
  std::string text = "no reason given";
  const auto take = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    if (error->desc != nullptr && error->desc[0] != '\0') {
      *static_cast<std::string*>(data) = error->desc;
    }
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, take, &text);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

Handle access_properties(bool allocates_frames) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS));
  if (allocates_frames) {
    use_allocation_driver(access);
  }
  // Others may read the file while the run goes on.
  H5Pset_file_locking(access, false, true);
  // Metadata stays in memory until flush(): a process killed between two flushes leaves the file of the last one.
  H5AC_cache_config_t cache;
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  H5Pget_mdc_config(access, &cache);
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  cache.evictions_enabled = false;
  H5Pset_mdc_config(access, &cache);
  return access;
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

Handle simple_space(std::vector<hsize_t> shape) {
  return Handle(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr));
}

hsize_t product(const std::vector<hsize_t>& shape, std::size_t from = 0) {
  return std::accumulate(shape.begin() + static_cast<std::ptrdiff_t>(from), shape.end(), hsize_t{1},
                         std::multiplies<>());
}

std::string up_to_zero(const char* text, std::size_t length) {
  return {text, std::find(text, text + length, '\0')};
}

} // namespace

hid_t File::check(hid_t result, const std::string& doing) const {
  if (result < 0) {
    const std::string why = reason();
    if (writable_ && id_ >= 0) {
      detach();
    }
    throw std::runtime_error(fmt::format("{}: {} failed: {}", path_.string(), doing, why));
  }
  return result;
}

void File::detach() const {
  // HDF5 cannot close a file that it could not write: it crashes, at the latest when the program ends. So from here on
  // it writes into memory instead, which succeeds; the file on the disk stays as it was last flushed.
  int* descriptor = nullptr;
  if (H5Fget_vfd_handle(id_, H5P_DEFAULT, reinterpret_cast<void**>(&descriptor)) < 0) {
    return;
  }
  const int memory = memfd_create("given up", MFD_CLOEXEC);
  struct stat status = {};
  if (memory >= 0 && fstat(*descriptor, &status) == 0) {
    dup2(memory, *descriptor);
    ::close(memory);
  }
}

File File::create(const std::filesystem::path& path, bool allocates_frames) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // failures are thrown, not printed
  File file;
  file.path_ = path;
  file.writable_ = true;
  const Handle creation(H5Pcreate(H5P_FILE_CREATE));
  // Wide nodes in the index of chunks: it is split, which touches several places, only once in 1024 frames.
  H5Pset_istore_k(creation, 512);
  const Handle access = access_properties(allocates_frames);
  file.id_ = Handle(file.check(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), "creating the file"));
  return file;
}

File File::open(const std::filesystem::path& path, bool writable, bool allocates_frames) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // failures are thrown, not printed
  File file;
  file.path_ = path;
  file.writable_ = writable;
  const Handle access = access_properties(allocates_frames);
  file.id_ = Handle(
      file.check(H5Fopen(path.c_str(), writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access), "opening the HDF5 file"));
  return file;
}

void File::make_group(const std::string& name) const {
  const Handle links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links, 1);
  const Handle group(check(H5Gcreate2(id_, name.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), "making group " + name));
}

std::vector<hsize_t> File::shape(const std::string& name) const {
  const Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  const Handle space(check(H5Dget_space(dataset), "reading " + name));
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(rank, 0)));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

void File::put_attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                         const void* values) const {
  const Handle owner(check(H5Oopen(id_, object.c_str(), H5P_DEFAULT), "opening " + object));
  const Handle attribute(
      check(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), "making attribute " + name));
  check(H5Awrite(attribute, type, values), "writing attribute " + name);
}

void File::set_attribute(const std::string& object, const std::string& name, const std::string& text) const {
  const Handle type = text_type(text.size());
  const Handle space(H5Screate(H5S_SCALAR));
  put_attribute(object, name, type, space, text.c_str());
}

void File::set_attribute(const std::string& object, const std::string& name,
                         std::span<const std::int32_t> values) const {
  const Handle space = values.size() == 1 ? Handle(H5Screate(H5S_SCALAR)) : simple_space({values.size()});
  put_attribute(object, name, H5T_NATIVE_INT32, space, values.data());
}

void File::set_attribute(const std::string& object, const std::string& name,
                         const std::vector<std::string>& texts) const {
  std::size_t length = 1;
  for (const std::string& text : texts) {
    length = std::max(length, text.size());
  }
  std::string packed;
  for (const std::string& text : texts) {
    packed += text + std::string(length - text.size(), '\0');
  }
  put_attribute(object, name, text_type(length), simple_space({texts.size()}), packed.data());
}

std::vector<std::string> File::texts_attribute(const std::string& object, const std::string& name) const {
  const Handle attribute(
      check(H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), "opening attribute " + name));
  const Handle type(H5Aget_type(attribute)), space(H5Aget_space(attribute));
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) {
    throw std::runtime_error(fmt::format("{}: attribute {} is not a string of fixed length", path_.string(), name));
  }
  const std::size_t length = H5Tget_size(type);
  const hssize_t points = H5Sget_simple_extent_npoints(space);
  constexpr std::size_t most = 1 << 16; // bytes; attributes are small
  if (points < 0 || points > static_cast<hssize_t>(most) || length > most ||
      static_cast<std::size_t>(points) * length > most) {
    throw std::runtime_error(fmt::format("{}: attribute {} is too large", path_.string(), name));
  }
  const auto n = static_cast<std::size_t>(points);
  std::string packed(n * length, '\0');
  check(H5Aread(attribute, type, packed.data()), "reading attribute " + name);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < n; ++i) {
    texts.push_back(up_to_zero(packed.data() + i * length, length));
  }
  return texts;
}

bool File::has_attribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::string File::text_attribute(const std::string& object, const std::string& name) const {
  const std::vector<std::string> texts = texts_attribute(object, name);
  if (texts.size() != 1) {
    throw std::runtime_error(
        fmt::format("{}: attribute {} holds {} texts, not one", path_.string(), name, texts.size()));
  }
  return texts[0];
}

void File::write_text(const std::string& name, const std::string& text) const {
  const Handle type = text_type(text.size());
  const Handle space(H5Screate(H5S_SCALAR));
  Handle dataset(
      check(H5Dcreate2(id_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), "making " + name));
  check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), "writing " + name);
  close_dataset(dataset, name);
}

std::string File::read_text(const std::string& name) const {
  const Dataset dataset_info = look(name);
  if (dataset_info.content != Content::text || product(dataset_info.shape) != 1 ||
      dataset_info.value_size > dataset_info.most_bytes) {
    throw std::runtime_error(fmt::format("{}: {} is not a text of fixed length", path_.string(), name));
  }
  const Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  const Handle type(H5Dget_type(dataset));
  std::string text(dataset_info.value_size, '\0');
  check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "reading " + name);
  return up_to_zero(text.data(), text.size());
}

void File::close_dataset(Handle& dataset, const std::string& name) const {
  check(H5Dclose(dataset.release()), "writing " + name);
}

void File::write_raw(const std::string& name, const void* values, hid_t type, hsize_t n, hsize_t width) const {
  const Handle space = width > 1 ? simple_space({n / width, width}) : simple_space({n});
  Handle dataset(
      check(H5Dcreate2(id_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), "making " + name));
  if (n > 0) {
    check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "writing " + name);
  }
  close_dataset(dataset, name);
}

void File::rewrite_raw(const std::string& name, const void* values, hid_t type) const {
  Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "writing " + name);
  close_dataset(dataset, name);
}

void File::read_raw(const std::string& name, void* values, hid_t type) const {
  const Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "reading " + name);
}

void File::make_growing_raw(const std::string& name, const Growing& layout, hid_t type, const void* fill) const {
  std::vector<hsize_t> now = {0}, most = {H5S_UNLIMITED}, chunk = {layout.frames_per_chunk};
  for (const hsize_t length : layout.frame_shape) {
    now.push_back(length);
    most.push_back(length);
    chunk.push_back(length);
  }
  const hsize_t row = H5Tget_size(type) * product(chunk) / (chunk.size() > 1 ? std::max<hsize_t>(chunk[1], 1) : 1);
  if (chunk.size() > 1 && chunk[1] > layout.largest_chunk / row) {
    const hsize_t most_rows = std::max<hsize_t>(layout.largest_chunk / row, 1);
    const hsize_t n_slabs = (chunk[1] + most_rows - 1) / most_rows;
    chunk[1] = (chunk[1] + n_slabs - 1) / n_slabs;
  }
  const Handle space(check(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), "shaping " + name));
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE)), links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links, 1);
  H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  H5Pset_fill_value(creation, type, fill);
  if (layout.compression > 0) {
    H5Pset_shuffle(creation);
    H5Pset_deflate(creation, static_cast<unsigned>(layout.compression));
  }
  const Handle dataset(
      check(H5Dcreate2(id_, name.c_str(), type, space, links, creation, H5P_DEFAULT), "making " + name));
}

int File::compression(const std::string& name) const {
  const Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  const Handle creation(H5Dget_create_plist(dataset));
  unsigned flags = 0, level = 0;
  std::size_t n_values = 1;
  const bool has_level =
      H5Pget_filter_by_id2(creation, H5Z_FILTER_DEFLATE, &flags, &n_values, &level, 0, nullptr, nullptr) >= 0;
  return has_level ? static_cast<int>(level) : 0;
}

bool File::has_whole_frames(const std::string& name) const {
  const Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  const Handle creation(H5Dget_create_plist(dataset));
  const std::vector<hsize_t> extent = shape(name);
  std::vector<hsize_t> chunk(extent.size(), 0);
  return H5Pget_chunk(creation, static_cast<int>(chunk.size()), chunk.data()) == static_cast<int>(chunk.size()) &&
         H5Pget_nfilters(creation) == 0 && chunk[0] == 1 &&
         std::equal(chunk.begin() + 1, chunk.end(), extent.begin() + 1);
}

void File::set_frames(const std::string& name, hsize_t n_frames) const {
  std::vector<hsize_t> extent = shape(name);
  extent.at(0) = n_frames;
  Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  check(H5Dset_extent(dataset, extent.data()), "resizing " + name);
  close_dataset(dataset, name);
}

void File::write_frame_raw(const std::string& name, hsize_t frame, const void* values, hid_t type, hsize_t n) const {
  std::vector<hsize_t> extent = shape(name);
  if (n != product(extent, 1)) {
    throw std::runtime_error(
        fmt::format("{}: a frame of {} has {} values; {} were given", path_.string(), name, product(extent, 1), n));
  }
  if (extent[0] <= frame) {
    set_frames(name, frame + 1);
  }
  Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  const Handle space(H5Dget_space(dataset));
  std::vector<hsize_t> start(extent.size(), 0), count = extent;
  start[0] = frame;
  count[0] = 1;
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  // Of the frame's own shape: otherwise HDF5 goes through its chunk number by number.
  const Handle memory = simple_space(count);
  check(H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, values), "writing " + name);
  close_dataset(dataset, name);
}

void File::read_frame_raw(const std::string& name, hsize_t frame, void* values, hid_t type) const {
  const Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  const Handle space(H5Dget_space(dataset));
  std::vector<hsize_t> count = shape(name), start(count.size(), 0);
  start[0] = frame;
  count[0] = 1;
  check(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
        "selecting in " + name);
  const Handle memory = simple_space(count);
  check(H5Dread(dataset, type, memory, space, H5P_DEFAULT, values), "reading " + name);
}

void File::link(const std::string& name, const std::string& other_name) const {
  const Handle links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links, 1);
  check(H5Lcreate_hard(id_, name.c_str(), id_, other_name.c_str(), links, H5P_DEFAULT), "linking " + other_name);
}

void File::set_reference(const std::string& object, const std::string& attribute, const std::string& target) const {
  hobj_ref_t reference = 0;
  check(H5Rcreate(&reference, id_, target.c_str(), H5R_OBJECT, H5I_INVALID_HID), "referring to " + target);
  const Handle space(H5Screate(H5S_SCALAR));
  put_attribute(object, attribute, H5T_STD_REF_OBJ, space, &reference);
}

std::pair<int, std::uint64_t> File::descriptor_and_length() const {
  haddr_t length = 0;
  void* descriptor = nullptr;
  check(H5Fget_eoa(id_, &length), "asking for the length");
  check(H5Fget_vfd_handle(id_, H5P_DEFAULT, &descriptor), "asking for the descriptor");
  return {*static_cast<int*>(descriptor), length};
}

void File::reserve(std::uint64_t n_bytes) const {
  const auto [descriptor, length] = descriptor_and_length();
  int code = EINTR;
  while (code == EINTR) {
    code = fallocate(descriptor, 0, 0, static_cast<off_t>(length + n_bytes)) == 0 ? 0 : errno;
  }
  if (code != 0 && code != EOPNOTSUPP && code != ENOSYS) {
    detach(); // what HDF5 still holds may not fit either
    throw std::runtime_error(
        fmt::format("{}: no room for {} more bytes: {}", path_.string(), n_bytes, std::strerror(code)));
  }
}

void File::flush() const {
  // The superblock names the length of the file. Were the file shorter at that moment, a kill would leave one that HDF5
  // refuses to open; so it gets its length beforehand.
  const auto [descriptor, length] = descriptor_and_length();
  struct stat status = {};
  if (fstat(descriptor, &status) == 0 && static_cast<std::uint64_t>(status.st_size) < length) {
    check(ftruncate(descriptor, static_cast<off_t>(length)), "growing the file");
  }
  check(H5Fflush(id_, H5F_SCOPE_GLOBAL), "writing to the disk");
}

void File::close() {
  if (id_ < 0) {
    return;
  }
  flush();
  const auto [descriptor, length] = descriptor_and_length();
  check(ftruncate(descriptor, static_cast<off_t>(length)), "giving back reserved space");
  // Closing writes the superblock once more, to say that nobody has the file open for writing; nobody reads that in a
  // superblock of this version, and were the write to fail it would go unseen, or HDF5 crash. All else is on the disk.
  detach();
  id_ = Handle();
}

} // namespace boba::hdf5

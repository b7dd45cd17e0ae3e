// SPDX-License-Identifier: GPL-3.0-or-later
// Frames whose chunk gets a place in the file and an entry in the index, while others write their values.
#include "base/hdf5/hdf5_allocation.h"

#include "base/hdf5/hdf5_file.h"

#include <cstdlib>
#include <fmt/format.h>
#include <memory>
#include <stdexcept>

namespace boba::hdf5 {

namespace {

/// HDF5's own driver of POSIX files.
const H5FD_class_t* posix = nullptr;
bool is_allocating = false;

/// HDF5 has no call that gives a chunk its place and writes nothing. So it writes one, and values are dropped here.
herr_t write_unless_allocating(H5FD_t* file, H5FD_mem_t type, hid_t transfer, haddr_t at, std::size_t n,
                               const void* bytes) {
  return is_allocating && type == H5FD_MEM_DRAW ? 0 : posix->write(file, type, transfer, at, n, bytes);
}

/// The POSIX driver with another way to write.
hid_t allocation_driver() {
  static H5FD_class_t driver;
  static const hid_t id = [] {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS));
    H5Pset_fapl_sec2(access);
    H5FD_t* any = H5FDopen("/dev/null", H5F_ACC_RDONLY, access, HADDR_UNDEF); // what is open shows its driver
    if (any == nullptr) {
      return hid_t{H5I_INVALID_HID};
    }
    posix = any->cls;
    driver = *posix;
    driver.name = "boba allocation";
    driver.write = write_unless_allocating;
    H5FDclose(any);
    return H5FDregister(&driver);
  }();
  return id;
}

struct AllocatingOnly {
  AllocatingOnly() { is_allocating = true; }
  ~AllocatingOnly() { is_allocating = false; }
};

} // namespace

void use_allocation_driver(hid_t access) {
  if (H5Pset_driver(access, allocation_driver(), nullptr) < 0) {
    throw std::runtime_error("HDF5 does not take a driver for files that several ranks write");
  }
}

std::uint64_t File::allocate_frame_raw(const std::string& name, hsize_t frame, hid_t type) const {
  std::vector<hsize_t> extent = shape(name);
  set_frames(name, frame + 1);
  Handle dataset(check(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), "opening " + name));
  const Handle creation(H5Dget_create_plist(dataset)), stored(H5Dget_type(dataset));
  std::vector<hsize_t> chunk(extent.size());
  H5Pget_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  extent[0] = 1;
  if (chunk != extent || H5Pget_nfilters(creation) != 0 || H5Tequal(stored, type) <= 0) {
    throw std::runtime_error(fmt::format("{}: {} is not stored frame by frame as it is", path_.string(), name));
  }
  std::size_t n_bytes = H5Tget_size(type);
  for (const hsize_t length : extent) {
    n_bytes *= length;
  }
  // Never read, so the system gives it no memory.
  // NOLINTNEXTLINE(cppcoreguidelines-no-malloc): a container would touch every page
  const std::unique_ptr<void, decltype(&std::free)> nothing(std::calloc(n_bytes, 1), &std::free);
  std::vector<hsize_t> at(extent.size(), 0);
  at[0] = frame;
  {
    const AllocatingOnly now;
    check(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, at.data(), n_bytes, nothing.get()), "allocating a frame of " + name);
  }
  unsigned filters = 0;
  haddr_t place = HADDR_UNDEF;
  hsize_t size = 0;
  check(H5Dget_chunk_info_by_coord(dataset, at.data(), &filters, &place, &size), "asking for the place of " + name);
  if (place == HADDR_UNDEF || size != n_bytes) {
    throw std::runtime_error(fmt::format("{}: HDF5 has allocated no frame of {}", path_.string(), name));
  }
  close_dataset(dataset, name);
  return place;
}

} // namespace boba::hdf5

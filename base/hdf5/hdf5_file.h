// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Thin handles around the HDF5 C API, for what reads and writes files of it: trajectories (io) and templates (grain).

#include <cstdint>
#include <filesystem>
#include <hdf5.h>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace boba::hdf5 {

/// Owns an HDF5 identifier of any kind.
class Handle {
public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) {
      H5Idec_ref(id_);
    }
  }
  operator hid_t() const { return id_; }
  /// Hands the identifier over; it is no longer closed here.
  hid_t release() { return std::exchange(id_, H5I_INVALID_HID); }

private:
  hid_t id_ = H5I_INVALID_HID;
};

template <typename T> hid_t type_of();
template <> inline hid_t type_of<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <> inline hid_t type_of<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <> inline hid_t type_of<std::int32_t>() {
  return H5T_NATIVE_INT32;
}

/// An open file and the few operations that Boba's files need. Every failure is a std::runtime_error with the file's
/// name, what was being done, and HDF5's own reason.
class File {
public:
  File() = default;
  /// Replaces a file of this name. \param allocates_frames whether allocate_frame will be called
  static File create(const std::filesystem::path& path, bool allocates_frames = false);
  static File open(const std::filesystem::path& path, bool writable, bool allocates_frames = false);

  void make_group(const std::string& name) const;
  /// \throws std::runtime_error when the name leads through a link to somewhere else.
  bool has(const std::string& name) const;
  std::vector<hsize_t> shape(const std::string& dataset) const;

  enum class Content { integer, real, text, other };
  /// What a dataset says of itself, before anything of it is read.
  struct Dataset {
    std::vector<hsize_t> shape;
    Content content = Content::other;
    std::size_t value_size = 0;   ///< bytes
    std::uint64_t most_bytes = 0; ///< no more can be read from what the file stores of it
  };
  /// \throws std::runtime_error when there is no such dataset, or when its values lie outside this file: a dataset of
  /// another file behind a link, a virtual one, one with external storage.
  Dataset look(const std::string& dataset) const;

  void set_attribute(const std::string& object, const std::string& name, const std::string& text) const;
  void set_attribute(const std::string& object, const std::string& name, std::span<const std::int32_t> values) const;
  /// Fixed-length strings, as H5MD wants the boundary of a box.
  void set_attribute(const std::string& object, const std::string& name, const std::vector<std::string>& texts) const;
  bool has_attribute(const std::string& object, const std::string& name) const;
  std::string text_attribute(const std::string& object, const std::string& name) const;
  std::vector<std::string> texts_attribute(const std::string& object, const std::string& name) const;

  void write_text(const std::string& name, const std::string& text) const;
  std::string read_text(const std::string& name) const;

  /// A dataset that never changes; `width` > 1 makes it a table of rows of that many numbers.
  template <typename T> void write(const std::string& name, std::span<const T> values, hsize_t width = 1) const {
    write_raw(name, values.data(), type_of<T>(), values.size(), width);
  }
  /// New values for such a dataset, as many as before.
  template <typename T> void rewrite(const std::string& name, std::span<const T> values) const {
    rewrite_raw(name, values.data(), type_of<T>());
  }
  /// \throws std::runtime_error unless it holds numbers of T's kind, as many as the file can hold.
  template <typename T> std::vector<T> read(const std::string& name) const {
    std::vector<T> values(n_values(name, content_of<T>()));
    read_raw(name, values.data(), type_of<T>());
    return values;
  }
  /// One frame of a growing dataset. \throws std::runtime_error as read.
  template <typename T> std::vector<T> read_frame(const std::string& name, hsize_t frame) const {
    std::vector<T> values(frame_size(name, content_of<T>()));
    read_frame_raw(name, frame, values.data(), type_of<T>());
    return values;
  }

  /// A dataset [frames][shape ...] with no frame yet. `frames_per_chunk` frames are stored together.
  struct Growing {
    std::vector<hsize_t> frame_shape;
    hsize_t frames_per_chunk = 1;
    int compression = 0; ///< 0 (none) .. 9
    /// HDF5 stores no chunk of 4 GiB and more: larger frames are cut along their first length, bytes.
    std::uint64_t largest_chunk = (std::uint64_t{1} << 32) - 1;
  };
  template <typename T> void make_growing(const std::string& name, const Growing& layout, T fill) const {
    make_growing_raw(name, layout, type_of<T>(), &fill);
  }
  template <typename T> void write_frame(const std::string& name, hsize_t frame, std::span<const T> values) const {
    write_frame_raw(name, frame, values.data(), type_of<T>(), values.size());
  }
  /// The frame as if it had been written, but its values are left to others: returns where in the file they belong,
  /// bytes from its begin. Of a dataset of T with one frame a chunk and no compression.
  template <typename T> std::uint64_t allocate_frame(const std::string& name, hsize_t frame) const {
    return allocate_frame_raw(name, frame, type_of<T>());
  }
  int compression(const std::string& name) const;
  /// Is a frame one chunk, as it is stored? Only then allocate_frame has a place for all of it.
  bool has_whole_frames(const std::string& name) const;
  void set_frames(const std::string& name, hsize_t n_frames) const;
  /// A second name for the same dataset.
  void link(const std::string& name, const std::string& other_name) const;
  void set_reference(const std::string& object, const std::string& attribute, const std::string& target) const;

  /// Takes room for this many more bytes on the disk. HDF5 cannot recover from a full disk: it crashes when it closes
  /// the file, so the lack of room has to show before HDF5 meets it.
  void reserve(std::uint64_t n_bytes) const;
  /// Hands all to the operating system so that the file can be read even if the process is killed right afterwards.
  void flush() const;
  void close();
  /// Takes the file away from HDF5: what is written from now on is lost, and the file stays as it was last flushed.
  void detach() const;
  bool is_open() const { return id_ >= 0; }
  const std::filesystem::path& path() const { return path_; }

private:
  std::pair<int, std::uint64_t> descriptor_and_length() const;
  hid_t check(hid_t result, const std::string& doing) const;
  void write_raw(const std::string& name, const void* values, hid_t type, hsize_t n, hsize_t width) const;
  void rewrite_raw(const std::string& name, const void* values, hid_t type) const;
  void read_raw(const std::string& name, void* values, hid_t type) const;
  template <typename T> static constexpr Content content_of() {
    return std::is_floating_point_v<T> ? Content::real : Content::integer;
  }
  hsize_t n_values(const std::string& name, Content wanted) const;
  hsize_t frame_size(const std::string& name, Content wanted) const;
  hsize_t values_in(const std::string& name, std::size_t from, Content wanted) const;
  std::uint64_t file_length() const;
  void make_growing_raw(const std::string& name, const Growing& layout, hid_t type, const void* fill) const;
  void write_frame_raw(const std::string& name, hsize_t frame, const void* values, hid_t type, hsize_t n) const;
  std::uint64_t allocate_frame_raw(const std::string& name, hsize_t frame, hid_t type) const;
  void read_frame_raw(const std::string& name, hsize_t frame, void* values, hid_t type) const;
  void put_attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                     const void* values) const;

  /// Closes a dataset: what its cache still holds is written now, and a failure must not pass unseen.
  void close_dataset(Handle& dataset, const std::string& name) const;

  std::filesystem::path path_;
  Handle id_;
  bool writable_ = false;
};

} // namespace boba::hdf5

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_file.h"

#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <hdf5.h>
#include <stdexcept>
#include <string_view>
#include <unistd.h>
#include <zlib.h>

namespace boba {

namespace {

namespace fs = std::filesystem;

/// An HDF5 identifier that closes itself.
class Handle {
public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id_ < 0) {
      throw std::runtime_error("HDF5 call failed");
    }
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; } // NOLINT: used as an identifier

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void require(bool ok, const char* what) {
  if (!ok) {
    throw std::runtime_error(what);
  }
}

/// Keeps HDF5 from printing its error stack: a damaged cache file is an ordinary event here.
class QuietErrors {
public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// The template as flat arrays, the way it lies in the file.
struct Flat {
  std::vector<char> text;
  std::vector<double> position; // 3 n
  std::vector<int> ends;        // 2 per bond
  std::vector<double> r0;
  std::vector<double> period; // 3 or none
  std::vector<double> reference_volume;

  template <class Visit> void visit(Visit&& use) {
    use("specification", text, H5T_STD_I8LE, H5T_NATIVE_CHAR, "");
    use("position", position, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, "d");
    use("bond_nodes", ends, H5T_STD_I32LE, H5T_NATIVE_INT, "");
    use("bond_r0", r0, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, "d");
    use("period", period, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, "d");
    use("reference_volume", reference_volume, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, "d^3");
  }
};

Flat flatten(const GrainTemplate& grain, const std::string& text) {
  Flat flat;
  flat.text.assign(text.begin(), text.end());
  for (const auto& x : grain.position) {
    flat.position.insert(flat.position.end(), {x.x(), x.y(), x.z()});
  }
  for (const Bond& bond : grain.bonds) {
    flat.ends.insert(flat.ends.end(), {bond.i, bond.j});
    flat.r0.push_back(bond.r0);
  }
  if (grain.period) {
    flat.period = {grain.period->x(), grain.period->y(), grain.period->z()};
  }
  flat.reference_volume = {grain.reference_volume};
  return flat;
}

GrainTemplate unflatten(const Flat& flat) {
  GrainTemplate grain;
  for (std::size_t n = 0; n + 2 < flat.position.size(); n += 3) {
    grain.position.emplace_back(flat.position[n], flat.position[n + 1], flat.position[n + 2]);
  }
  for (std::size_t b = 0; b < flat.r0.size(); ++b) {
    grain.bonds.push_back({flat.ends.at(2 * b), flat.ends.at(2 * b + 1), flat.r0[b]});
  }
  if (flat.period.size() == 3) {
    grain.period = Eigen::Vector3d(flat.period[0], flat.period[1], flat.period[2]);
  }
  grain.reference_volume = flat.reference_volume.at(0);
  return grain;
}

void write_text_attribute(hid_t object, const char* name, const std::string& value) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(type, value.size() + 1) >= 0, "string type");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(H5Awrite(attribute, type, value.c_str()) >= 0, "attribute");
}

void write_flat(const fs::path& file, Flat flat) {
  const Handle h5(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  flat.visit([&](const char* name, auto& data, hid_t file_type, hid_t memory_type, const char* unit) {
    const hsize_t length = data.size();
    const Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
    const Handle set(H5Dcreate2(h5, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    if (*unit) {
      write_text_attribute(set, "boba_unit", unit);
    }
    require(data.empty() || H5Dwrite(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) >= 0, name);
  });
}

Flat read_flat(const fs::path& file) {
  const Handle h5(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  Flat flat;
  flat.visit([&](const char* name, auto& data, hid_t, hid_t memory_type, const char*) {
    const Handle set(H5Dopen2(h5, name, H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(set), H5Sclose);
    hsize_t length = 0;
    require(H5Sget_simple_extent_ndims(space) == 1, "rank");
    H5Sget_simple_extent_dims(space, &length, nullptr);
    data.resize(length);
    require(length == 0 || H5Dread(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) >= 0, name);
  });
  return flat;
}

// The file is an HDF5 file followed by this seal: a mark and the CRC-32 (zlib) of all bytes before it. HDF5 ignores
// what follows its own end, and is never shown a damaged file (its library does not recover cleanly from some of them).
constexpr std::string_view seal_mark = "BOBASEAL";
constexpr std::size_t seal_length = seal_mark.size() + sizeof(std::uint64_t);

std::string read_bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string seal_of(std::string_view bytes) {
  const std::uint64_t crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  std::string seal(seal_mark);
  for (int byte = 0; byte < 8; ++byte) {
    seal += static_cast<char>(crc >> (8 * byte) & 0xff);
  }
  return seal;
}

void append_seal(const fs::path& file) {
  const std::string seal = seal_of(read_bytes(file));
  std::ofstream out(file, std::ios::binary | std::ios::app);
  out << seal;
  out.close();
  require(out.good(), "seal");
}

bool seal_is_right(const fs::path& file) {
  const std::string bytes = read_bytes(file);
  if (bytes.size() <= seal_length) {
    return false;
  }
  const std::string_view content(bytes.data(), bytes.size() - seal_length);
  return seal_of(content) == std::string_view(bytes).substr(content.size());
}

} // namespace

void write_template(const fs::path& file, const GrainTemplate& grain, const std::string& text) {
  const fs::path beside = fmt::format("{}.{}.part", file.string(), getpid());
  std::error_code ignored;
  try {
    const QuietErrors quiet;
    write_flat(beside, flatten(grain, text));
    append_seal(beside);
    fs::rename(beside, file);
  } catch (const std::exception& error) {
    fs::remove(beside, ignored);
    throw std::runtime_error(fmt::format("cannot write the grain template {}: {}", file.string(), error.what()));
  }
}

std::optional<GrainTemplate> read_template(const fs::path& file, const std::string& text) {
  std::error_code missing;
  if (!fs::is_regular_file(file, missing) || !seal_is_right(file)) {
    return std::nullopt;
  }
  try {
    const QuietErrors quiet;
    const Flat flat = read_flat(file);
    if (std::string(flat.text.begin(), flat.text.end()) != text) {
      return std::nullopt;
    }
    return unflatten(flat);
  } catch (const std::exception&) {
    return std::nullopt; // damaged or foreign: the caller builds it again
  }
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_file.h"

#include "base/hdf5/hdf5_file.h"
#include "bpm/grain/sound_template.h"

#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string_view>
#include <unistd.h>
#include <zlib.h>

namespace boba {

namespace {

namespace fs = std::filesystem;

constexpr const char* specification = "specification_text";
/// Taken on the disk beyond the numbers, bytes: HDF5's own and the text.
constexpr std::uint64_t room_for_the_rest = 1 << 16;

/// The template's numbers as flat arrays, the way they lie in the file.
struct Flat {
  std::vector<double> position;   // 3 n
  std::vector<std::int32_t> ends; // 2 per bond
  std::vector<double> r0;
  std::vector<double> period; // 3 or none
  std::vector<double> reference_volume;

  template <class Visit> void visit(Visit&& use) {
    use("position", position, "d");
    use("bond_nodes", ends, "");
    use("bond_r0", r0, "d");
    use("period", period, "d");
    use("reference_volume", reference_volume, "d^3");
  }
};

Flat flatten(const GrainTemplate& grain) {
  Flat flat;
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

/// \throws std::invalid_argument when the arrays do not fit together or hold what no template can.
GrainTemplate unflatten(const Flat& flat) {
  if (flat.position.size() % 3 != 0 || flat.ends.size() != 2 * flat.r0.size() ||
      (flat.period.size() != 3 && !flat.period.empty()) || flat.reference_volume.size() != 1) {
    throw std::invalid_argument("its arrays have lengths that do not belong together");
  }
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
  if (const auto wrong = unsound_part(grain)) {
    throw std::invalid_argument(*wrong);
  }
  return grain;
}

void write_flat(const fs::path& path, Flat flat, const std::string& text) {
  hdf5::File file = hdf5::File::create(path);
  std::uint64_t n_bytes = room_for_the_rest + text.size();
  flat.visit([&](const char*, const auto& data, const char*) { n_bytes += data.size() * sizeof(data[0]); });
  file.reserve(n_bytes);
  file.write_text(specification, text);
  flat.visit([&]<class T>(const char* name, const std::vector<T>& data, const std::string& unit) {
    file.write(name, std::span<const T>(data));
    if (!unit.empty()) {
      file.set_attribute(name, "boba_unit", unit);
    }
  });
  file.close();
}

/// Nothing where the file holds another text.
std::optional<Flat> read_flat(const fs::path& path, const std::string& text) {
  const hdf5::File file = hdf5::File::open(path, false);
  if (file.read_text(specification) != text) {
    return std::nullopt;
  }
  Flat flat;
  flat.visit([&]<class T>(const char* name, std::vector<T>& data, const char*) { data = file.read<T>(name); });
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
  if (!out.good()) {
    throw std::runtime_error("its checksum cannot be written");
  }
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
    write_flat(beside, flatten(grain), text);
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
    const std::optional<Flat> flat = read_flat(file, text);
    return flat ? std::optional(unflatten(*flat)) : std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt; // damaged or foreign: the caller builds it again
  }
}

} // namespace boba

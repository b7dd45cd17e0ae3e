// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/checkpoint.h"

#include "bpm/io/checkpoint_names.h"
#include "bpm/io/input_error.h"
#include "bpm/io/output_file.h"
#include "bpm/io/shared_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <zlib.h>

namespace boba {

// The file: mark, length of the file, number of fields; each field: type, length of its name, number of dimensions,
// length of its values in bytes, dimensions, name, values; at the end the checksum of all bytes before it. Numbers are
// 64 bits wide, little-endian. It is written piece by piece, so that a large packing needs no second copy in memory,
// and only this source reads it. The checksum is one that can be put together from those of pieces, which ranks have
// written.

namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

constexpr std::string_view mark = "BOBACKP3", any_mark = "BOBACKP";
enum class Kind : std::uint64_t { text = 1, real = 2, integer = 3 };

std::uint32_t checksum(std::string_view bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <typename T> std::string_view bytes_of(const T* values, std::size_t n) {
  return {reinterpret_cast<const char*>(values), n * sizeof(T)};
}

Kind kind_of(const SavedValue& value) {
  return std::holds_alternative<SavedValue::Text>(value.values)    ? Kind::text
         : std::holds_alternative<SavedValue::Reals>(value.values) ? Kind::real
                                                                   : Kind::integer;
}

std::string_view bytes_of(const SavedValue& value) {
  return std::visit([](const auto& values) { return bytes_of(values.data(), values.size()); }, value.values);
}

/// A piece of the file that somebody has written.
struct Piece {
  std::uint64_t at = 0, n = 0; ///< bytes
  std::uint32_t sum = 0;
};

/// What one rank writes of a checkpoint.
class PieceWriter {
public:
  explicit PieceWriter(const std::filesystem::path& path) : file_(path) {}

  void write(std::uint64_t at, std::string_view bytes) {
    if (bytes.empty()) {
      return;
    }
    file_.write(at, bytes.data(), bytes.size());
    pieces_.push_back({at, bytes.size(), checksum(bytes)});
  }
  const std::vector<Piece>& pieces() const { return pieces_; }
  SharedFile& file() { return file_; }

private:
  SharedFile file_;
  std::vector<Piece> pieces_;
};

/// Hands the head of the file to a writer; small pieces go out together.
class HeadWriter {
public:
  explicit HeadWriter(PieceWriter& out) : out_(out) {}

  void put(std::string_view bytes) {
    constexpr std::size_t portion = 1 << 18;
    if (bytes.size() >= portion) {
      flush();
      put_now(bytes);
    } else {
      gathered_ += bytes;
    }
  }
  void put_number(std::uint64_t number) { put(bytes_of(&number, 1)); }
  /// Leaves room for others to write; returns where it begins.
  std::uint64_t leave_room(std::uint64_t n_bytes) {
    flush();
    at_ += n_bytes;
    return at_ - n_bytes;
  }
  void flush() {
    put_now(gathered_);
    gathered_.clear();
  }

private:
  void put_now(std::string_view bytes) {
    out_.write(at_, bytes);
    at_ += bytes.size();
  }

  PieceWriter& out_;
  std::string gathered_;
  std::uint64_t at_ = 0; ///< of what is gathered
};

/// Everything but the values of nodes. Returns where those begin, in the order of `nodes.names`.
std::vector<std::uint64_t> write_fields(PieceWriter& out, const SavedState& data, const NodeFields& nodes) {
  constexpr std::size_t width = sizeof(std::uint64_t);
  const auto place_in_names = [&](const std::string& name) {
    return std::find(nodes.names.begin(), nodes.names.end(), name) - nodes.names.begin();
  };
  const auto is_of_nodes = [&](const std::string& name) { return place_in_names(name) < std::ssize(nodes.names); };
  const auto length_of = [&](const std::string& name, const SavedValue& value) {
    return is_of_nodes(name) ? 3 * width * static_cast<std::uint64_t>(nodes.n_nodes) : bytes_of(value).size();
  };
  std::uint64_t length = mark.size() + 3 * width; // length, number of fields, checksum
  for (const auto& [name, value] : data) {
    length += 4 * width + value.shape.size() * width + name.size() + length_of(name, value);
  }
  HeadWriter head(out);
  head.put(mark);
  head.put_number(length);
  head.put_number(data.size());
  std::vector<std::uint64_t> places(nodes.names.size(), 0);
  for (const auto& [name, value] : data) {
    head.put_number(static_cast<std::uint64_t>(kind_of(value)));
    head.put_number(name.size());
    head.put_number(value.shape.size());
    head.put_number(length_of(name, value));
    if (is_of_nodes(name)) {
      head.put_number(static_cast<std::uint64_t>(nodes.n_nodes));
      head.put_number(3);
      head.put(name);
      places[place_in_names(name)] = head.leave_room(length_of(name, value));
    } else {
      head.put(bytes_of(value.shape.data(), value.shape.size()));
      head.put(name);
      head.put(bytes_of(value));
    }
  }
  head.flush();
  return places;
}

/// This rank's nodes of each of their entries.
void write_nodes(PieceWriter& out, const SavedState& data, const NodeFields& nodes,
                 const std::vector<std::uint64_t>& places) {
  constexpr std::uint64_t width = 3 * sizeof(double);
  static_assert(sizeof(double) == sizeof(std::int64_t));
  for (std::size_t k = 0; k < nodes.names.size(); ++k) {
    const auto at = data.find(nodes.names[k]);
    std::string_view values = at != data.end() ? bytes_of(at->second) : std::string_view();
    for (const NodeRun& run : nodes.own) {
      const std::uint64_t n = run.n * width;
      if (values.size() < n) {
        throw std::logic_error("'" + nodes.names[k] + "' does not hold this rank's nodes");
      }
      out.write(places[k] + run.first * width, values.substr(0, n));
      values.remove_prefix(n);
    }
  }
}

/// Puts the checksum behind all pieces, which must be the whole file without a gap.
void write_checksum(SharedFile& file, std::vector<Piece> pieces) {
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.at < b.at; });
  std::uint64_t end = 0, sum = 0;
  for (const Piece& piece : pieces) {
    if (piece.at != end) {
      throw std::logic_error(fmt::format("nobody has written the bytes from {} to {}", end, piece.at));
    }
    sum = crc32_combine(sum, piece.sum, static_cast<z_off_t>(piece.n));
    end += piece.n;
  }
  file.write(end, &sum, sizeof sum);
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw InputError(fmt::format("{}: refused as a checkpoint: {}", path.string(), why));
}

/// Reads numbers and names from a file whose checksum is right already; the bounds are checked all the same.
class FieldReader {
public:
  FieldReader(const std::filesystem::path& path, std::uint64_t length)
      : path_(path), in_(path, std::ios::binary), left_(length) {}

  void take(char* target, std::uint64_t n) {
    if (n > left_ || !in_.read(target, static_cast<std::streamsize>(n))) {
      refuse(path_, "a field goes beyond the end of the file");
    }
    left_ -= n;
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    take(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  }
  /// As many values as fit into `n_bytes`.
  template <typename Values> Values values(std::uint64_t n_bytes) {
    using Value = typename Values::value_type;
    if (n_bytes > left_ || n_bytes % sizeof(Value) != 0) {
      refuse(path_, "a field goes beyond the end of the file");
    }
    Values result(n_bytes / sizeof(Value), Value{});
    take(reinterpret_cast<char*>(result.data()), n_bytes);
    return result;
  }

private:
  const std::filesystem::path& path_;
  std::ifstream in_;
  std::uint64_t left_;
};

std::uint64_t checked_dimensions(const std::filesystem::path& path, std::uint64_t n_dimensions) {
  constexpr std::uint64_t most_dimensions = 8;
  if (n_dimensions > most_dimensions) {
    refuse(path, fmt::format("a field has {} dimensions; at most {} are known", n_dimensions, most_dimensions));
  }
  return n_dimensions;
}

/// Throws unless the file has the length it names and its checksum is right.
std::uint64_t checked_length(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    refuse(path, "it cannot be opened");
  }
  std::error_code error;
  const std::uint64_t length = std::filesystem::file_size(path, error);
  std::string head(mark.size() + sizeof(std::uint64_t), '\0');
  if (error || !in.read(head.data(), static_cast<std::streamsize>(head.size())) || !head.starts_with(any_mark)) {
    refuse(path, "it does not begin like one");
  }
  if (!head.starts_with(mark)) {
    refuse(path, fmt::format("it was written by another version of Boba, most likely an older one ({}, not {})",
                             head.substr(0, mark.size()), mark));
  }
  std::uint64_t named_length = 0;
  std::memcpy(&named_length, head.data() + mark.size(), sizeof named_length);
  if (named_length != length) {
    refuse(path, fmt::format("truncated or altered: {} bytes long, {} were written", length, named_length));
  }
  std::uint64_t right = checksum(head);
  std::uint64_t left = length - head.size() - sizeof(std::uint64_t);
  std::string chunk(std::min<std::uint64_t>(left, 1 << 20), '\0');
  while (left > 0) {
    const std::uint64_t n = std::min<std::uint64_t>(left, chunk.size());
    if (!in.read(chunk.data(), static_cast<std::streamsize>(n))) {
      refuse(path, "it cannot be read to its end");
    }
    right = checksum({chunk.data(), n}, static_cast<std::uint32_t>(right));
    left -= n;
  }
  std::uint64_t sum = 0;
  if (!in.read(reinterpret_cast<char*>(&sum), sizeof sum) || sum != right) {
    refuse(path, "altered: its checksum does not fit its content");
  }
  return length;
}

bool is_whole(const std::filesystem::path& path) {
  try {
    checked_length(path);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Removes what is older than the newest `keep` whole checkpoints; damaged ones do not count as kept.
void remove_older(const std::filesystem::path& directory, int keep) {
  int n_whole = 0;
  for (const NumberedCheckpoint& file : checkpoints_in(directory)) {
    std::error_code ignored; // a file that cannot be removed is no reason to stop a run
    if (n_whole >= keep) {
      std::filesystem::remove(file.path, ignored);
    } else if (is_whole(file.path)) {
      ++n_whole;
    }
  }
}

} // namespace

std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const SavedState& data, int keep) {
  return write_checkpoint(directory, data, Ranks::alone(), {}, keep);
}

std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const SavedState& data,
                                       const Ranks& ranks, const NodeFields& nodes, int keep) {
  const std::vector<NumberedCheckpoint> before =
      ranks.is_root() ? checkpoints_in(directory) : std::vector<NumberedCheckpoint>{};
  const std::uint64_t number = before.empty() ? 1 : before.front().number + 1;
  std::filesystem::path path = directory / checkpoint_name(number);
  std::string beside = path.string() + ".part";
  const auto tell = [&](const std::exception& error) {
    std::error_code ignored;
    if (ranks.is_root()) {
      std::filesystem::remove(beside, ignored);
    }
    return fmt::format("checkpoint not written: {}{}", error.what(),
                       before.empty() ? "" : fmt::format("; the last one remains: {}", before.front().path.string()));
  };
  try {
    ranks.on_root([&] {
      std::filesystem::create_directories(directory);
      OutputFile(beside, FileMode::overwrite).close();
    });
    ranks.broadcast(beside);
    std::optional<PieceWriter> out;
    std::vector<std::uint64_t> places;
    ranks.collectively([&] { out.emplace(beside); });
    ranks.on_root([&] { places = write_fields(*out, data, nodes); });
    ranks.broadcast(places);
    ranks.collectively([&] {
      write_nodes(*out, data, nodes, places);
      if (!ranks.is_root()) {
        out->file().sync();
        out->file().close();
      }
    });
    const std::vector<Piece> pieces = ranks.gathered(out->pieces());
    ranks.on_root([&] {
      write_checksum(out->file(), pieces);
      out->file().sync();
      out->file().close();
      std::filesystem::rename(beside, path);
      sync_folder(directory);
    });
  } catch (const RankError& error) {
    throw RankError(error.rank, error.is_wrong_input, tell(error));
  } catch (const std::exception& error) {
    throw std::runtime_error(tell(error));
  }
  if (!ranks.is_root()) {
    return {};
  }
  remove_older(directory, std::max(keep, 1));
  return path;
}

SavedState read_checkpoint(const std::filesystem::path& path) {
  const std::uint64_t length = checked_length(path);
  FieldReader in(path, length - sizeof(std::uint64_t));
  in.values<std::string>(mark.size());
  in.number();
  SavedState data;
  const std::uint64_t n_fields = in.number();
  for (std::uint64_t field = 0; field < n_fields; ++field) {
    const auto kind = static_cast<Kind>(in.number());
    const std::uint64_t name_length = in.number(), n_dimensions = in.number(), n_bytes = in.number();
    SavedValue value;
    value.shape = in.values<std::vector<std::int64_t>>(checked_dimensions(path, n_dimensions) * sizeof(std::int64_t));
    const auto name = in.values<std::string>(name_length);
    switch (kind) {
    case Kind::text:
      value.values = in.values<SavedValue::Text>(n_bytes);
      break;
    case Kind::real:
      value.values = in.values<SavedValue::Reals>(n_bytes);
      break;
    case Kind::integer:
      value.values = in.values<SavedValue::Integers>(n_bytes);
      break;
    default:
      refuse(path, fmt::format("the field '{}' is of a type that this version does not know", name));
    }
    if (!value.is_whole()) {
      refuse(path, fmt::format("the field '{}' does not hold as many values as it says", name));
    }
    data[name] = std::move(value);
  }
  return data;
}

LatestCheckpoint latest_checkpoint(const std::filesystem::path& directory) {
  LatestCheckpoint latest;
  for (const NumberedCheckpoint& file : checkpoints_in(directory)) {
    try {
      latest.data = read_checkpoint(file.path);
      latest.path = file.path;
      return latest;
    } catch (const InputError& error) {
      latest.refused.emplace_back(error.what());
    }
  }
  throw InputError(
      latest.refused.empty()
          ? fmt::format("{}: there is no checkpoint (checkpoint-NNNNNN.boba)", directory.string())
          : fmt::format("{}: no checkpoint can be used; {}", directory.string(), fmt::join(latest.refused, "; ")));
}

} // namespace boba

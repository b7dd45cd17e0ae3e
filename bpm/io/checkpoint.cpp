// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/checkpoint.h"

#include "bpm/io/input_error.h"
#include "bpm/io/output_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <optional>
#include <xxhash.h>

namespace boba {

// The file: mark, length of the file, number of entries; each entry: kind, length of its name, count, name, values;
// at the end the checksum of all bytes before it. Numbers are 64 bits wide, little-endian. It is written as a stream,
// so that a large packing needs no second copy in memory, and only this source reads it.

namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

constexpr std::string_view mark = "BOBACKP1";
constexpr std::string_view stem = "checkpoint-", ending = ".boba";
enum class Kind : std::uint64_t { text = 1, real = 2, integer = 3 };

/// XXH3 of what has been added so far. Source: xxhash.h, "XXH3 streaming".
class Checksum {
public:
  Checksum() : state_(XXH3_createState()) { XXH3_64bits_reset(state_.get()); }
  void add(std::string_view bytes) { XXH3_64bits_update(state_.get(), bytes.data(), bytes.size()); }
  std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_;
};

template <typename T> std::string_view bytes_of(const T* values, std::size_t n) {
  return {reinterpret_cast<const char*>(values), n * sizeof(T)};
}

/// Calls visit(kind, name, bytes) for every entry in the order of the file.
template <typename Visit> void for_each_entry(const CheckpointData& data, Visit visit) {
  for (const auto& [name, text] : data.text) {
    visit(Kind::text, name, std::string_view(text));
  }
  for (const auto& [name, values] : data.real) {
    visit(Kind::real, name, bytes_of(values.data(), values.size()));
  }
  for (const auto& [name, values] : data.integer) {
    visit(Kind::integer, name, bytes_of(values.data(), values.size()));
  }
}

void write_entries(OutputFile& out, const CheckpointData& data) {
  constexpr std::size_t portion = 1 << 18;
  Checksum checksum;
  std::string gathered; // names and lengths are a few bytes each: they go out together
  const auto put = [&](std::string_view bytes) {
    checksum.add(bytes);
    gathered += bytes;
    if (gathered.size() >= portion) {
      out.write(gathered);
      gathered.clear();
    }
  };
  const auto put_number = [&](std::uint64_t number) { put(bytes_of(&number, 1)); };
  std::uint64_t length = mark.size() + 3 * sizeof(std::uint64_t), n_entries = 0;
  for_each_entry(data, [&](Kind, const std::string& name, std::string_view bytes) {
    length += 3 * sizeof(std::uint64_t) + name.size() + bytes.size();
    ++n_entries;
  });
  put(mark);
  put_number(length);
  put_number(n_entries);
  for_each_entry(data, [&](Kind kind, const std::string& name, std::string_view bytes) {
    put_number(static_cast<std::uint64_t>(kind));
    put_number(name.size());
    put_number(bytes.size());
    put(name);
    put(bytes);
  });
  const std::uint64_t sum = checksum.value();
  gathered += bytes_of(&sum, 1);
  out.write(gathered);
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw InputError(fmt::format("{}: refused as a checkpoint: {}", path.string(), why));
}

/// Reads numbers and names from a file whose checksum is right already; the bounds are checked all the same.
class EntryReader {
public:
  EntryReader(const std::filesystem::path& path, std::uint64_t length)
      : path_(path), in_(path, std::ios::binary), left_(length) {}

  void take(char* target, std::uint64_t n) {
    if (n > left_ || !in_.read(target, static_cast<std::streamsize>(n))) {
      refuse(path_, "an entry goes beyond the end of the file");
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
      refuse(path_, "an entry goes beyond the end of the file");
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

/// Throws unless the file has the length it names and its checksum is right.
std::uint64_t checked_length(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    refuse(path, "it cannot be opened");
  }
  std::error_code error;
  const std::uint64_t length = std::filesystem::file_size(path, error);
  std::string head(mark.size() + sizeof(std::uint64_t), '\0');
  if (error || !in.read(head.data(), static_cast<std::streamsize>(head.size())) || !head.starts_with(mark)) {
    refuse(path, "it does not begin like one");
  }
  std::uint64_t named_length = 0;
  std::memcpy(&named_length, head.data() + mark.size(), sizeof named_length);
  if (named_length != length) {
    refuse(path, fmt::format("truncated or altered: {} bytes long, {} were written", length, named_length));
  }
  Checksum checksum;
  checksum.add(head);
  std::uint64_t left = length - head.size() - sizeof(std::uint64_t);
  std::string chunk(std::min<std::uint64_t>(left, 1 << 20), '\0');
  while (left > 0) {
    const std::uint64_t n = std::min<std::uint64_t>(left, chunk.size());
    if (!in.read(chunk.data(), static_cast<std::streamsize>(n))) {
      refuse(path, "it cannot be read to its end");
    }
    checksum.add({chunk.data(), n});
    left -= n;
  }
  std::uint64_t sum = 0;
  if (!in.read(reinterpret_cast<char*>(&sum), sizeof sum) || sum != checksum.value()) {
    refuse(path, "altered: its checksum does not fit its content");
  }
  return length;
}

struct NumberedFile {
  std::uint64_t number = 0;
  std::filesystem::path path;
};

std::optional<std::uint64_t> number_in(const std::string& name) {
  if (!name.starts_with(stem) || !name.ends_with(ending)) {
    return std::nullopt;
  }
  std::uint64_t number = 0;
  const char* end = name.data() + name.size() - ending.size();
  const auto [stop, error] = std::from_chars(name.data() + stem.size(), end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

/// The checkpoints of a folder, newest first.
std::vector<NumberedFile> checkpoints_in(const std::filesystem::path& directory) {
  std::vector<NumberedFile> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (const auto number = number_in(entry.path().filename().string())) {
      files.push_back({*number, entry.path()});
    }
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.number > b.number; });
  return files;
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
  for (const NumberedFile& file : checkpoints_in(directory)) {
    std::error_code ignored; // a file that cannot be removed is no reason to stop a run
    if (n_whole >= keep) {
      std::filesystem::remove(file.path, ignored);
    } else if (is_whole(file.path)) {
      ++n_whole;
    }
  }
}

} // namespace

std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const CheckpointData& data, int keep) {
  const std::vector<NumberedFile> before = checkpoints_in(directory);
  const std::uint64_t number = before.empty() ? 1 : before.front().number + 1;
  std::filesystem::path path = directory / fmt::format("{}{:06}{}", stem, number, ending);
  const std::filesystem::path beside = path.string() + ".part";
  try {
    std::filesystem::create_directories(directory);
    OutputFile out(beside, FileMode::overwrite);
    write_entries(out, data);
    out.sync();
    out.close();
    std::filesystem::rename(beside, path);
    sync_folder(directory);
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw std::runtime_error(
        fmt::format("checkpoint not written: {}{}", error.what(),
                    before.empty() ? "" : fmt::format("; the last one remains: {}", before.front().path.string())));
  }
  remove_older(directory, std::max(keep, 1));
  return path;
}

CheckpointData read_checkpoint(const std::filesystem::path& path) {
  const std::uint64_t length = checked_length(path);
  EntryReader in(path, length - sizeof(std::uint64_t));
  in.values<std::string>(mark.size());
  in.number();
  CheckpointData data;
  const std::uint64_t n_entries = in.number();
  for (std::uint64_t entry = 0; entry < n_entries; ++entry) {
    const auto kind = static_cast<Kind>(in.number());
    const std::uint64_t name_length = in.number(), n_bytes = in.number();
    const auto name = in.values<std::string>(name_length);
    switch (kind) {
    case Kind::text:
      data.text[name] = in.values<std::string>(n_bytes);
      break;
    case Kind::real:
      data.real[name] = in.values<std::vector<double>>(n_bytes);
      break;
    case Kind::integer:
      data.integer[name] = in.values<std::vector<std::int64_t>>(n_bytes);
      break;
    default:
      refuse(path, fmt::format("entry '{}' is of a kind that this version does not know", name));
    }
  }
  return data;
}

LatestCheckpoint latest_checkpoint(const std::filesystem::path& directory) {
  LatestCheckpoint latest;
  for (const NumberedFile& file : checkpoints_in(directory)) {
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
          ? fmt::format("{}: there is no checkpoint ({}NNNNNN{})", directory.string(), stem, ending)
          : fmt::format("{}: no checkpoint can be used; {}", directory.string(), fmt::join(latest.refused, "; ")));
}

} // namespace boba

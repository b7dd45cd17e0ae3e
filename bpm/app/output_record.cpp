// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/output_record.h"

#include "bpm/app/run_files.h"
#include "bpm/io/input_error.h"
#include "bpm/io/output_file.h"
#include "bpm/io/trajectory.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <zlib.h>

namespace boba {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t to_the_end = ~std::uint64_t{0};

/// Continues a sum over the bytes of a file, from the sum's length to `length` or the file's end. False without a file.
template <class Sum> bool sum_file(const fs::path& path, std::uint64_t length, Sum& sum) {
  std::ifstream in(path, std::ios::binary);
  if (!in || !in.seekg(static_cast<std::streamoff>(sum.length))) {
    return false;
  }
  std::vector<char> bytes(1 << 16);
  while (sum.length < length) {
    in.read(bytes.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(bytes.size(), length - sum.length)));
    const auto n = in.gcount();
    if (n <= 0) {
      break;
    }
    sum.crc =
        static_cast<std::uint32_t>(crc32(sum.crc, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(n)));
    sum.length += static_cast<std::uint64_t>(n);
  }
  return !in.bad();
}

std::string missing_frames(const fs::path& path, std::int64_t n_frames, std::int64_t step) {
  if (n_frames == 0) {
    return "";
  }
  std::error_code error;
  if (!fs::exists(path, error)) {
    return fmt::format("{} is missing", path.string());
  }
  try {
    const TrajectoryReader reader(path);
    const auto found = std::count_if(reader.steps().begin(), reader.steps().end(),
                                     [step](std::int64_t stored) { return stored <= step; });
    return found == n_frames
               ? ""
               : fmt::format("{} holds {} of {} frames up to step {}", path.string(), found, n_frames, step);
  } catch (const InputError& unreadable) {
    return fmt::format("{} cannot be read any more ({})", path.string(), unreadable.what());
  }
}

std::string missing_bytes(const fs::path& path, std::uint64_t length, std::uint32_t crc) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    return fmt::format("{} is missing", path.string());
  }
  struct {
    std::uint64_t length = 0;
    std::uint32_t crc = 0;
  } sum;
  if (!sum_file(path, length, sum)) {
    return fmt::format("{} cannot be read", path.string());
  }
  if (sum.length < length) {
    return fmt::format("{} is cut short: {} of {} bytes", path.string(), sum.length, length);
  }
  const bool is_scene = path.filename() == "scene.toml";
  return sum.crc == crc ? ""
         : is_scene     ? fmt::format("{} was edited; a run continues with the scene that it began with", path.string())
                        : fmt::format("{} was edited within its first {} bytes", path.string(), length);
}

/// packing.pvd is written again with every frame: it must still name those that the checkpoint knows of.
std::string missing_from_list(const fs::path& list, const std::vector<std::string>& frames) {
  std::ifstream in(list, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto n_missing = std::count_if(frames.begin(), frames.end(), [&](const std::string& frame) {
    return text.find("file=\"" + frame + "\"") == std::string::npos;
  });
  if (n_missing == 0) {
    return "";
  }
  return !in ? fmt::format("{} is missing", list.string())
             : fmt::format("{} lacks {} of {} frames", list.string(), n_missing, frames.size());
}

} // namespace

OutputRecord::OutputRecord(OutputFolder folder, const std::vector<std::string>& names) : folder_(std::move(folder)) {
  for (const std::string& name : names) {
    has_trajectory_ = has_trajectory_ || name == "trajectory.h5";
    has_vtk_ = has_vtk_ || name == "vtk/packing.pvd";
    has_stage_tables_ = has_stage_tables_ || name == stage_tables_name;
    if (name == stage_tables_name) {
      continue; // each is written once, when its stage has ended
    }
    if (name == "scene.toml" || name == "dump.lammpstrj" || name.ends_with(".csv")) {
      growing_.push_back(name);
    }
  }
}

void OutputRecord::extend(const std::string& name) {
  if (!sum_file(folder_.root() / name, to_the_end, sums_[name])) {
    throw std::runtime_error(fmt::format("{}: cannot be read", (folder_.root() / name).string()));
  }
}

void OutputRecord::add_numbered(const std::string& folder, std::string_view begin, std::string_view end,
                                std::int64_t last) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_.root() / folder, error)) {
    const std::string file = entry.path().filename().string();
    std::int64_t number = 0;
    if (!file.starts_with(begin) || !file.ends_with(end)) {
      continue;
    }
    const auto [stop, bad] = std::from_chars(file.data() + begin.size(), file.data() + file.size(), number);
    const bool is_numbered = bad == std::errc() && stop == file.data() + file.size() - end.size();
    const std::string name = (fs::path(folder) / file).string();
    if (is_numbered && number <= last && !sums_.contains(name)) {
      extend(name);
    }
  }
}

std::string OutputRecord::text(std::int64_t step, std::int64_t n_frames, std::int64_t last_frame) {
  for (const std::string& name : growing_) {
    extend(name);
  }
  if (has_vtk_) {
    add_numbered("vtk", "packing_", ".vtp", step);
  }
  if (has_stage_tables_) {
    add_numbered("stages", "stage-", ".csv", std::numeric_limits<std::int64_t>::max());
  }
  std::string text;
  for (const auto& [name, sum] : sums_) {
    text += fmt::format("{} {} {}\n", sum.length, sum.crc, name);
  }
  return has_trajectory_ ? fmt::format("{}frames {} up to {} trajectory.h5\n", text, n_frames, last_frame) : text;
}

std::vector<std::string> missing_output(const OutputFolder& folder, const std::string& record) {
  std::vector<std::string> gaps, vtk_frames;
  const auto add = [&gaps](const std::string& gap) {
    if (!gap.empty()) {
      gaps.push_back(gap);
    }
  };
  std::istringstream lines(record);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::string word, name;
    std::int64_t n = 0, step = 0;
    if (line.starts_with("frames ")) {
      in >> word >> n >> word >> word >> step;
      add(missing_frames(folder.trajectory(), n, step));
      continue;
    }
    std::uint64_t length = 0;
    std::uint32_t crc = 0;
    in >> length >> crc >> name;
    add(missing_bytes(folder.root() / name, length, crc));
    if (name.starts_with("vtk/")) {
      vtk_frames.push_back(name.substr(4));
    }
  }
  add(missing_from_list(folder.vtk() / "packing.pvd", vtk_frames));
  return gaps;
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/vtk.h"

#include "bpm/io/line_reader.h"

#include <bit>
#include <charconv>
#include <fmt/format.h>
#include <regex>

namespace boba {

namespace {

static_assert(std::endian::native == std::endian::little, "the header says LittleEndian");

/// Arrays of a .vtp: the XML head names their places, the bytes follow behind it.
class AppendedArrays {
public:
  template <typename T> std::string add(const char* type, const char* name, int components, std::vector<T> values) {
    std::string element =
        fmt::format("        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
                    "offset=\"{}\"/>\n",
                    type, name, components, bytes_.size());
    const std::uint64_t size = values.size() * sizeof(T);
    bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes_.append(reinterpret_cast<const char*>(values.data()), size);
    return element;
  }
  std::string add_vectors(const char* name, const std::vector<Vector3>& vectors) {
    std::vector<double> numbers;
    numbers.reserve(3 * vectors.size());
    for (const Vector3& v : vectors) {
      numbers.insert(numbers.end(), v.begin(), v.end());
    }
    return add("Float64", name, 3, std::move(numbers));
  }
  const std::string& bytes() const { return bytes_; }

private:
  std::string bytes_;
};

std::vector<Vector3> whole_grains_in_cell(const Topology& topology, const Snapshot& snapshot) {
  std::vector<Vector3> x = snapshot.position;
  for (int grain = 0; grain < topology.n_grains(); ++grain) {
    const std::int64_t first = topology.first_node[grain], last = topology.first_node[grain + 1];
    Vector3 centre = Vector3::Zero();
    for (std::int64_t node = first; node < last; ++node) {
      centre += x[node] / static_cast<double>(last - first);
    }
    const Vector3 shift = snapshot.box.wrapped(centre) - centre;
    for (std::int64_t node = first; node < last; ++node) {
      x[node] += shift;
    }
  }
  return x;
}

std::string node_data(const Topology& topology, const Snapshot& snapshot, AppendedArrays& arrays) {
  std::vector<std::int64_t> grain;
  std::vector<std::int32_t> species;
  for (const int g : topology.grain_of_node()) {
    grain.push_back(topology.molecule[g]);
    species.push_back(topology.species[g]);
  }
  std::string xml = arrays.add("Int64", "grain", 1, std::move(grain));
  xml += arrays.add("Int32", "species", 1, std::move(species));
  xml += arrays.add("Int64", "id", 1, topology.id);
  if (!snapshot.velocity.empty()) {
    xml += arrays.add_vectors("velocity", snapshot.velocity);
  }
  if (!snapshot.force.empty()) {
    xml += arrays.add_vectors("force", snapshot.force);
  }
  return xml;
}

std::string vertices(std::int64_t n, AppendedArrays& arrays) {
  std::vector<std::int64_t> connectivity(n), offsets(n);
  for (std::int64_t i = 0; i < n; ++i) {
    connectivity[i] = i;
    offsets[i] = i + 1;
  }
  return arrays.add("Int64", "connectivity", 1, std::move(connectivity)) +
         arrays.add("Int64", "offsets", 1, std::move(offsets));
}

std::string frame_name(const std::filesystem::path& pvd, std::int64_t step) {
  return fmt::format("{}_{}.vtp", pvd.stem().string(), step);
}

/// True when the whole text is one number, which it then puts into `value`.
template <typename T> bool is_number(const std::string& text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

} // namespace

void write_vtp(const std::filesystem::path& path, const Topology& topology, const Snapshot& snapshot, FileMode mode) {
  OutputFile out(path, mode);
  AppendedArrays arrays;
  const std::string data = node_data(topology, snapshot, arrays);
  const std::string points = arrays.add_vectors("Points", whole_grains_in_cell(topology, snapshot));
  const std::string verts = vertices(topology.n_nodes(), arrays);
  const std::string field = arrays.add("Float64", "TimeValue", 1, std::vector<double>{snapshot.time});
  out.print("<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
            "  <PolyData>\n    <FieldData>\n{}    </FieldData>\n"
            "    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\">\n",
            fmt::format("        <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" {}",
                        field.substr(field.find("format="))),
            topology.n_nodes(), topology.n_nodes());
  out.print("      <PointData Scalars=\"grain\">\n{}      </PointData>\n      <Points>\n{}      </Points>\n"
            "      <Verts>\n{}      </Verts>\n    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_",
            data, points, verts);
  out.write(arrays.bytes());
  out.print("\n  </AppendedData>\n</VTKFile>\n");
  out.close();
}

VtkSeries::VtkSeries(const std::filesystem::path& pvd, FileMode mode) : pvd_(pvd) {
  check_file_mode(pvd, mode);
}

VtkSeries VtkSeries::go_on(const std::filesystem::path& pvd, std::int64_t last_step) {
  VtkSeries series(pvd, FileMode::append);
  if (!std::filesystem::exists(pvd)) {
    return series;
  }
  const std::regex frame_line("\\s*<DataSet timestep=\"([^\"]*)\" name=\"([^\"]*)\" file=\"([^\"]*)\"/>\\s*");
  LineReader lines(pvd);
  while (lines.next()) {
    const std::string line(lines.line());
    if (line.find("<DataSet") == std::string::npos) {
      continue;
    }
    Frame frame;
    std::smatch part;
    if (!std::regex_match(line, part, frame_line) || !is_number(part[1], frame.time) ||
        !is_number(part[2], frame.step) || part[3] != frame_name(pvd, frame.step)) {
      lines.fail("not a line of a list of frames written by Boba");
    }
    frame.file = part[3];
    if (frame.step <= last_step) {
      series.frames_.push_back(frame);
    } else {
      std::filesystem::remove(pvd.parent_path() / frame.file);
    }
  }
  series.write_list();
  return series;
}

void VtkSeries::write(const Topology& topology, const Snapshot& snapshot) {
  if (!frames_.empty() && frames_.back().step == snapshot.step) {
    return;
  }
  const std::string file = frame_name(pvd_, snapshot.step);
  write_vtp(pvd_.parent_path() / file, topology, snapshot, FileMode::overwrite);
  frames_.push_back({snapshot.step, snapshot.time, file});
  write_list();
}

void VtkSeries::write_list() const {
  const std::filesystem::path beside = pvd_.string() + ".part";
  OutputFile out(beside, FileMode::overwrite);
  out.print("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
            "  <Collection>\n");
  for (const Frame& frame : frames_) {
    out.print("    <DataSet timestep=\"{}\" name=\"{}\" file=\"{}\"/>\n", frame.time, frame.step, frame.file);
  }
  out.print("  </Collection>\n</VTKFile>\n");
  out.close();
  std::filesystem::rename(beside, pvd_);
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/lammps_data.h"

#include "bpm/grain/sound_template.h"
#include "bpm/io/id_table.h"
#include "bpm/io/line_reader.h"
#include "bpm/io/usable_cell.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numbers>
#include <optional>
#include <string>

namespace boba {

namespace {

/// Columns of a row of `Atoms`; -1 where the style has none. A density follows the diameter.
struct AtomStyle {
  std::string_view name;
  int molecule;
  int type;
  int diameter;
  int x;
};

constexpr std::array<AtomStyle, 8> atom_styles = {{{"bond", 1, 2, -1, 3},
                                                   {"angle", 1, 2, -1, 3},
                                                   {"molecular", 1, 2, -1, 3},
                                                   {"full", 1, 2, -1, 4},
                                                   {"atomic", -1, 1, -1, 2},
                                                   {"charge", -1, 1, -1, 3},
                                                   {"sphere", -1, 1, 2, 4},
                                                   {"bpm/sphere", 1, 2, 3, 5}}};

bool is_whole(std::string_view field) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end == field.data() + field.size();
}

const AtomStyle& style_named(std::string_view name) {
  return *std::find_if(atom_styles.begin(), atom_styles.end(), [&](const AtomStyle& s) { return s.name == name; });
}

/// Begins with a letter and is not one of the spellings of "not a number" and "infinity".
bool is_word(std::string_view field) {
  std::string small;
  std::transform(field.begin(), field.end(), std::back_inserter(small),
                 [](unsigned char c) { return std::tolower(c); });
  return std::isalpha(static_cast<unsigned char>(field[0])) != 0 && small != "nan" && small != "inf" &&
         small != "infinity";
}

struct Header {
  std::optional<std::int64_t> n_atoms;
  std::int64_t n_bonds = 0;
  std::optional<std::int64_t> n_atom_types, n_bond_types;
  std::array<std::optional<std::array<double, 2>>, 3> limits;
  Vector3 tilts = Vector3::Zero();
};

/// Reads one file; the members are the parts of the file in the order in which they are met.
class DataReader {
public:
  explicit DataReader(const std::filesystem::path& path) : in_(path) {}
  LammpsData read();

private:
  bool next_line();
  bool on_section_name() const;
  void read_header();
  void read_header_line();
  void read_limits(int axis);
  Box make_box() const;
  void read_section();
  template <typename ReadRow> void read_rows(std::int64_t n_rows, std::string_view section, ReadRow read_row);
  void read_atoms();
  AtomStyle choose_style(std::string_view comment) const;
  AtomStyle style_by_columns() const;
  void read_atom(const AtomStyle& style);
  void check_sphere(const AtomStyle& style) const;
  void read_velocities();
  void read_bonds();
  void read_masses();
  void read_labels(std::map<std::string, int, std::less<>>& labels, std::optional<std::int64_t> n, const char* kind);
  int type_at(std::size_t column, std::string_view name, const std::map<std::string, int, std::less<>>& labels,
              std::optional<std::int64_t> n_types) const;
  void need_columns(std::size_t n, std::string_view what) const;
  void finish();

  LineReader in_;
  LammpsData data_;
  Header header_;
  std::map<std::string, int, std::less<>> atom_labels_, bond_labels_;
  std::vector<std::pair<std::int64_t, Vector3>> velocities_; ///< by id: the section may stand before Atoms
  bool has_line_ = false;                                    ///< the current line is still to be used
  bool after_blank_ = true;                                  ///< a section's name follows an empty line
  bool has_atoms_ = false;
  std::size_t n_columns_ = 0; ///< of the rows of Atoms
};

bool DataReader::next_line() {
  after_blank_ = false;
  while (in_.next()) {
    if (!in_.fields().empty()) {
      has_line_ = true;
      return true;
    }
    after_blank_ = true;
  }
  has_line_ = false;
  return false;
}

bool DataReader::on_section_name() const {
  return is_word(in_.fields()[0]);
}

LammpsData DataReader::read() {
  if (!in_.next()) {
    in_.fail_file("is empty; a LAMMPS data file is needed");
  }
  // The first line is a title. LAMMPS itself writes the time step into it.
  if (const std::size_t at = in_.line().find("timestep = "); at != std::string_view::npos) {
    const std::string_view number = in_.line().substr(at + 11);
    std::from_chars(number.data(), number.data() + number.size(), data_.timestep);
  }
  read_header();
  while (has_line_) {
    read_section();
  }
  finish();
  return std::move(data_);
}

void DataReader::read_header() {
  while (next_line() && !on_section_name()) {
    read_header_line();
  }
  if (!header_.n_atoms) {
    in_.fail_file("has no line 'N atoms' in its header (the first line of a data file is a title and is not read)");
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!header_.limits[axis]) {
      in_.fail_file(fmt::format("has no line 'LOW HIGH {0}lo {0}hi' in its header", "xyz"[axis]));
    }
  }
  data_.box = make_box();
}

void DataReader::read_header_line() {
  const auto& fields = in_.fields();
  const auto first_word = std::find_if(fields.begin(), fields.end(), is_word);
  const auto n_numbers = static_cast<std::size_t>(first_word - fields.begin());
  const std::string keyword = fmt::format("{}", fmt::join(first_word, fields.end(), " "));
  const auto need = [&](std::size_t n) {
    if (n_numbers != n) {
      in_.fail(fmt::format("'{}' has {} numbers before it; {} needed", keyword, n_numbers, n));
    }
  };
  if (keyword == "atoms") {
    need(1);
    header_.n_atoms = in_.count("number of atoms", sizeof(Vector3) + 2 * sizeof(std::int64_t) + sizeof(int));
  } else if (keyword == "bonds") {
    need(1);
    header_.n_bonds = in_.count("number of bonds", sizeof(LammpsData::Bond));
  } else if (keyword == "atom types") {
    need(1);
    header_.n_atom_types = in_.count("number of atom types", sizeof(double));
  } else if (keyword == "bond types") {
    need(1);
    header_.n_bond_types = in_.count("number of bond types", sizeof(double));
  } else if (keyword == "xlo xhi" || keyword == "ylo yhi" || keyword == "zlo zhi") {
    need(2);
    read_limits(keyword[0] - 'x');
  } else if (keyword == "xy xz yz") {
    need(3);
    header_.tilts = Vector3(in_.real(0, "xy"), in_.real(1, "xz"), in_.real(2, "yz"));
  } else if (keyword == "avec" || keyword == "bvec" || keyword == "cvec" || keyword == "abc origin") {
    in_.fail(fmt::format("'{}': a general triclinic cell; only cells with xlo xhi ... xy xz yz are read", keyword));
  }
  // Other counts (angles, dihedrals, extra ... per atom) belong to sections that are skipped.
}

void DataReader::read_limits(int axis) {
  const std::array<double, 2> limits = {in_.real(0, "lower limit"), in_.real(1, "upper limit")};
  if (!(limits[0] < limits[1])) {
    in_.fail(fmt::format("limits are {} and {}; the first must be below the second", limits[0], limits[1]));
  }
  header_.limits[axis] = limits;
}

Box DataReader::make_box() const {
  Vector3 origin, lengths;
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] = (*header_.limits[axis])[0];
    lengths[axis] = (*header_.limits[axis])[1] - (*header_.limits[axis])[0];
  }
  if (!is_usable_cell(lengths, header_.tilts) || !is_usable_position(origin) || !is_usable_position(lengths)) {
    in_.fail_file(fmt::format("a cell of lengths {} {} {} and tilts {} {} {} cannot be computed with", lengths[0],
                              lengths[1], lengths[2], header_.tilts[0], header_.tilts[1], header_.tilts[2]));
  }
  return Box(origin, lengths, header_.tilts);
}

void DataReader::read_section() {
  const std::string name = fmt::format("{}", fmt::join(in_.fields(), " "));
  if (name == "Atoms") {
    read_atoms();
  } else if (name == "Velocities") {
    read_velocities();
  } else if (name == "Bonds") {
    read_bonds();
  } else if (name == "Masses") {
    read_masses();
  } else if (name == "Atom Type Labels") {
    read_labels(atom_labels_, header_.n_atom_types, "atom");
  } else if (name == "Bond Type Labels") {
    read_labels(bond_labels_, header_.n_bond_types, "bond");
  } else {
    // Rows of a section that is not needed may begin with a letter; a name stands behind an empty line.
    while (next_line() && !(after_blank_ && on_section_name())) {
    }
    return;
  }
  if (next_line() && !on_section_name()) {
    in_.fail(fmt::format("a row more than the header gives for section '{}'", name));
  }
}

template <typename ReadRow>
void DataReader::read_rows(std::int64_t n_rows, std::string_view section, ReadRow read_row) {
  for (std::int64_t row = 0; row < n_rows; ++row) {
    if (!next_line()) {
      in_.fail(fmt::format("the file ends in section '{}' after {} of {} rows", section, row, n_rows));
    }
    if (on_section_name()) {
      in_.fail(fmt::format("section '{}' ends after {} of the {} rows that the header gives", section, row, n_rows));
    }
    read_row();
  }
}

void DataReader::need_columns(std::size_t n, std::string_view what) const {
  if (in_.fields().size() < n) {
    in_.fail(fmt::format("{} columns; {} has {}", in_.fields().size(), what, n));
  }
}

void DataReader::read_atoms() {
  if (has_atoms_) {
    in_.fail("a second section 'Atoms'");
  }
  has_atoms_ = true;
  const std::string line(in_.line());
  const std::size_t hash = line.find('#');
  const std::string comment = hash == std::string::npos ? "" : line.substr(hash + 1);
  std::optional<AtomStyle> style;
  // Grown as rows arrive, so that a wrong count costs no memory.
  read_rows(*header_.n_atoms, "Atoms", [&] {
    if (!style) {
      style = choose_style(comment);
      n_columns_ = in_.fields().size();
      data_.has_images = static_cast<int>(n_columns_) >= style->x + 6;
    }
    read_atom(*style);
  });
}

AtomStyle DataReader::choose_style(std::string_view comment) const {
  const std::size_t begin = comment.find_first_not_of(" \t");
  if (begin == std::string_view::npos) {
    return style_by_columns();
  }
  const std::string_view name = comment.substr(begin, comment.find_first_of(" \t", begin) - begin);
  std::string allowed;
  for (const AtomStyle& style : atom_styles) {
    if (style.name == name) {
      const auto n = static_cast<int>(in_.fields().size());
      if (n != style.x + 3 && n != style.x + 6) {
        in_.fail(fmt::format("{} columns; atom style '{}' has {}, or {} with image flags", n, name, style.x + 3,
                             style.x + 6));
      }
      return style;
    }
    allowed += fmt::format("{}{}", allowed.empty() ? "" : ", ", style.name);
  }
  in_.fail(fmt::format("section 'Atoms # {}': atom style not known; known are {}", name, allowed));
}

AtomStyle DataReader::style_by_columns() const {
  const std::vector<std::string_view>& fields = in_.fields();
  switch (fields.size()) {
  case 5:
    return style_named("atomic");
  case 8:
    if (is_whole(fields[2])) {
      in_.fail(
          "8 columns can be atom style 'bpm/sphere' or 'atomic' with image flags; name the style behind 'Atoms #'");
    }
    return style_named("atomic");
  case 6:
  case 9:
    return style_named("bond");
  case 7:
  case 10:
    return style_named("full");
  default:
    in_.fail(fmt::format("{} columns in section 'Atoms'; 5 or 8 (atomic), 6 or 9 (bond), 7 or 10 (full) are known "
                         "without the style's name behind 'Atoms #'",
                         in_.fields().size()));
  }
}

int DataReader::type_at(std::size_t column, std::string_view name,
                        const std::map<std::string, int, std::less<>>& labels,
                        std::optional<std::int64_t> n_types) const {
  if (const auto label = labels.find(in_.fields()[column]); label != labels.end()) {
    return label->second;
  }
  const std::int64_t type = in_.integer(column, name, 1);
  const std::int64_t most = n_types.value_or(INT32_MAX);
  if (type > most) {
    in_.fail(fmt::format("{} is {}; the header gives {} types", name, type, most));
  }
  return static_cast<int>(type);
}

void DataReader::read_atom(const AtomStyle& style) {
  if (in_.fields().size() != n_columns_) {
    in_.fail(fmt::format("{} columns; the rows before have {}", in_.fields().size(), n_columns_));
  }
  data_.id.push_back(in_.integer(0, "atom id", 1));
  data_.molecule.push_back(style.molecule < 0 ? 0 : in_.integer(style.molecule, "molecule", 0));
  data_.type.push_back(type_at(style.type, "atom type", atom_labels_, header_.n_atom_types));
  if (style.diameter >= 0) {
    check_sphere(style);
  }
  Vector3 x(in_.real(style.x, "x"), in_.real(style.x + 1, "y"), in_.real(style.x + 2, "z"));
  if (data_.has_images) {
    Vector3 images;
    for (int axis = 0; axis < 3; ++axis) {
      images[axis] = static_cast<double>(in_.integer(style.x + 3 + axis, "image flag"));
    }
    x += data_.box.h() * images;
  }
  if (!is_usable_position(x)) {
    in_.fail(fmt::format("the position is {:g} {:g} {:g}; allowed: {:g} to {:g}", x[0], x[1], x[2], -largest_coordinate,
                         largest_coordinate));
  }
  data_.position.push_back(x);
}

/// Every node has the diameter 1 and the mass 1; other values would be ignored in silence.
void DataReader::check_sphere(const AtomStyle& style) const {
  const double diameter = in_.real(style.diameter, "diameter"), density = in_.real(style.diameter + 1, "density");
  if (diameter != 1.0) {
    in_.fail(fmt::format("diameter is {}; every node's diameter must be 1", diameter));
  }
  const double mass = density * std::numbers::pi / 6.0;
  if (!(std::abs(mass - 1.0) <= 1e-2)) {
    in_.fail(fmt::format("density is {}, which makes the node's mass {:.4g}; it must be 1 (density 6 / pi = 1.9099)",
                         density, mass));
  }
}

void DataReader::read_velocities() {
  if (!velocities_.empty()) {
    in_.fail("a second section 'Velocities'");
  }
  read_rows(*header_.n_atoms, "Velocities", [&] {
    need_columns(4, "a row of 'Velocities' (id vx vy vz)");
    if (in_.fields().size() != 4 && in_.fields().size() != 7) {
      in_.fail(fmt::format("{} columns; a row of 'Velocities' has 4 (id vx vy vz), or 7 with angular velocities",
                           in_.fields().size()));
    }
    velocities_.emplace_back(in_.integer(0, "atom id", 1),
                             Vector3(in_.real(1, "vx"), in_.real(2, "vy"), in_.real(3, "vz")));
  });
}

void DataReader::read_bonds() {
  if (!data_.bonds.empty()) {
    in_.fail("a second section 'Bonds'");
  }
  read_rows(header_.n_bonds, "Bonds", [&] {
    need_columns(4, "a row of 'Bonds' (number type i j)");
    if (in_.fields().size() > 4) {
      in_.fail(fmt::format("{} columns; a row of 'Bonds' (number type i j) has 4", in_.fields().size()));
    }
    in_.integer(0, "bond number");
    LammpsData::Bond bond;
    bond.type = type_at(1, "bond type", bond_labels_, header_.n_bond_types);
    bond.i = in_.integer(2, "atom id", 1);
    bond.j = in_.integer(3, "atom id", 1);
    if (bond.i == bond.j) {
      in_.fail(fmt::format("a bond from atom {} to itself", bond.i));
    }
    data_.bonds.push_back(bond);
  });
}

void DataReader::read_masses() {
  std::map<int, double> masses;
  if (!header_.n_atom_types) {
    in_.fail("section 'Masses', but no line 'N atom types' in the header");
  }
  read_rows(*header_.n_atom_types, "Masses", [&] {
    need_columns(2, "a row of 'Masses' (type mass)");
    const double mass = in_.real(1, "mass");
    if (!(mass > 0.0)) {
      in_.fail(fmt::format("mass is {}; it must be positive", mass));
    }
    masses[type_at(0, "atom type", atom_labels_, header_.n_atom_types)] = mass;
  });
  if (static_cast<std::int64_t>(masses.size()) != *header_.n_atom_types) {
    in_.fail("section 'Masses' gives one type twice");
  }
  for (const auto& [type, mass] : masses) {
    data_.mass.push_back(mass);
  }
}

void DataReader::read_labels(std::map<std::string, int, std::less<>>& labels, std::optional<std::int64_t> n,
                             const char* kind) {
  read_rows(n.value_or(0), fmt::format("{} type labels", kind), [&] {
    need_columns(2, "a row of type labels (type label)");
    labels[std::string(in_.fields()[1])] = static_cast<int>(in_.integer(0, fmt::format("{} type", kind), 1));
  });
}

void DataReader::finish() {
  if (!has_atoms_) {
    in_.fail_file("has no section 'Atoms'");
  }
  const IdTable rows(data_.id);
  if (rows.duplicate() != IdTable::none) {
    in_.fail_file(fmt::format("atom id {} stands twice in section 'Atoms'", data_.id[rows.duplicate()]));
  }
  if (static_cast<std::int64_t>(data_.bonds.size()) != header_.n_bonds) {
    in_.fail_file(fmt::format("the header gives {} bonds, but there is no section 'Bonds'", header_.n_bonds));
  }
  for (const LammpsData::Bond& bond : data_.bonds) {
    for (const std::int64_t id : {bond.i, bond.j}) {
      if (rows.row(id) == IdTable::none) {
        in_.fail_file(fmt::format("bond {} - {}: there is no atom {} in section 'Atoms'", bond.i, bond.j, id));
      }
    }
  }
  if (velocities_.empty()) {
    return;
  }
  data_.velocity.resize(data_.id.size());
  std::vector<bool> given(data_.id.size(), false);
  for (const auto& [id, velocity] : velocities_) {
    const std::int64_t row = rows.row(id);
    if (row == IdTable::none || given[row]) {
      in_.fail_file(fmt::format("section 'Velocities': atom {} {}", id,
                                row == IdTable::none ? "is not in section 'Atoms'" : "stands twice"));
    }
    given[row] = true;
    data_.velocity[row] = velocity;
  }
}

} // namespace

std::vector<std::array<std::int64_t, 2>> LammpsData::bond_rows() const {
  const IdTable rows(id);
  std::vector<std::array<std::int64_t, 2>> pairs;
  pairs.reserve(bonds.size());
  for (const Bond& bond : bonds) {
    pairs.push_back({rows.row(bond.i), rows.row(bond.j)});
  }
  return pairs;
}

LammpsData read_lammps_data(const std::filesystem::path& path) {
  return DataReader(path).read();
}

} // namespace boba

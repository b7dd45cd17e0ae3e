// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/lammps_fixture.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace boba::test {

std::filesystem::path test_data(const std::string& name) {
  return std::filesystem::path(BOBA_TEST_DATA) / name;
}

std::filesystem::path force_data(const std::string& name) {
  return test_data("forces/" + name);
}

LammpsPacking fixture_packing(const std::string& name, const std::string& state, double alpha) {
  LammpsPacking read = read_lammps_packing({force_data(name + ".ref.data.gz"), force_data(state), std::nullopt});
  for (Grain& grain : read.packing.grains) {
    grain.alpha = alpha;
  }
  return read;
}

std::array<double, 6> lammps_pressure(const std::string& file, const std::string& step) {
  std::ifstream in(force_data(file));
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word != step) {
      continue;
    }
    while (words >> word && word != "=") {
    }
    std::array<double, 6> pressure{};
    for (double& p : pressure) {
      words >> p;
    }
    if (words) {
      return pressure;
    }
  }
  throw std::runtime_error(file + ": no line for " + step);
}

double largest_difference(const LammpsPacking& packing, const std::vector<Vector3>& ours, const LammpsFrame& frame,
                          const std::vector<Vector3>& theirs) {
  const std::vector<std::int64_t> rows = rows_of_ids(frame, packing.packing.id, "frame");
  double largest = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    largest = std::max(largest, (ours[i] - theirs[rows[i]]).cwiseAbs().maxCoeff());
  }
  return largest;
}

double largest_position_difference(const LammpsPacking& packing, const std::vector<Vector3>& ours,
                                   const LammpsFrame& frame, const Box& box) {
  const std::vector<std::int64_t> rows = rows_of_ids(frame, packing.packing.id, "frame");
  double largest = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    largest = std::max(largest, box.minimum_image(ours[i] - frame.position[rows[i]]).cwiseAbs().maxCoeff());
  }
  return largest;
}

double largest_norm(const std::vector<Vector3>& vectors) {
  double largest = 0.0;
  for (const Vector3& v : vectors) {
    largest = std::max(largest, v.norm());
  }
  return largest;
}

} // namespace boba::test

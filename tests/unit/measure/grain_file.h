// SPDX-License-Identifier: GPL-3.0-or-later
// Reads tests/data/measure/*.csv: "grain,x_d,y_d,z_d".
#pragma once

#include "bpm/packing/box.h"

#include <cstdint>
#include <fstream>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace boba::test_data {

struct Grains {
  std::vector<Vector3> position;
  std::vector<std::int64_t> first_node;

  std::span<const Vector3> nodes_of(int g) const {
    return std::span(position).subspan(first_node[g], first_node[g + 1] - first_node[g]);
  }
  int n_grains() const { return static_cast<int>(first_node.size()) - 1; }
};

inline Grains read_grains(const std::string& name) {
  std::ifstream file(std::string(BOBA_TEST_DATA) + "/measure/" + name);
  if (!file) {
    throw std::runtime_error("cannot read " + name);
  }
  Grains grains;
  std::string line;
  std::getline(file, line);
  int last = -1;
  while (std::getline(file, line)) {
    std::istringstream in(line);
    int grain = 0;
    char comma = 0;
    Vector3 x;
    in >> grain >> comma >> x[0] >> comma >> x[1] >> comma >> x[2];
    if (grain != last) {
      grains.first_node.push_back(static_cast<std::int64_t>(grains.position.size()));
      last = grain;
    }
    grains.position.push_back(x);
  }
  grains.first_node.push_back(static_cast<std::int64_t>(grains.position.size()));
  return grains;
}

} // namespace boba::test_data

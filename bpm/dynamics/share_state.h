// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/parallel/ranks.h"

#include <map>
#include <set>
#include <sstream>
#include <string>

namespace boba {

/// Entries of a SavedState that hold three numbers a node; all others are small.
inline const std::set<std::string> entries_of_nodes = {"position", "velocity", "force"};

/// Gives all ranks rank 0's entries, but for those of nodes. Collective.
template <class Values> void share_but_nodes(std::map<std::string, Values>& entries, const Ranks& ranks) {
  std::string names;
  for (const auto& [name, values] : entries) {
    names += entries_of_nodes.contains(name) ? "" : name + "\n";
  }
  ranks.broadcast(names);
  std::istringstream lines(names);
  for (std::string name; std::getline(lines, name);) {
    ranks.broadcast(entries[name]);
  }
}

} // namespace boba

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/node_order.h"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/cuthill_mckee_ordering.hpp>

namespace boba {

std::vector<int> local_node_order(int n_nodes, const std::vector<Bond>& bonds) {
  using Properties =
      boost::property<boost::vertex_color_t, boost::default_color_type, boost::property<boost::vertex_degree_t, int>>;
  using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, Properties>;
  if (n_nodes == 0) {
    return {};
  }
  Graph graph(n_nodes);
  for (const Bond& bond : bonds) {
    boost::add_edge(bond.i, bond.j, graph);
  }
  std::vector<Graph::vertex_descriptor> order(n_nodes);
  boost::cuthill_mckee_ordering(graph, order.rbegin(), boost::get(boost::vertex_color, graph),
                                boost::make_degree_map(graph));
  return {order.begin(), order.end()};
}

} // namespace boba

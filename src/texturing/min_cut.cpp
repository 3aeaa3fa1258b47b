#include "texturing/min_cut.h"

#include <algorithm>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/property_map/property_map.hpp>

namespace ebru {

std::vector<std::uint8_t> minimumCut(std::span<const CutNode> nodes, std::span<const CutLink> links) {
  using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                   boost::no_property, std::uint32_t, std::uint32_t>;
  using Edge = boost::graph_traits<Graph>::edge_descriptor;
  const auto count = static_cast<std::uint32_t>(nodes.size());
  const std::uint32_t source = count, sink = count + 1;  // the source's side keeps, the sink's changes

  // A link costs `both` for (0, 0), `apart` for (0, 1) and (1, 0), nothing for (1, 1): its ends pay half of `both` each for
  // keeping, and what is left of `apart` is the edge.
  std::vector<float> excess(count);  // of keeping over changing
  for (std::uint32_t i = 0; i < count; ++i) excess[i] = nodes[i].keep - nodes[i].change;
  struct Arc {
    std::uint32_t from, to, pair;
    float capacity;
  };
  std::vector<Arc> arcs;
  arcs.reserve(2 * links.size() + 2 * count);
  std::uint32_t pair = 0;
  const auto addPair = [&](std::uint32_t from, std::uint32_t to, float forward, float backward) {
    arcs.push_back({from, to, pair, forward});
    arcs.push_back({to, from, pair, backward});
    ++pair;
  };
  for (const CutLink& link : links) {
    const float both = std::min(link.both, 2.0f * link.apart);
    excess[link.a] += 0.5f * both;
    excess[link.b] += 0.5f * both;
    const float edge = link.apart - 0.5f * both;
    addPair(link.a, link.b, edge, edge);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (excess[i] < 0.0f) addPair(source, i, -excess[i], 0.0f);  // paid for changing
    if (excess[i] > 0.0f) addPair(i, sink, excess[i], 0.0f);
  }
  std::sort(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) {
    return a.from != b.from ? a.from < b.from : a.pair < b.pair;
  });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends(arcs.size());
  std::vector<float> capacity(arcs.size()), residual(arcs.size());
  std::vector<std::uint32_t> first(pair, ~0u);
  std::vector<Edge> reverse(arcs.size());
  for (std::uint32_t k = 0; k < arcs.size(); ++k) {
    ends[k] = {arcs[k].from, arcs[k].to};
    capacity[k] = arcs[k].capacity;
    std::uint32_t& other = first[arcs[k].pair];
    if (other == ~0u) {
      other = k;
    } else {
      reverse[k] = Edge(arcs[other].from, other);
      reverse[other] = Edge(arcs[k].from, k);
    }
  }
  const Graph graph(boost::edges_are_sorted, ends.begin(), ends.end(), count + 2);
  const auto edgeIndex = get(boost::edge_index, graph);
  std::vector<Edge> predecessor(count + 2);
  std::vector<boost::default_color_type> colour(count + 2);
  std::vector<std::uint32_t> distance(count + 2);
  const auto vertexIndex = get(boost::vertex_index, graph);
  boost::boykov_kolmogorov_max_flow(graph, boost::make_iterator_property_map(capacity.begin(), edgeIndex),
                                    boost::make_iterator_property_map(residual.begin(), edgeIndex),
                                    boost::make_iterator_property_map(reverse.begin(), edgeIndex),
                                    boost::make_iterator_property_map(predecessor.begin(), vertexIndex),
                                    boost::make_iterator_property_map(colour.begin(), vertexIndex),
                                    boost::make_iterator_property_map(distance.begin(), vertexIndex), vertexIndex, source,
                                    sink);
  // White is the tree of the sink; what neither tree holds keeps.
  std::vector<std::uint8_t> labels(count);
  for (std::uint32_t i = 0; i < count; ++i) labels[i] = colour[i] == boost::color_traits<boost::default_color_type>::white();
  return labels;
}

}  // namespace ebru

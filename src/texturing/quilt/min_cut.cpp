#include "texturing/quilt/min_cut.h"

#include <algorithm>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/property_map/property_map.hpp>
#include <cmath>

namespace ebru {
namespace {

using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                 boost::no_property, std::uint32_t, std::uint32_t>;
using Edge = boost::graph_traits<Graph>::edge_descriptor;

constexpr std::uint32_t decided = 0xffffffffu;

/// Both directions of an edge.
struct Pair {
  std::uint32_t from, to;
  float forward, backward;
};

/// The flow network in the form that Boost's algorithm takes: edges sorted by their source.
struct Network {
  Network(std::uint32_t vertexCount, std::span<const Pair> pairs)
      : ends(2 * pairs.size()), capacity(ends.size()), residual(ends.size()), reverse(ends.size()) {
    std::vector<std::uint32_t> next(vertexCount + 1, 0);
    for (const Pair& p : pairs) ++next[p.from + 1], ++next[p.to + 1];
    for (std::uint32_t v = 0; v < vertexCount; ++v) next[v + 1] += next[v];
    for (const Pair& p : pairs) {
      const std::uint32_t there = next[p.from]++, back = next[p.to]++;
      ends[there] = {p.from, p.to};
      ends[back] = {p.to, p.from};
      capacity[there] = p.forward;
      capacity[back] = p.backward;
      reverse[there] = Edge(p.to, back);
      reverse[back] = Edge(p.from, there);
    }
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
  std::vector<float> capacity, residual;
  std::vector<Edge> reverse;
};

/// Per vertex, whether it is in the tree of the sink. What neither tree holds could go either way.
std::vector<std::uint8_t> sinkSide(std::uint32_t vertexCount, std::span<const Pair> pairs, std::uint32_t source,
                                   std::uint32_t sink) {
  Network network(vertexCount, pairs);
  const Graph graph(boost::edges_are_sorted, network.ends.begin(), network.ends.end(), vertexCount);
  const auto edge = get(boost::edge_index, graph);
  const auto vertex = get(boost::vertex_index, graph);
  std::vector<Edge> predecessor(vertexCount);
  std::vector<boost::default_color_type> tree(vertexCount);
  std::vector<std::uint32_t> distance(vertexCount);
  boost::boykov_kolmogorov_max_flow(
      graph, boost::make_iterator_property_map(network.capacity.begin(), edge),
      boost::make_iterator_property_map(network.residual.begin(), edge),
      boost::make_iterator_property_map(network.reverse.begin(), edge),
      boost::make_iterator_property_map(predecessor.begin(), vertex), boost::make_iterator_property_map(tree.begin(), vertex),
      boost::make_iterator_property_map(distance.begin(), vertex), vertex, source, sink);
  std::vector<std::uint8_t> side(vertexCount);
  for (std::uint32_t v = 0; v < vertexCount; ++v)
    side[v] = tree[v] == boost::color_traits<boost::default_color_type>::white();
  return side;
}

}  // namespace

std::vector<std::uint8_t> minimumCut(std::span<const CutNode> nodes, std::span<const CutLink> links) {
  // The source's side keeps, the sink's changes. `excess` is what keeping costs more than changing.
  std::vector<std::uint8_t> labels(nodes.size());
  std::vector<std::uint32_t> vertexOf(nodes.size(), decided);
  std::vector<float> excess;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    labels[i] = std::isinf(nodes[i].keep);
    if (std::isinf(nodes[i].keep) || std::isinf(nodes[i].change)) continue;
    vertexOf[i] = static_cast<std::uint32_t>(excess.size());
    excess.push_back(nodes[i].keep - nodes[i].change);
  }
  // A link costs `both` for (0, 0), `apart` for (0, 1) and (1, 0), nothing for (1, 1): its ends pay half of `both` each for
  // keeping, and what is left of `apart` is the edge.
  std::vector<Pair> pairs;
  for (const CutLink& link : links) {
    const std::uint32_t a = vertexOf[link.a], b = vertexOf[link.b];
    const float both = std::min(link.both, 2.0f * link.apart);
    if (a != decided && b != decided) {
      excess[a] += 0.5f * both;
      excess[b] += 0.5f * both;
      const float edge = link.apart - 0.5f * both;
      pairs.push_back({a, b, edge, edge});
    } else if (a != decided || b != decided) {
      const bool otherChanges = labels[a == decided ? link.a : link.b] != 0;
      excess[a != decided ? a : b] += otherChanges ? link.apart : both - link.apart;
    }
  }
  const auto count = static_cast<std::uint32_t>(excess.size()), source = count, sink = count + 1;
  for (std::uint32_t v = 0; v < count; ++v) {
    if (excess[v] < 0.0f) pairs.push_back({source, v, -excess[v], 0.0f});
    if (excess[v] > 0.0f) pairs.push_back({v, sink, excess[v], 0.0f});
  }
  const std::vector<std::uint8_t> side = sinkSide(count + 2, pairs, source, sink);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (vertexOf[i] != decided) labels[i] = side[vertexOf[i]];
  return labels;
}

}  // namespace ebru

#include "texturing/quilt/min_cut.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace ebru {
namespace {

double cost(const std::vector<CutNode>& nodes, const std::vector<CutLink>& links, const std::vector<std::uint8_t>& labels) {
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) sum += labels[i] ? nodes[i].change : nodes[i].keep;
  for (const CutLink& l : links) {
    if (labels[l.a] != labels[l.b]) sum += l.apart;
    else if (!labels[l.a]) sum += std::min(l.both, 2.0f * l.apart);
  }
  return sum;
}

// Every labelling of small random problems is tried.
TEST(MinimumCut, IsNoDearerThanAnyLabelling) {
  constexpr std::uint32_t count = 9;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Random random(trial, 0, 0);
    std::vector<CutNode> nodes(count);
    for (CutNode& n : nodes) n = {random.uniform(), random.uniform()};
    if (trial % 2) {
      nodes[0].keep = forbidden;
      nodes[1].change = forbidden;
    }
    std::vector<CutLink> links;
    for (std::uint32_t a = 0; a < count; ++a)
      for (std::uint32_t b = a + 1; b < count; ++b)
        if (random.uniform() < 0.4f) links.push_back({a, b, trial % 3 ? random.uniform() : 0.0f, 0.7f * random.uniform()});
    const std::vector<std::uint8_t> labels = minimumCut(nodes, links);
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t bits = 0; bits < (1u << count); ++bits) {
      std::vector<std::uint8_t> other(count);
      for (std::uint32_t i = 0; i < count; ++i) other[i] = (bits >> i) & 1u;
      least = std::min(least, cost(nodes, links, other));
    }
    EXPECT_NEAR(cost(nodes, links, labels), least, 1e-5) << "trial " << trial;
  }
}

TEST(MinimumCut, KeepsWhereNothingSpeaksForAChange) {
  const std::vector<CutNode> nodes(4);
  EXPECT_EQ(minimumCut(nodes, std::vector<CutLink>{{0, 1, 0.0f, 1.0f}}), std::vector<std::uint8_t>(4, 0));
}

TEST(MinimumCut, DecidedNodesDecideTheirNeighbours) {
  const std::vector<CutNode> nodes = {{forbidden, 0.0f}, {}, {}, {0.0f, forbidden}};
  const std::vector<CutLink> links = {{0, 1, 0.0f, 3.0f}, {1, 2, 0.0f, 1.0f}, {2, 3, 0.0f, 3.0f}};
  EXPECT_EQ(minimumCut(nodes, links), (std::vector<std::uint8_t>{1, 1, 0, 0}));
}

// A seam that lies between two nodes vanishes when both change.
TEST(MinimumCut, AnOldSeamSpeaksForAChangeOfBothSides) {
  const std::vector<CutNode> nodes = {{0.0f, 0.4f}, {0.0f, 0.4f}};
  EXPECT_EQ(minimumCut(nodes, std::vector<CutLink>{{0, 1, 0.7f, 1.0f}}), (std::vector<std::uint8_t>{0, 0}));
  EXPECT_EQ(minimumCut(nodes, std::vector<CutLink>{{0, 1, 0.9f, 1.0f}}), (std::vector<std::uint8_t>{1, 1}));
}

TEST(MinimumCut, NoNodesAndNoLinks) { EXPECT_TRUE(minimumCut({}, {}).empty()); }

}  // namespace
}  // namespace ebru

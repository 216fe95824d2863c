/// \file
/// The spanning tree along which the signs of normals are propagated, tile by tile.
///
/// The whole cloud's tree is that of Kruskal's algorithm over all edges, flattest first. What a tile alone can tell of it: an edge
/// that closes a cycle within the tile is not in it; an edge that joins a set of points none of which has an edge to
/// another tile is. Only edges between two sets that both have such points wait for the other tiles: fewer than there are points
/// at the tile's border.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surroundings.hpp"

namespace ahm::tiles {

/// An edge that waits, between two sets of points, which go by their smallest members.
struct Joint {
  float bend;
  Index tail, head;    ///< the edge, numbers of the whole cloud
  Index from, to;      ///< the sets; of an edge that leaves the tile `to` is its head
  signed char sign;    ///< of the normals of `from` and `to` relative to each other, along this edge: -1, 1
  signed char turn;    ///< of the normals of `tail` and `head`: -1, 0, 1
  signed char inward;  ///< of the normal of `tail` relative to `from`: -1, 1
  char leaves;         ///< whether the head is in a later tile
};
static_assert(sizeof(Joint) == 24);  // nothing in it is undefined

/// A point with edges to other tiles.
struct Terminal {
  Index point, root;
  std::int32_t sign;  ///< of its normal relative to that of the root
};

/// What a tile knows.
struct TileTrees {
  std::vector<Index> root;        ///< of each own point, the smallest member of its set; numbers of the whole cloud
  std::vector<signed char> sign;  ///< of its normal, relative to that member's
  std::vector<Joint> joints;      ///< and all edges to points of later tiles
  std::vector<Terminal> terminals;
};

/// @param tails, heads  the edges at the tile's points, in lexicographic order, as places in the surroundings
TileTrees tile_trees(const AroundFile& around, std::span<const Index> tails, std::span<const Index> heads);

}  // namespace ahm::tiles

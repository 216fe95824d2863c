/// \file
/// The spanning tree along which the signs of normals are propagated, tile by tile.
///
/// Kruskal's algorithm over all edges, flattest first, gives the tree of the whole cloud. A tile decides some edges without the others:
/// an edge that closes a cycle within the tile is not in the tree; an edge that joins a set without edges to other tiles is. Only edges
/// between two sets that both have edges to other tiles stay undecided: fewer than the points at the border of the tile.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surroundings.hpp"

namespace ahm::tiles {

/// An undecided edge between two sets of points. A set is identified by its smallest member.
struct Joint {
  float bend;
  Index tail, head;    ///< ends of the edge, numbers in the whole cloud
  Index from, to;      ///< sets of the ends; for an edge that leaves the tile `to` is its head
  signed char sign;    ///< sign of the normal of `to` relative to that of `from` along this edge: -1, 1
  signed char turn;    ///< sign of the dot product of the normals of `tail` and `head`: -1, 0, 1
  signed char inward;  ///< sign of the normal of `tail` relative to that of `from`: -1, 1
  char leaves;         ///< whether the head is in a later tile
};
static_assert(sizeof(Joint) == 24);  // without padding, whose bytes would be undefined

/// A point with edges to other tiles.
struct Terminal {
  Index point, root;
  std::int32_t sign;  ///< sign of its normal relative to that of the root
};

/// The forest of one tile and its undecided edges.
struct TileTrees {
  std::vector<Index> root;        ///< smallest member of the set of each own point, number in the whole cloud
  std::vector<signed char> sign;  ///< sign of the normal of each own point relative to that of its root
  std::vector<Joint> joints;      ///< undecided edges, including all edges to points of later tiles
  std::vector<Terminal> terminals;
};

/// Computes the forest of a tile.
/// @param tails, heads  edges at the points of the tile in lexicographic order, indices into the surroundings
TileTrees tile_trees(const AroundFile& around, std::span<const Index> tails, std::span<const Index> heads);

}  // namespace ahm::tiles

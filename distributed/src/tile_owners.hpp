/// \file
/// Who of those who make a map together owns which tile.
#pragma once

#include <cstddef>
#include <vector>

namespace ahm::distributed {

/// The same for all members but for their rank.
struct TileOwners {
  int rank = 0, ranks = 1;   ///< of this member, of how many
  std::vector<int> of_tile;  ///< rank of the owner of each tile

  bool owns(std::size_t tile) const { return of_tile[tile] == rank; }
};

}  // namespace ahm::distributed

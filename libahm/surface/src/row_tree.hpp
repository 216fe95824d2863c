/// \file
/// A search tree for the row nearest to a position.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ahm/surface/row_map.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// A k-d tree over the rows that have a vertex. It returns bit for bit the result of a scan over all rows: of rows at equal
/// distances that of the lowest vertex. Library trees compare squared distances, so their result may differ. Immutable.
class RowTree {
 public:
  /// O(n log n). Skips positions that are not finite. @param positions  position of each row
  RowTree(const RowMap& rows, std::span<const Vec3> positions, Index vertices);

  /// The nearest row; row 0 where the tree is empty. @param position  finite
  Row nearest(const Vec3& position) const;

 private:
  struct Entry {
    Vec3 position;
    Index vertex;
    Row row;
  };
  struct Best {
    double distance;
    const Entry* entry;
  };

  /// Replaces the best entry by a nearer one.
  static void consider(const Entry& entry, const Vec3& position, Best& best);
  void build(std::size_t begin, std::size_t end);
  void search(std::size_t begin, std::size_t end, const Vec3& position, Best& best) const;

  std::vector<Entry> entries_;
  std::vector<std::uint8_t> axis_;  ///< axis along which the middle entry of a part splits the part
};

}  // namespace ahm

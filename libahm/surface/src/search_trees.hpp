/// \file
/// The row nearest to a position, for those who ask often.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ahm/surface/row_map.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// A k-d tree over the rows that have a vertex. It answers what looking at all of them answers, bit for bit: of rows at equal
/// distances that of the lowest vertex; whence no library's, which compare squares. Immutable.
class RowTree {
 public:
  /// O(n log n). @param positions  by row; those that are not finite are left out
  RowTree(const RowMap& rows, std::span<const Vec3> positions, Index vertices);

  /// @param position  finite. @return row 0 where the tree is empty
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

  static void look_at(const Entry& entry, const Vec3& position, Best& best);
  void build(std::size_t begin, std::size_t end);
  void search(std::size_t begin, std::size_t end, const Vec3& position, Best& best) const;

  std::vector<Entry> entries_;
  std::vector<std::uint8_t> axis_;  ///< along which the middle entry of a part halves the others
};

}  // namespace ahm

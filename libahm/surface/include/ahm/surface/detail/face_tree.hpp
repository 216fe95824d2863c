/// \file
/// A search tree for the point of a mesh nearest to a position. Not part of the public interface.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ahm/surface/surface_point.hpp"
#include "ahm/types.hpp"

namespace ahm::detail {

/// A bounding-box tree over the triangles of the faces (polygons are split into fans from their first corner). Immutable. Both arguments
/// must outlive it.
class FaceTree {
 public:
  struct Hit {
    FacePoint point;
    Vec3 position;    ///< position of `point`, in the units of the positions
    double distance;  ///< distance in space from the query to `position`
  };

  /// O(n log n). Skips faces with corners that are not finite.
  /// @throws InvalidGeometry (no face has finite corners)
  FaceTree(std::span<const Vec3> positions, const FaceList& faces);

  /// The nearest point of the faces. @param position  finite
  Hit nearest(const Vec3& position) const;
  /// The position of the nearest point, faster; none: it is not nearer than `within`.
  std::optional<Vec3> nearest_position(const Vec3& position,
                                       double within = std::numeric_limits<double>::infinity()) const;

 private:
  struct Piece {
    Index face, corner;  ///< the triangle of corners 0, `corner` and `corner` + 1 of the face
  };
  struct Box {
    Vec3 low, high;
    std::size_t begin, end;  ///< range in `pieces_`
    std::size_t second;      ///< number of the second child, 0 in a leaf; the first child follows this box
  };

  struct Search;

  Search search_from(const Vec3& position) const;
  const Vec3& corner(const Piece& piece, int k) const;
  void build(std::size_t begin, std::size_t end);
  template <class Visitor>
  void visit(std::size_t number, const Search& search, const Visitor& visitor) const;
  std::array<Vec3, 3> corners(const Piece& piece, double scale) const;

  std::span<const Vec3> positions_;
  FaceList faces_;
  std::vector<Piece> pieces_;
  std::vector<Box> boxes_;
};

}  // namespace ahm::detail

/// \file
/// The point of a mesh that is nearest to a position in space.
///
/// \code
/// const ahm::FaceTree tree(positions, faces);                    // views: both must outlive the tree
/// ahm::FaceTree::Hit hit = tree.nearest({0.1, 0.2, 1.4});        // hit.point.face, hit.position, hit.distance
/// \endcode
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ahm/surface/surface_point.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// A tree of boxes over the triangles of the faces (polygons as fans from their first corner). Immutable.
class FaceTree {
 public:
  struct Hit {
    FacePoint point;
    Vec3 position;    ///< of the point, in the units of the positions
    double distance;  ///< in space
  };

  /// O(n log n). Faces with corners that are not finite are left out.
  /// @throws InvalidGeometry (no other faces)
  FaceTree(std::span<const Vec3> positions, const FaceList& faces);

  /// @param position  finite
  Hit nearest(const Vec3& position) const;

 private:
  struct Piece {
    Index face, corner;  ///< corners 0, `corner`, `corner` + 1 of the face
  };
  struct Box {
    Vec3 low, high;
    std::size_t begin, end;  ///< pieces
    std::size_t second;      ///< the second half's box, 0 in a leaf; the first half's one follows this one
  };

  struct Look {
    std::array<double, 3> weights;  ///< of its corners
    Vec3 position;
    double distance, size;  ///< size: the largest coordinate of the triangle
  };

  struct Search;

  const Vec3& corner(const Piece& piece, int k) const;
  void build(std::size_t begin, std::size_t end);
  template <class LookAt>
  void visit(std::size_t number, const Search& search, const LookAt& look_at) const;
  Look look(const Piece& piece, const Vec3& from, double scale) const;

  std::span<const Vec3> positions_;
  FaceList faces_;
  std::vector<Piece> pieces_;
  std::vector<Box> boxes_;
};

}  // namespace ahm

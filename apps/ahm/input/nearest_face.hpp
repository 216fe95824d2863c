/// \file
/// The point of a mesh that is nearest to a position in space.
#pragma once

#include <vector>

#include "ahm/io/geometry.hpp"
#include "cli/source_spec.hpp"

namespace ahm::app {

/// A tree of boxes over the triangles of the faces (polygons as fans from their first corner).
class NearestFace {
 public:
  struct Hit {
    SourceFace point;  ///< on the mesh
    Vec3 position;
    double distance;
  };

  /// @param input  with faces; must outlive the tree. Faces with corners that are not finite are left out
  explicit NearestFace(const io::Geometry& input);

  Hit nearest(const Vec3& position) const;

 private:
  struct Triangle {
    Index face, corner;  ///< corners 0, `corner`, `corner` + 1 of the face
  };
  struct Box {
    Vec3 low, high;
    std::size_t begin, end;  ///< triangles
    std::size_t second;      ///< the second half's box, 0 in a leaf; the first half's one follows this one
  };

  Vec3 corner(const Triangle& triangle, int k) const;
  void build(std::size_t begin, std::size_t end);
  void search(std::size_t box, const Vec3& position, Hit& best) const;
  void look_at(const Triangle& triangle, const Vec3& position, Hit& best) const;

  const io::Geometry& input_;
  std::vector<Triangle> triangles_;
  std::vector<Box> boxes_;
};

}  // namespace ahm::app

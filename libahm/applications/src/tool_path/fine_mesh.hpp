/// \file
/// The domain of tool paths: triangles smaller than the spacing, with exact distances from curves.
#pragma once

#include <optional>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/surface/detail/face_tree.hpp"
#include "ahm/surface/exact/exact_map.hpp"
#include "ahm/util/vec.hpp"
#include "face_mesh.hpp"

namespace ahm {

struct BoundingBox {
  Vec3 low, high;

  void include(const Vec3& p);
  double diagonal() const;
  Vec3 center() const;
  double distance_to(const Vec3& p) const;
};
BoundingBox bounding_box(const std::vector<Vec3>& points);

/// A mesh of the same shape as a coarser one. It has the points of the coarse mesh, followed by others.
struct Refinement {
  FaceMesh mesh;
  std::vector<Index> parent;  ///< per face: the coarse face that contains it, with the same orientation
};

/// Checks that triangles with sides of at most `longest` can have the area of a mesh, before the work is done.
/// @throws ResourceExhausted (more than 2^26 faces)
void check_refinement(const FaceMesh& mesh, double longest);

/// A mesh of the same shape with sides of at most `longest`.
/// @throws ResourceExhausted (more than 2^26 faces)
Refinement refined(const FaceMesh& mesh, double longest);

/// The part of a mesh with some of its faces. @param kept  one per face
FaceMesh part_of(const FaceMesh& mesh, const std::vector<bool>& kept);

/// A mesh as a polyhedral surface, in the same units.
exact::PolyhedralSurface polyhedral(const FaceMesh& mesh);

/// Finds the point of a mesh that is nearest to a position.
class MeshTree {
 public:
  struct Hit {
    exact::MeshPoint point;
    double distance;  ///< in space, from the position
  };

  /// @param mesh  must outlive the tree
  explicit MeshTree(const FaceMesh& mesh);

  const FaceMesh& mesh() const { return mesh_; }
  Hit nearest(const Vec3& position) const;
  /// The position of the nearest point, faster; none: it is not nearer than `within`.
  std::optional<Vec3> nearest_position(const Vec3& position, double within) const {
    return tree_.nearest_position(position, within);
  }
  double distance(const Vec3& position) const { return ahm::distance(position, *tree_.nearest_position(position)); }

 private:
  const FaceMesh& mesh_;
  std::vector<Offset> begin_;
  detail::FaceTree tree_;
};

}  // namespace ahm

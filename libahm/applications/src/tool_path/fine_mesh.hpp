/// \file
/// The domain of tool paths: triangles smaller than the spacing, with exact distances from curves.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/surface/exact/exact_map.hpp"
#include "face_mesh.hpp"

namespace ahm {

struct BoundingBox {
  Vec3 low, high;

  void include(const Vec3& p);
  double diagonal() const;
  Vec3 center() const;
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

/// Finds points of a mesh near positions, with a grid of cubes.
class FaceLocator {
 public:
  /// @param mesh   must outlive the locator; its sides are about as long as the reach
  /// @param reach  largest distance of `nearest`
  explicit FaceLocator(const FaceMesh& mesh, double reach = 0.5);
  ~FaceLocator();
  FaceLocator(FaceLocator&&) noexcept;

  /// The nearest point of the mesh within the reach; none where there is none.
  std::optional<exact::MeshPoint> nearest(const Vec3& position) const;

 private:
  struct Grid;
  const FaceMesh* mesh_;
  double reach_;
  std::unique_ptr<Grid> grid_;
};

/// The nearest point of a triangle, as barycentric coordinates.
std::array<double, 3> nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace ahm

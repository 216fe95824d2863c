/// \file
/// The domains of tool paths, and distances from curves on them. Lengths are in spacings.
#pragma once

#include <utility>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/surface/exact/geodesic_path.hpp"
#include "tool_path/fine_mesh.hpp"

namespace ahm {

/// Longest side of the mesh on which windows propagate, and of the fine mesh on which distances are interpolated.
inline constexpr double longest_window_side = 3.2, longest_side = 0.4;

/// A mesh, and its exact geodesics.
struct PathDomain {
  explicit PathDomain(FaceMesh triangles) : mesh(std::move(triangles)), surface(polyhedral(mesh)) {}
  PathDomain(const PathDomain&) = delete;
  PathDomain& operator=(const PathDomain&) = delete;

  /// As `exact::locally_shortest_path`.
  exact::GeodesicPath path(const exact::MeshPoint& from, const exact::MeshPoint& to) const;

  FaceMesh mesh;
  exact::PolyhedralSurface surface;
};

/// A fine mesh of the same shape as a coarser one, whose points it begins with.
struct FineDomain : PathDomain {
  /// @param coarse  must outlive this object
  explicit FineDomain(const PathDomain& coarse) : FineDomain(coarse, refined(coarse.mesh, longest_side)) {}

  /// A point in the coarse face that contains its face.
  exact::MeshPoint in_coarse(const exact::MeshPoint& point) const;

  const PathDomain& coarse;
  std::vector<Index> parent;  ///< as `Refinement::parent`

 private:
  FineDomain(const PathDomain& coarse, Refinement fine)
      : PathDomain(std::move(fine.mesh)), coarse(coarse), parent(std::move(fine.parent)) {}
};

/// Distance from curves at the points of a fine mesh, with the angle at which the shortest path arrives.
struct Front {
  std::vector<double> distance;  ///< infinity: not reached
  /// Angle of the direction back along the path, around the point, from the right side of its first corner; NaN: none.
  std::vector<double> back;
};

/// Exact distances, by windows that cross the faces of the coarse mesh: far from a source, the number of windows grows with
/// the number of faces, and a point inside a face costs much less than a vertex.
/// @param sources  points of the fine mesh
Front front(const FineDomain& domain, const std::vector<exact::MeshPoint>& sources, double radius,
            const Progress& progress);

}  // namespace ahm

/// \file
/// Paths and straight lines of a subcommand: over the faces, exactly, or where there are none over tangent planes.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm::app {

/// A curve over the surface.
struct FoundLine {
  Status status = Status::ok;  ///< without points where not ok
  std::vector<Vec3> points;
  double length = 0;
  bool complete = true;                     ///< else it ended at the boundary
  std::vector<exact::MeshPoint> flat = {};  ///< the points in the triangles; empty over tangent planes
};

class LineFinder {
 public:
  /// @param surface  must outlive this. @throws as `ExactGeodesics`
  explicit LineFinder(const Surface& surface);

  /// Whether lines run over faces.
  bool has_faces() const { return geodesics_.has_value(); }
  /// @param fast  over faces: locally shortest, without an exact map
  FoundLine path(const SurfacePoint& from, const SurfacePoint& to, bool fast) const;
  std::vector<FoundLine> paths(std::span<const std::array<SurfacePoint, 2>> pairs, bool fast, const Progress& progress,
                               unsigned threads) const;
  FoundLine trace(const SurfacePoint& from, const Vec3& direction, double length) const;
  /// A loop pulled tight. Faces only.
  FoundLine tightened(std::span<const exact::MeshPoint> loop) const;
  /// The log map from a point, for pictures.
  LogMap map(const SurfacePoint& point) const;

 private:
  const Surface& surface_;
  std::optional<ExactGeodesics> geodesics_;
};

}  // namespace ahm::app

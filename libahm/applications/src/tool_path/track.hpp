/// \file
/// Curves on the mesh as poses of the tool: positions at the offset, and smoothed axes. Lengths are in spacings.
#pragma once

#include <optional>
#include <vector>

#include "tool_path/ball.hpp"
#include "tool_path/passes.hpp"

namespace ahm {

/// A point of the path on the mesh, with the position and the axis of the tool.
struct Spot {
  exact::MeshPoint point;
  Vec3 contact, position, axis;
};
using Track = std::vector<Spot>;

/// The mean normal of the faces within a radius, weighted by area and falling to zero at the radius.
class SmoothNormals {
 public:
  SmoothNormals(const FaceMesh& mesh, double radius);
  Vec3 at(const exact::MeshPoint& point) const;

 private:
  const FaceMesh& mesh_;
  double radius_;
  std::vector<Vec3> normals_, centers_;
};

/// Places the tool on curves.
class ToolPlacer {
 public:
  struct Options {
    double step;         ///< longest distance between poses
    double chord_error;  ///< largest distance of the path of the tool from the chords between poses
    double tool_radius;  ///< of the smoothed axes
    double offset;       ///< radius of a ball whose center is the position of the tool; 0: the tool is on the surface
  };

  /// @param part  the surface that the tool must not cut. @param mesh  of the curves
  ToolPlacer(const MeshTree& part, const FaceMesh& mesh, const Options& options);

  double offset() const { return options_.offset; }
  /// The tool at a point; none where a ball of the offset does not fit.
  std::optional<Spot> at(const exact::MeshPoint& point) const;
  /// A curve as tracks, which end where a ball of the offset does not fit. Where it fits everywhere, the track of a closed curve
  /// ends at its first position.
  std::vector<Track> tracks(const MeshCurve& curve) const;

 private:
  std::optional<Spot> at(const exact::MeshPoint& point, const Vec3& axis) const;
  std::vector<Vec3> normals_at(const exact::MeshPoint& point) const;
  void append(Spot spot, Track& track) const;
  std::optional<Spot> turned(const Spot& from, const Spot& to) const;
  void refine(const Spot& from, const Spot& to, int depth, std::vector<Track>& tracks) const;
  Track simplified(const Track& track) const;

  BallPlacer ball_;
  const FaceMesh& mesh_;
  Options options_;
  SmoothNormals normals_;
};

}  // namespace ahm

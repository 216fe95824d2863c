/// \file
/// Shortest paths and straight lines for subcommands: exact over faces, or over tangent planes where there are no faces.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface.hpp"
#include "cli/source_list.hpp"
#include "input/open.hpp"
#include "output/lines.hpp"

namespace ahm::app {

/// A curve on the surface.
struct FoundLine {
  Status status = Status::ok;  ///< other than ok: there are no points
  std::vector<Vec3> points;
  double length = 0;
  bool complete = true;                     ///< false: the curve ended early, at the boundary
  std::vector<exact::MeshPoint> flat = {};  ///< the points as positions in triangles; empty over tangent planes
};

/// Finds paths and straight lines on one surface.
class LineFinder {
 public:
  /// @param surface  must outlive the finder. @throws as `ExactGeodesics`
  explicit LineFinder(const Surface& surface);

  /// Whether curves run over faces, not over tangent planes.
  bool has_faces() const { return geodesics_.has_value(); }
  /// The shortest path.
  /// @param fast  over faces, return a locally shortest path without computing an exact map
  FoundLine path(const SurfacePoint& from, const SurfacePoint& to, bool fast) const;
  std::vector<FoundLine> paths(std::span<const std::array<SurfacePoint, 2>> pairs, bool fast, const Progress& progress,
                               unsigned threads) const;
  FoundLine trace(const SurfacePoint& from, const Vec3& direction, double length) const;
  /// The closed geodesic that results from shortening a loop. Requires faces.
  FoundLine tightened(std::span<const exact::MeshPoint> loop) const;
  /// The log map from a point, for pictures.
  LogMap map(const SurfacePoint& point) const;

 private:
  const Surface& surface_;
  std::optional<ExactGeodesics> geodesics_;
};

using FindPolylines = std::function<Polylines(const LineFinder& finder, const Input& input, Journal& journal)>;

/// Opens the input, finds the curves, and writes --output (.csv, .ply with edges, or .obj with lines), --view (the curves on a map)
/// and --json.
/// @param name    name of the subcommand
/// @param source  --source; none for subcommands without a single source
/// @throws what opening, `find` and writing throw
void run_polyline(const std::string& name, const InputOptions& options, const OutputOptions& output,
                  const std::optional<SourceSpec>& source, const FindPolylines& find);

/// The point of the surface for a SPEC; for a position the nearest point of the surface.
/// @param option  name of the option, for messages
/// @throws InvalidArgument
SurfacePoint point_on_surface(const Input& input, const SourceSpec& spec, const std::string& option);

/// A direction at a point as a vector in space.
/// @param option  name of the option of the point, for messages
/// @throws InvalidArgument (an angle at a point without a u axis)
Vec3 vector_of(const Direction& direction, const Input& input, const SurfacePoint& point, const std::string& option);

}  // namespace ahm::app

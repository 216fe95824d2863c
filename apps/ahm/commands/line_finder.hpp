/// \file
/// Shortest paths and straight lines for subcommands: exact over faces, or over tangent planes where there are no faces.
#pragma once

#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface.hpp"
#include "input/open.hpp"

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

/// The curves that a subcommand found, and its report.
struct Polylines {  // NOLINT(bugprone-exception-escape): assertions in the destructor of nlohmann's values
  std::optional<SurfacePoint> from =
      {};                         ///< source of the map in the picture; none: the picture shows only the surface
  std::vector<Vec3> points = {};  ///< points of all curves, one curve after the other
  std::vector<Index> begin =
      {};                 ///< index of the first point of each curve; equal to the next one for curves without points
  bool numbered = false;  ///< whether the table has a column with the number of the curve
  std::vector<double> levels = {};   ///< level of each curve, a column of the table; empty: no column
  nlohmann::ordered_json json = {};  ///< report for programs, after the head of the summary
  std::string text = {};             ///< report for users

  void add(const std::vector<Vec3>& curve) {
    begin.push_back(static_cast<Index>(points.size()));
    points.insert(points.end(), curve.begin(), curve.end());
  }
  /// Index after the last point of curve k.
  Index end(std::size_t k) const { return k + 1 < begin.size() ? begin[k + 1] : static_cast<Index>(points.size()); }
};
/// Writes an .obj with lines, or a table with edges.
/// @param format  extension; empty: that of the file name. @throws IoError
void write_polylines(const std::string& file, const std::string& format, const Polylines& curves);

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

}  // namespace ahm::app

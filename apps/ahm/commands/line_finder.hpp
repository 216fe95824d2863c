/// \file
/// Paths and straight lines of a subcommand: over the faces, exactly, or where there are none over tangent planes.
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

/// What a subcommand found, and what it tells.
struct Polylines {  // NOLINT(bugprone-exception-escape): assertions in the destructor of nlohmann's values
  std::optional<SurfacePoint> from = {};  ///< of the map in the picture; none: the surface alone
  std::vector<Vec3> points = {};          ///< of all curves, one behind the other
  std::vector<Index> begin = {};     ///< where each begins; several may begin at the same place, those without points
  bool numbered = false;             ///< whether the table tells which curve a point belongs to
  nlohmann::ordered_json json = {};  ///< to programs, after the head of the summary
  std::string text = {};             ///< to people

  void add(const std::vector<Vec3>& curve) {
    begin.push_back(static_cast<Index>(points.size()));
    points.insert(points.end(), curve.begin(), curve.end());
  }
  /// The end of curve k.
  Index end(std::size_t k) const { return k + 1 < begin.size() ? begin[k + 1] : static_cast<Index>(points.size()); }
};
/// .obj with lines, or a table with edges. @param format  extension; empty: as the name says. @throws IoError
void write_polylines(const std::string& file, const std::string& format, const Polylines& curves);

using FindPolylines = std::function<Polylines(const LineFinder& finder, const Input& input, Journal& journal)>;

/// Opens the input, finds the curves, and writes them: --output (.csv, .ply with edges, or .obj with lines), --view (the
/// curves on an exact map) and --json.
/// @param name    of the subcommand
/// @param source  --source, where the surface is opened for one
/// @throws what opening, `find` and writing throw
void run_polyline(const std::string& name, const InputOptions& options, const OutputOptions& output,
                  const std::optional<SourceSpec>& source, const FindPolylines& find);

/// The point that the user means; of a position the nearest point of the surface.
/// @param option  that asked for it, for messages
/// @throws InvalidArgument
SurfacePoint point_on_surface(const Input& input, const SourceSpec& spec, const std::string& option);

}  // namespace ahm::app

/// \file
/// Curves and coverage paths, and the files that contain them.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ahm/applications/coverage.hpp"
#include "ahm/applications/isolines.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/types.hpp"

namespace ahm::app {

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

/// Isolines with their levels. Closed ones end at their first point.
Polylines polylines_of(const std::vector<Isoline>& lines);

/// Writes an .obj with lines, or a table with edges.
/// @param format  extension; empty: that of the file name. @throws IoError
void write_polylines(const std::string& file, const std::string& format, const Polylines& curves);

/// Writes one row per point, and an edge between consecutive points of a piece. PLY files are text.
/// @param format  extension; empty: that of the file name. @throws IoError
void write_coverage(const std::string& file, const std::string& format, const CoveragePath& path);

}  // namespace ahm::app

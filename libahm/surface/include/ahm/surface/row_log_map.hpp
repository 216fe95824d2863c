/// \file
/// A log map on the rows of the input: what people want to see and files hold.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ahm/maps/log_map.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// One entry per row of the input, in its order; NaN where the status is not ok.
struct RowLogMap {
  std::vector<double> u, v;            ///< world units
  std::vector<double> distance;        ///< `LogMap::distance`, world units, but no less than the straight line
  std::vector<double> angle;           ///< atan2(v, u), in (-pi, pi]; empty from a curve
  std::vector<double> spread;          ///< `LogMap::spread`, world units
  std::vector<double> error_estimate;  ///< `LogMap::error_estimate`; empty where the map has none
  /// 1 where the distance is only a bound: what the map has was shorter than the straight line, which stands for it. Empty for exact
  /// maps and curves.
  std::vector<double> bounded;
  std::vector<Status> status;                 ///< `removed` for rows without a vertex
  std::vector<std::optional<Vertex>> vertex;  ///< that the numbers are from
};

/// Numbers of vertices, such as their `map_quality`, on the rows of a map: those of the vertex that the row's coordinates
/// are from, NaN where there is none.
/// @param values  one per vertex. @throws InvalidArgument (too few)
std::vector<double> to_rows(const RowLogMap& rows, std::span<const double> values);

/// Coordinates at one point of a surface; NaN where the status is not ok.
struct Sample {
  double u, v;
  Status status;
};

}  // namespace ahm

/// \file
/// A log map by rows of the input, as applications display and store it.
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
  std::vector<double> distance;        ///< `LogMap::distance`, world units, at least the straight-line distance
  std::vector<double> angle;           ///< atan2(v, u), in (-pi, pi]; empty for curves
  std::vector<double> spread;          ///< `LogMap::spread`, world units
  std::vector<double> error_estimate;  ///< `LogMap::error_estimate`; empty where the map has none
  /// 1 where the distance is only a lower bound: the map's distance was shorter than the straight line, which replaces it.
  /// Empty for exact maps and curves.
  std::vector<double> bounded;
  std::vector<Status> status;                 ///< `removed` for rows without a vertex
  std::vector<std::optional<Vertex>> vertex;  ///< vertex that the row's numbers are from
};

/// Values of vertices, such as their `map_quality`, by rows: the value of the vertex that the row's coordinates are from. NaN
/// where there is none.
/// @param values  one per vertex. @throws InvalidArgument (too few)
std::vector<double> to_rows(const RowLogMap& rows, std::span<const double> values);

/// Coordinates at one point of a surface; NaN where the status is not ok.
struct Sample {
  double u, v;
  Status status;
};

}  // namespace ahm

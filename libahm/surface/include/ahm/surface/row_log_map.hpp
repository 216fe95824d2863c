/// \file
/// A log map on the rows of the input: what people want to see and files hold.
#pragma once

#include <optional>
#include <vector>

#include "ahm/maps/log_map.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// One entry per row of the input, in its order; NaN where the status is not ok.
struct RowLogMap {
  std::vector<double> u, v;                   ///< world units
  std::vector<double> distance;               ///< |(u, v)|, world units
  std::vector<double> angle;                  ///< atan2(v, u), in (-pi, pi]
  std::vector<double> error_estimate;         ///< of order 2 (`LogMap::error_estimate`), else empty
  std::vector<Status> status;                 ///< `removed` for rows without a vertex
  std::vector<std::optional<Vertex>> vertex;  ///< that the numbers are from
};

/// Coordinates at one point of a surface; NaN where the status is not ok.
struct Sample {
  double u, v;
  Status status;
};

}  // namespace ahm

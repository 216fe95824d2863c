#include "map_rows.hpp"

#include <cmath>
#include <limits>

#include "ahm/quality.hpp"

namespace ahm::app {

MapRows rows_of(const LogMap& map, const Model& model, std::size_t rows) {
  const std::vector<double> none(rows, std::numeric_limits<double>::quiet_NaN());
  MapRows result{none, none, none, none, none, {}, std::vector<Status>(rows, Status::removed)};
  const std::span<const double> error = map.error_estimate();
  if (!error.empty()) result.error_estimate = none;
  const std::vector<double> quality = map_quality(model.graph(), map);
  for (const auto& [row, vertex] : model.row_vertices()) {
    const auto r = static_cast<std::size_t>(row), k = static_cast<std::size_t>(vertex);
    const Status status = map.status(vertex);
    if (status != Status::ok) {
      if (result.status[r] != Status::ok) result.status[r] = status;
      continue;
    }
    if (result.status[r] == Status::ok && result.distance[r] <= map.distance(vertex)) continue;
    const auto phi = map.coordinates(vertex);
    result.u[r] = phi[0];
    result.v[r] = phi[1];
    result.distance[r] = map.distance(vertex);
    result.angle[r] = std::atan2(phi[1], phi[0]);
    result.quality[r] = quality[k];
    if (!error.empty()) result.error_estimate[r] = error[k];
    result.status[r] = Status::ok;
  }
  return result;
}

}  // namespace ahm::app

#include "output/map_rows.hpp"

#include <cmath>
#include <limits>

#include "ahm/maps/quality.hpp"

namespace ahm::app {

MapRows rows_of(const LogMap& map, const Model& model, std::size_t rows) {
  const std::vector<double> none(rows, std::numeric_limits<double>::quiet_NaN());
  MapRows result{
      none, none, none, none, none, {}, std::vector<Status>(rows, Status::removed), std::vector<Index>(rows, -1)};
  const std::span<const double> error = map.error_estimate();
  if (!error.empty()) result.error_estimate = none;
  const std::vector<double> quality = map_quality(model.graph(), map);
  for (const auto& [row, vertex] : model.row_vertices()) {
    const auto r = static_cast<std::size_t>(row), k = static_cast<std::size_t>(vertex);
    const Status status = map.status(Vertex(vertex));
    if (status != Status::ok) {
      if (result.status[r] != Status::ok) result.status[r] = status;
      continue;
    }
    if (result.status[r] == Status::ok && result.distance[r] <= map.distance(Vertex(vertex))) continue;
    const auto phi = map.coordinates(Vertex(vertex));
    result.u[r] = phi[0];
    result.v[r] = phi[1];
    result.distance[r] = map.distance(Vertex(vertex));
    result.angle[r] = std::atan2(phi[1], phi[0]);
    result.quality[r] = quality[k];
    if (!error.empty()) result.error_estimate[r] = error[k];
    result.status[r] = Status::ok;
    result.vertex[r] = vertex;
  }
  return result;
}

std::vector<Vec3> gradients(const LogMap& map, const Model& model, const MapRows& rows) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double at_source = 1e-8 * model.graph().mean_edge_length() * model.graph().length_unit();
  std::vector<Vec3> result(rows.vertex.size(), Vec3{nan, nan, nan});
  for (std::size_t r = 0; r < result.size(); ++r) {
    if (rows.vertex[r] < 0) continue;
    const std::optional<Frame> frame = model.graph().frame(rows.vertex[r]);
    if (!frame) continue;
    const double* U = &map.frames()[4 * static_cast<std::size_t>(rows.vertex[r])];
    const double scale = rows.distance[r] > at_source ? 1 / rows.distance[r] : 0;
    const double a = scale * (U[0] * rows.u[r] + U[1] * rows.v[r]), b = scale * (U[2] * rows.u[r] + U[3] * rows.v[r]);
    for (std::size_t k = 0; k < 3; ++k) result[r][k] = a * frame->x[k] + b * frame->y[k];
  }
  return result;
}

}  // namespace ahm::app

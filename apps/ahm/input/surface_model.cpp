#include "input/surface_model.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "output/wording.hpp"

namespace ahm::app {

ResolvedSource SurfaceModel::source(const SourceSpec& spec, const std::optional<Vec3>& u_axis) const try {
  SurfacePoint point;
  if (const auto* face = std::get_if<SourceFace>(&spec))
    point = FacePoint{face->face, face->weights};
  else if (const auto* position = std::get_if<SourcePosition>(&spec))
    point = surface_->nearest_row(position->position);
  else
    point = Row(std::get<SourceVertex>(spec).index);
  PlacedSource placed = surface_->source(point, u_axis);
  return {std::move(placed.source), placed.row ? std::optional(placed.row->index) : std::nullopt, placed.position,
          placed.frame};
} catch (const InvalidArgument& e) {
  if (u_axis && e.fault() == "axis_along_normal")
    throw InvalidArgument(fmt::format("--u-axis {},{},{}: is perpendicular to the surface at the source {}",
                                      (*u_axis)[0], (*u_axis)[1], (*u_axis)[2], to_string(spec)));
  throw InvalidArgument(fmt::format("--source {}: {}", to_string(spec), worded(e)));
}

std::vector<RowVertex> SurfaceModel::row_vertices() const {
  std::vector<RowVertex> result;
  const RowMap& rows = surface_->rows();
  for (Index r = 0; r < rows.row_count(); ++r)
    for (Vertex v : rows.vertices(Row(r))) result.push_back({r, v.index});
  return result;
}

std::vector<Index> SurfaceModel::corner_vertices() const {
  const auto vertices = surface_->corner_vertices();
  return {vertices.begin(), vertices.end()};
}

nlohmann::ordered_json SurfaceModel::report() const { return as_json(surface_->report()); }

std::vector<std::string> SurfaceModel::warnings() const {
  std::vector<std::string> result;
  for (const Warning& warning : surface_->warnings()) result.push_back(worded(warning));
  return result;
}

}  // namespace ahm::app

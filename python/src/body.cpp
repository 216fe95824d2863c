#include "body.hpp"

#include <algorithm>

#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"
#include "errors.hpp"

namespace ahm::python {

bool Places::all_rows() const {
  return std::ranges::all_of(places, [](const Place& place) {
    const auto* point = std::get_if<SurfacePoint>(&place);
    return point != nullptr && std::holds_alternative<Row>(*point);
  });
}

const Surface& Body::surface_for(const char* what) const {
  if (!surface_) throw InvalidArgument(std::string(what) + " needs a mesh or a cloud; this is a grid or a graph");
  return *surface_;
}

std::optional<Row> Body::row(Vertex vertex) const {
  return surface_ ? surface_->rows().row(vertex) : std::optional(Row(vertex.index));
}

SurfacePoint Body::point(const Place& place) const {
  if (const auto* point = std::get_if<SurfacePoint>(&place)) return *point;
  return surface_for("a position").closest_point(std::get<Vec3>(place)).point;
}

SurfaceSource Body::source(const Place& place, const std::optional<Vec3>& u_axis) const {
  if (surface_) return surface_->source(point(place), u_axis);
  if (u_axis) throw InvalidArgument("a u axis needs a mesh or a cloud; the axes of grids and graphs are fixed");
  if (const auto* position = std::get_if<Vec3>(&place)) {
    if (grid_ == nullptr) throw InvalidArgument("a position needs a mesh, a cloud or a grid; use a row");
    const auto d = static_cast<std::size_t>(grid_->dimension());
    return {grid_->source_at(std::span(*position).first(d)), *position, std::nullopt, std::nullopt};
  }
  const auto* row = std::get_if<Row>(&std::get<SurfacePoint>(place));
  if (row == nullptr) throw InvalidArgument("on grids and graphs only rows can be used; use a row");
  SurfaceSource result{Source::at_vertex(vertex(*row)), {}, graph_->frame(row->index), *row};
  if (grid_ != nullptr) result.position = grid_->position(Vertex(row->index));
  if (grid_ == nullptr && result.frame) result.position = result.frame->origin;
  return result;
}

std::vector<SurfaceSource> Body::sources(const Places& places, const std::optional<Vec3>& u_axis) const {
  std::vector<SurfaceSource> result;
  for (std::size_t k = 0; k < places.size(); ++k)
    result.push_back(naming(places.where(k), [&] { return source(places.places[k], u_axis); }));
  return result;
}

std::vector<Source> Body::plain_sources(const Places& places, const std::optional<Vec3>& u_axis) const {
  std::vector<Source> result;
  for (SurfaceSource& placed : sources(places, u_axis)) result.push_back(std::move(placed.source));
  return result;
}

Vertex Body::vertex_near(const Place& place) const {
  if (const auto* position = std::get_if<Vec3>(&place)) {
    const Surface& all = surface_for("a position");
    return all.vertex(all.nearest_row(*position));
  }
  const auto& point = std::get<SurfacePoint>(place);
  if (const auto* row = std::get_if<Row>(&point)) return vertex(*row);
  const Surface& all = surface_for("a point in a face or on an edge");
  const Vec3 position = all.position(point);
  std::vector<Index> corners;
  if (const auto* inside = std::get_if<FacePoint>(&point)) {
    const auto face = all.faces()[static_cast<std::size_t>(inside->face)];
    corners.assign(face.begin(), face.end());
  } else {
    const auto& edge = std::get<EdgePoint>(point);
    all.source(edge);  // throws if there is no such edge
    corners = {edge.from.index, edge.to.index};
  }
  const auto away = [&](Index row) { return distance(all.positions()[row], position); };
  return all.vertex(
      Row(*std::min_element(corners.begin(), corners.end(), [&](Index a, Index b) { return away(a) < away(b); })));
}

std::vector<Vertex> Body::vertices_near(const Places& places) const {
  std::vector<Vertex> result;
  for (std::size_t k = 0; k < places.size(); ++k)
    result.push_back(naming(places.where(k), [&] { return vertex_near(places.places[k]); }));
  return result;
}

const ExactGeodesics& Body::geodesics() const {
  const Surface& all = surface_for("a geodesic");
  std::call_once(once_, [&] { geodesics_ = std::make_unique<const ExactGeodesics>(all); });
  return *geodesics_;
}

const InputFaces& Body::input_faces() const {
  const ExactGeodesics& on = geodesics();
  std::call_once(once_faces_, [&] { input_faces_ = std::make_unique<const InputFaces>(on); });
  return *input_faces_;
}

Places places(const py::tuple& given) {
  Places result{given[0].cast<std::string>(), given[1].cast<bool>(), {}};
  const auto kinds = given[2].cast<Bytes>();
  const auto index = given[3].cast<Indices>(), count = given[4].cast<Indices>();
  const auto values = given[5].cast<Doubles>();
  const py::ssize_t width = values.shape(1);
  for (py::ssize_t k = 0; k < kinds.size(); ++k) {
    const double* row = values.data() + k * width;
    if (kinds.at(k) == 0)
      result.places.emplace_back(SurfacePoint(Row(index.at(k))));
    else if (kinds.at(k) == 1)
      result.places.emplace_back(Vec3{row[0], row[1], row[2]});
    else if (kinds.at(k) == 2)
      result.places.emplace_back(SurfacePoint(FacePoint{index.at(k), std::vector<double>(row, row + count.at(k))}));
    else
      result.places.emplace_back(SurfacePoint(EdgePoint{Row(index.at(k)), Row(static_cast<Index>(row[0])), row[1]}));
  }
  return result;
}

std::optional<Vec3> optional_vector(const py::object& given) {
  if (given.is_none()) return std::nullopt;
  const auto array = given.cast<Doubles>();
  return Vec3{array.at(0), array.at(1), array.at(2)};
}

}  // namespace ahm::python

#include "input/skin.hpp"

#include <algorithm>

#include "ahm/graph/components.hpp"
#include "ahm/maps/quality.hpp"

namespace ahm::app {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

bool is_cloud(const Input& input) { return !input.backend->has_faces; }

/// The polygons of the input by rows, turned to the side of the normals.
struct InputFaces {
  std::vector<Offset> begin{0};
  std::vector<Index> rows;

  InputFaces(const io::Geometry& input, const std::vector<Vec3>& normals) {
    for (std::size_t f = 0; f < input.face_count(); ++f) {
      const auto face = input.face(f);
      const auto first = rows.insert(rows.end(), face.begin(), face.end());
      if (side(input, face, normals) < 0) std::reverse(first + 1, rows.end());
      begin.push_back(static_cast<Offset>(rows.size()));
    }
  }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> result;
    for (std::size_t f = 0; f + 1 < begin.size(); ++f)
      for (Offset c = begin[f] + 1; c + 1 < begin[f + 1]; ++c)
        result.push_back({rows[begin[f]], rows[c], rows[static_cast<std::size_t>(c) + 1]});
    return result;
  }

 private:
  /// Positive where the vector area of a face points to the side of the normals of its corners.
  static double side(const io::Geometry& input, std::span<const Index> face, const std::vector<Vec3>& normals) {
    Vec3 area{}, normal{};
    for (std::size_t c = 0; c < face.size(); ++c) {
      Vec3 a, b;
      for (std::size_t k = 0; k < 3; ++k) {
        a[k] = input.points[face[c]][k] - input.points[face[0]][k];
        b[k] = input.points[face[(c + 1) % face.size()]][k] - input.points[face[0]][k];
        normal[k] += normals[face[c]][k];
      }
      for (std::size_t k = 0; k < 3; ++k) area[k] += a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
    return area[0] * normal[0] + area[1] * normal[1] + area[2] * normal[2];
  }
};

Skin skin_of_mesh(const Input& input) {
  Skin skin;
  skin.points = input.geometry.points;
  skin.normals = input.surface->normals();
  skin.face_begin = input.geometry.face_begin;
  skin.corner_vertices = input.surface->corner_vertices();
  std::vector<Index> row_of(at(input.graph().size()), -1);
  for (const auto& [row, vertex] : input.surface->row_vertices()) row_of[vertex] = row;
  for (Index vertex : skin.corner_vertices) skin.corner_points.push_back(row_of[vertex]);
  return skin;
}

Skin skin_of_cloud(const TangentGraph& graph, const LogMapSolver& solver, std::span<const Vertex> sources) {
  const Components components = connected_components(graph);
  std::vector<bool> has_source(at(components.count), false);
  std::vector<Vertex> starts;
  for (Vertex vertex : sources) {
    const std::size_t component = at(components.of_vertex[vertex.index]);
    if (!has_source[component]) starts.push_back(vertex);
    has_source[component] = true;
  }
  MapOptions options;
  options.frames = true;
  const LogMap map = solver.solve(Source::at_vertices(starts), options);
  Skin skin;
  skin.normals = source_side_normals(graph, map);
  for (Index v = 0; v < graph.size(); ++v) skin.points.push_back(graph.frame(v)->origin);
  for (const Triangle& t : star_triangles(graph, map)) {
    skin.corner_vertices.insert(skin.corner_vertices.end(), t.begin(), t.end());
    skin.face_begin.push_back(static_cast<Offset>(skin.corner_vertices.size()));
  }
  skin.corner_points = skin.corner_vertices;
  return skin;
}

}  // namespace

Skin skin_of(const Input& input, const LogMapSolver& solver, std::span<const Vertex> sources) {
  return is_cloud(input) ? skin_of_cloud(input.graph(), solver, sources) : skin_of_mesh(input);
}

InverseMap inverse_of(const Input& input, const LogMap& map, double min_quality) {
  const TangentGraph& graph = input.graph();
  if (is_cloud(input)) return inverse_map(graph, map, {.min_quality = min_quality});
  const std::size_t rows = input.rows();
  const std::vector<Vec3> graph_normals = source_side_normals(graph, map);
  const std::vector<double> quality = map_quality(graph, map);
  std::vector<Index> nearest(rows, -1);
  for (const auto& [row, vertex] : input.surface->row_vertices())
    if (map.status(Vertex(vertex)) == Status::ok &&
        (nearest[row] < 0 || map.distance(Vertex(vertex)) < map.distance(Vertex(nearest[row]))))
      nearest[row] = vertex;
  std::vector<Vec3> normals(rows);
  std::vector<double> coordinates(2 * rows);
  std::vector<std::uint8_t> valid(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    if (nearest[r] < 0) continue;
    normals[r] = graph_normals[nearest[r]];
    std::copy_n(map.coordinates(Vertex(nearest[r])).begin(), 2,
                coordinates.begin() + static_cast<std::ptrdiff_t>(2 * r));
    valid[r] = quality[nearest[r]] >= min_quality;
  }
  return InverseMap(
      {input.geometry.points, normals, coordinates, valid, InputFaces(input.geometry, normals).triangles()});
}

}  // namespace ahm::app

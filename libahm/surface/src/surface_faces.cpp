#include "ahm/surface/surface_faces.hpp"

#include <algorithm>

#include "ahm/graph/components.hpp"
#include "ahm/surface/star_triangles.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

/// The first source of every component.
Source source_of_each_component(const TangentGraph& graph, std::span<const Vertex> sources) {
  const Components components = connected_components(graph);
  std::vector<bool> has_source(components.count, false);
  Source source(2);
  constexpr double offset[] = {0, 0}, axes[] = {1, 0, 0, 1};
  for (Vertex vertex : sources) {
    const Index component = components.of_vertex[vertex.index];
    if (!has_source[component]) source.add(vertex, 1, offset, axes);
    has_source[component] = true;
  }
  return source;
}

SurfaceFaces found_triangles(const TangentGraph& graph, const LogMap& map) {
  SurfaceFaces result;
  result.normals = source_side_normals(graph, map);
  for (Index v = 0; v < graph.size(); ++v) result.points.push_back(graph.frame(v)->origin);
  for (const Triangle& t : star_triangles(graph, map)) {
    result.corner_vertices.insert(result.corner_vertices.end(), t.begin(), t.end());
    result.begin.push_back(static_cast<Offset>(result.corner_vertices.size()));
  }
  result.corner_points = result.corner_vertices;
  return result;
}

/// Positive where the vector area of a face points to the side of the normals of its corners.
double side(std::span<const Vec3> points, std::span<const Index> face, std::span<const Vec3> normals) {
  Vec3 area{}, normal{};
  const auto corner = [&](std::size_t c) { return points[face[c % face.size()]] - points[face[0]]; };
  double size = 0;
  for (std::size_t c = 0; c < face.size(); ++c) size = std::max(size, largest(corner(c)));
  const double scale = 1 / power_of_two_below(size);
  for (std::size_t c = 0; c < face.size(); ++c) {
    area = area + cross(scale * corner(c), scale * corner(c + 1));
    normal = normal + normals[face[c]];
  }
  return dot(area, normal);
}

}  // namespace

SurfaceFaces surface_faces(const Surface& surface) {
  if (surface.faces().size() == 0) return {};
  const auto positions = surface.positions();
  const FaceList faces = surface.faces();
  const auto corners = surface.corner_vertices();
  SurfaceFaces result{{positions.begin(), positions.end()},
                      surface.normals(),
                      {faces.begin.begin(), faces.begin.end()},
                      {},
                      {corners.begin(), corners.end()}};
  for (Index vertex : corners) result.corner_points.push_back(surface.rows().row(Vertex(vertex))->index);
  return result;
}

SurfaceFaces surface_faces(const Surface& surface, const LogMapSolver& solver, std::span<const Vertex> sources) {
  if (surface.faces().size() > 0) return surface_faces(surface);
  const Source source = source_of_each_component(surface.graph(), sources);
  return found_triangles(surface.graph(), solver.solve(source, {.frames = true}));
}

SurfaceFaces surface_faces(const Surface& surface, const PolarMapSolver& solver, std::span<const Vertex> sources) {
  if (surface.faces().size() > 0) return surface_faces(surface);
  const Source source = source_of_each_component(surface.graph(), sources);
  return found_triangles(surface.graph(), solver.log_map(source, {.frames = true}));
}

std::vector<Triangle> turned_triangles(const Surface& surface, std::span<const Vec3> normals) {
  const FaceList faces = surface.faces();
  std::vector<Triangle> result;
  std::vector<Index> corners;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    corners.assign(faces[f].begin(), faces[f].end());
    if (side(surface.positions(), corners, normals) < 0) std::reverse(corners.begin() + 1, corners.end());
    for (std::size_t c = 1; c + 1 < corners.size(); ++c) result.push_back({corners[0], corners[c], corners[c + 1]});
  }
  return result;
}

}  // namespace ahm

#include "ahm/applications/atlas.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/text.hpp"
#include "atlas/atlas_maker.hpp"

namespace ahm {
namespace {

void check(const Atlas& atlas, const FaceList& faces) {
  if (atlas.chart_of_face.size() != faces.size() || atlas.coordinates.size() != 2 * faces.vertices.size())
    throw InvalidArgument("the atlas has " + std::to_string(atlas.chart_of_face.size()) + " faces and " +
                          std::to_string(atlas.coordinates.size() / 2) + " corners, not those " +
                          std::to_string(faces.size()) + " and " + std::to_string(faces.vertices.size()) + " given");
}

/// Faces cut into fans of triangles, and what the atlas does to them.
struct Fans {
  std::vector<std::array<Offset, 3>> corners;
  std::vector<TriangleDistortion> triangles;

  Fans(const Atlas& atlas, const FaceList& faces, std::span<const Vec3> positions, std::span<const Index> numbers) {
    std::vector<std::array<Index, 3>> vertices;
    std::vector<double> coordinates;
    for (Index f : numbers)
      for (Offset c = faces.begin[f] + 1; c + 1 < faces.begin[f + 1]; ++c) {
        corners.push_back({faces.begin[f], c, c + 1});
        auto& triangle = vertices.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
          triangle[k] = faces.vertices[corners.back()[k]];
          for (double x : atlas.corner(corners.back()[k])) coordinates.push_back(x);
        }
      }
    triangles = corner_distortion(positions, vertices, coordinates);
  }
};

/// Where a chart wants another source; -1 where it is good, or no vertex is left.
Index vertex_to_add(const Atlas& atlas, const FaceList& faces, std::span<const Vec3> positions, const Chart& chart,
                    const std::vector<bool>& is_source, const RefineOptions& options) {
  const Fans fans(atlas, faces, positions, chart.faces);
  const std::vector<double> areas = relative_areas(fans.triangles);
  double area = 0, bad_area = 0, farthest = -1;
  Index vertex = -1;
  for (std::size_t t = 0; t < fans.triangles.size(); ++t) {
    const TriangleDistortion& triangle = fans.triangles[t];
    area += areas[t];
    if (!triangle.flipped && !(triangle.value() > options.max_distortion)) continue;
    bad_area += areas[t];
    for (Offset c : fans.corners[t]) {
      const auto [u, v] = atlas.corner(c);
      const Index candidate = faces.vertices[c];
      if (std::hypot(u, v) > farthest && !is_source[candidate]) farthest = std::hypot(u, v), vertex = candidate;
    }
  }
  return bad_area > options.share * area ? vertex : -1;
}

/// The sources and, of each component of faces without one, a vertex.
std::vector<Vertex> one_per_component(const TangentGraph& graph, std::span<const Vertex> sources, const FaceList& faces,
                                      std::size_t most) {
  std::vector<Vertex> result(sources.begin(), sources.end());
  const Components components = connected_components(graph);
  std::vector<bool> has_source(components.count, false);
  const auto component = [&](Index vertex) { return components.of_vertex[vertex]; };
  for (const auto [vertex] : sources)
    if (vertex >= 0 && vertex < graph.size()) has_source[component(vertex)] = true;
  for (Index vertex : faces.vertices) {
    if (result.size() >= most || has_source[component(vertex)]) continue;
    has_source[component(vertex)] = true;
    result.push_back(Vertex(vertex));
  }
  return result;
}

}  // namespace

AtlasDistortion distortion(const Atlas& atlas, const FaceList& faces, std::span<const Vec3> positions) {
  check(atlas, faces);
  return detail::with_memory_check("measuring distortion", [&] {
    AtlasDistortion result;
    std::vector<TriangleDistortion> all;
    const auto add = [&](std::span<const Index> numbers) {
      const Fans fans(atlas, faces, positions, numbers);
      all.insert(all.end(), fans.triangles.begin(), fans.triangles.end());
      return summary(fans.triangles);
    };
    for (const Chart& chart : atlas.charts) result.charts.push_back(add(chart.faces));
    std::vector<Index> uncharted;
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (atlas.chart_of_face[f] < 0) uncharted.push_back(static_cast<Index>(f));
    add(uncharted);
    result.all = summary(all);
    return result;
  });
}

Atlas make_atlas(const MapMaker& maps, std::span<const Vertex> sources, const FaceList& faces) {
  return detail::with_memory_check("making an atlas", [&] {
    AtlasMaker maker(maps, faces);
    maker.make(sources);
    return maker.take();
  });
}

Atlas make_atlas(const MapMaker& maps, std::span<const Vertex> sources, const FaceList& faces,
                 std::span<const Vec3> positions, const RefineOptions& refine) {
  if (!(refine.max_distortion > 1))
    throw InvalidArgument("max_distortion is " + detail::number(refine.max_distortion) + "; it must be > 1");
  if (!(refine.share >= 0 && refine.share < 1))
    throw InvalidArgument("share is " + detail::number(refine.share) + "; it must be in [0, 1)");
  if (positions.size() != static_cast<std::size_t>(maps.graph().size()))
    throw InvalidArgument("'positions' has " + std::to_string(positions.size()) + " entries, not " +
                          std::to_string(maps.graph().size()));
  return detail::with_memory_check("making an atlas", [&] {
    AtlasMaker maker(maps, faces);
    maker.make(one_per_component(maps.graph(), sources, faces, refine.max_sources));
    const Atlas& atlas = maker.atlas();
    std::vector<bool> is_source(positions.size(), false);
    for (Vertex vertex : atlas.sources) is_source[vertex.index] = true;
    std::vector<bool> settled(faces.size(), false);  // at the first face of a chart: it wants no other source
    while (true) {
      std::vector<Vertex> more = atlas.sources;
      for (std::size_t k = 0; k < atlas.charts.size(); ++k) {
        if (more.size() >= refine.max_sources) break;
        const Chart& chart = atlas.charts[k];
        if (!maker.is_new(k) && settled[chart.faces.front()]) continue;
        const Index vertex = vertex_to_add(atlas, faces, positions, chart, is_source, refine);
        settled[chart.faces.front()] = vertex < 0;
        if (vertex < 0 || is_source[vertex]) continue;  // two charts may want the same corner
        is_source[vertex] = true;
        more.push_back(Vertex(vertex));
      }
      if (more.size() == atlas.sources.size()) return maker.take();
      maker.make(more);
    }
  });
}

}  // namespace ahm

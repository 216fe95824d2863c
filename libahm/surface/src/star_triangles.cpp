#include "ahm/surface/star_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {
namespace {

void check(const char* function, const TangentGraph& graph, const LogMap& map) {
  const std::string name = std::string(function) + ": ";
  if (graph.dimension() != 2)
    throw InvalidArgument(name + "the graph has dimension " + std::to_string(graph.dimension()) + ", not 2");
  if (map.size() != graph.size() || map.dimension() != 2)
    throw InvalidArgument(name + "the map has " + std::to_string(map.size()) + " vertices, the graph " +
                          std::to_string(graph.size()));
  if (map.frames().size() != 4 * to_size(graph.size()))
    throw InvalidArgument("map_without_frames", name + "the map has no frames", "solve with MapOptions::frames = true");
}

/// Whether the source's axes arrive at the vertex as a reflection of its frame.
bool is_mirrored(const LogMap& map, Index vertex) {
  const auto U = map.frames().subspan(4 * to_size(vertex), 4);
  return U[0] * U[3] - U[1] * U[2] < 0;
}

/// Sorted neighbours with coordinates, each once.
struct Neighbors {
  std::vector<Offset> begin{0};
  std::vector<Index> all;

  Neighbors(const TangentGraph& graph, const LogMap& map) {
    for (Index i = 0; i < graph.size(); ++i) {
      const auto first = static_cast<std::ptrdiff_t>(all.size());
      if (map.status(Vertex(i)) == Status::ok)
        for (Index j : graph.star(i).neighbors)
          if (map.status(Vertex(j)) == Status::ok) all.push_back(j);
      std::sort(all.begin() + first, all.end());
      all.erase(std::unique(all.begin() + first, all.end()), all.end());
      begin.push_back(static_cast<Offset>(all.size()));
    }
  }

  std::span<const Index> of(Index i) const {
    return std::span(all).subspan(static_cast<std::size_t>(begin[i]),
                                  static_cast<std::size_t>(begin[to_size(i) + 1] - begin[i]));
  }

  bool are_neighbors(Index i, Index j) const {
    const auto row = of(i);
    return std::binary_search(row.begin(), row.end(), j);
  }
};

struct Spoke {
  double angle;
  Index neighbor;
  std::array<double, 2> log;
};

/// The star's edges to vertices with coordinates by angle; of parallel edges one counts.
void sort_spokes(const Star& star, const LogMap& map, std::vector<Spoke>& spokes) {
  spokes.clear();
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const auto log = star.log(e);
    if (map.status(Vertex(star.neighbors[e])) == Status::ok && (log[0] != 0 || log[1] != 0))
      spokes.push_back({std::atan2(log[1], log[0]), star.neighbors[e], {log[0], log[1]}});
  }
  std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) {
    return a.neighbor != b.neighbor ? a.neighbor < b.neighbor : a.angle < b.angle;
  });
  const auto end = std::unique(spokes.begin(), spokes.end(),
                               [](const Spoke& a, const Spoke& b) { return a.neighbor == b.neighbor; });
  spokes.erase(end, spokes.end());
  std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) { return a.angle < b.angle; });
}

/// Whether i, j, m, k are a quadrilateral for some m, counter-clockwise in frame i: m is a neighbour of j and k and lies
/// on the other side of them than i would if the corner at i were a border.
bool close_a_quadrilateral(const TangentGraph& graph, const LogMap& map, const Neighbors& neighbors, Index i, Index j,
                           Index k) {
  const Star star = graph.star(j);
  const double side = is_mirrored(map, i) == is_mirrored(map, j) ? 1 : -1;
  const auto back = std::find(star.neighbors.begin(), star.neighbors.end(), i);
  if (back == star.neighbors.end()) return false;
  const auto e_ji = star.log(static_cast<std::size_t>(back - star.neighbors.begin()));
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Index m = star.neighbors[e];
    const auto e_jm = star.log(e);
    if (m != i && side * (e_jm[0] * e_ji[1] - e_jm[1] * e_ji[0]) > 0 && neighbors.are_neighbors(k, m)) return true;
  }
  return false;
}

}  // namespace

std::vector<Triangle> star_triangles(const TangentGraph& graph, const LogMap& map) {
  check("star_triangles", graph, map);
  const Neighbors neighbors(graph, map);
  std::vector<Triangle> result;
  std::vector<Spoke> spokes;
  for (Index i = 0; i < graph.size(); ++i) {
    if (map.status(Vertex(i)) != Status::ok) continue;
    sort_spokes(graph.star(i), map, spokes);
    for (std::size_t s = 0; s < spokes.size(); ++s) {
      const Spoke &a = spokes[s], &b = spokes[(s + 1) % spokes.size()];
      if (!(a.log[0] * b.log[1] - a.log[1] * b.log[0] > 0)) continue;
      if (!neighbors.are_neighbors(a.neighbor, b.neighbor) &&
          !close_a_quadrilateral(graph, map, neighbors, i, a.neighbor, b.neighbor))
        continue;
      Triangle t{i, a.neighbor, b.neighbor};
      if (is_mirrored(map, i)) std::swap(t[1], t[2]);
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      result.push_back(t);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<Vec3> source_side_normals(const TangentGraph& graph, const LogMap& map) {
  check("source_side_normals", graph, map);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> normals(to_size(graph.size()), Vec3{nan, nan, nan});
  for (Index i = 0; i < graph.size(); ++i) {
    if (map.status(Vertex(i)) != Status::ok) continue;
    const auto frame = graph.frame(i);
    if (!frame)
      throw InvalidArgument("source_side_normals: vertex " + std::to_string(i) +
                            " has no frame in space; use a graph whose backend knows frames");
    normals[i] = frame->normal;
    if (is_mirrored(map, i))
      for (double& x : normals[i]) x = -x;
  }
  return normals;
}

}  // namespace ahm

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "surroundings.hpp"
#include "tangent_edges.hpp"

namespace ahm::tiles {
namespace {

/// Vertices of all points of a tile and its surroundings, from the tiles that own them.
struct AroundVertices {
  std::vector<Index> local;      ///< index among the vertices here of each point; -1: not a vertex
  std::vector<Index> vertex;     ///< number in the graph of each vertex
  std::vector<Index> component;  ///< component of each vertex
};

/// Finds these vertices, and applies the signs to the normals of the surroundings.
AroundVertices find_vertices(const TileFolder& folder, AroundFile& around) {
  const std::vector<Index> first = folder.manifest().first_points();
  AroundVertices result;
  for (std::size_t i = 0; i < around.numbers.size();) {
    const auto tile =
        static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), around.numbers[i]) - first.begin() - 1);
    const ArrayFile file = folder.open(kind::vertices, tile);
    const auto vertex = file.get<Index>("vertex"), component = file.get<Index>("component");
    const auto sign = file.get<signed char>("sign");
    for (; i < around.numbers.size() && around.numbers[i] < first[tile + 1]; ++i) {
      const Index own = around.numbers[i] - first[tile];
      around.planes.normals[i] = static_cast<double>(sign[own]) * around.planes.normals[i];
      result.local.push_back(vertex[own] < 0 ? -1 : static_cast<Index>(result.vertex.size()));
      if (vertex[own] < 0) continue;
      result.vertex.push_back(vertex[own]);
      result.component.push_back(component[own]);
    }
  }
  return result;
}

pointcloud::WeightedEdges read_edges(const ArrayFile& file) {
  pointcloud::WeightedEdges edges;
  const auto tails = file.get<Index>("tails"), heads = file.get<Index>("heads");
  const auto weights = file.get<double>("weights");
  edges.tails.assign(tails.begin(), tails.end());
  edges.heads.assign(heads.begin(), heads.end());
  edges.weights.assign(weights.begin(), weights.end());
  return edges;
}

template <class T>
std::span<const T> part(const std::vector<T>& values, Offset begin, Offset end, std::size_t width = 1) {
  return std::span(values).subspan(static_cast<std::size_t>(begin) * width,
                                   static_cast<std::size_t>(end - begin) * width);
}

/// Rows of the input at the vertices of a tile, and rows without a vertex.
struct Rows {
  std::vector<Index> begin{0}, rows, removed;
};

Rows rows_of(const ArrayFile& points, std::span<const Index> local_vertex) {
  const auto rows = points.get<Index>("rows"), row_begin = points.get<Index>("row_begin");
  Rows result;
  for (std::size_t i = 0; i < local_vertex.size(); ++i) {
    const auto here =
        rows.subspan(static_cast<std::size_t>(row_begin[i]), static_cast<std::size_t>(row_begin[i + 1] - row_begin[i]));
    auto& into = local_vertex[i] < 0 ? result.removed : result.rows;
    into.insert(into.end(), here.begin(), here.end());
    if (local_vertex[i] >= 0) result.begin.push_back(static_cast<Index>(result.rows.size()));
  }
  return result;
}

}  // namespace

/// Writes the tile's part of the graph.
void make_graph(TileFolder& folder, std::size_t tile) {
  AroundFile around(folder, tile);
  const AroundVertices vertices = find_vertices(folder, around);
  const ArrayFile edges_file = folder.open(kind::edges, tile), points_file = folder.open(kind::points, tile);
  const pointcloud::WeightedEdges edges = read_edges(edges_file);
  pointcloud::CloudDetails details;
  const CsrGraphData g =
      tangent_edges(around.cloud, around.planes, edges, vertices.local, static_cast<Index>(vertices.vertex.size()), 0,
                    folder.manifest().noise, folder.options().threads, details, folder.manifest().kind);
  const std::size_t width = TransportLayout{g.kind, 2}.width();

  // The tile's own vertices are consecutive.
  std::vector<double> masses;
  std::vector<Vec3> positions, normals;
  const auto own_masses = edges_file.get<double>("masses");
  const auto own_points = points_file.get<Vec3>("points");
  Offset first = 0;
  for (Index i = 0; i < around.begin; ++i) first += vertices.local[i] >= 0;
  for (Index i = around.begin; i < around.end; ++i) {
    if (vertices.local[i] < 0) continue;
    masses.push_back(own_masses[i - around.begin]);
    positions.push_back(own_points[i - around.begin]);
    normals.push_back(around.planes.normals[i]);
  }
  const auto count = static_cast<Offset>(masses.size());
  const Offset begin = g.row_begin[first], end = g.row_begin[first + count];
  std::vector<Offset> row_begin;
  for (Offset i = first; i <= first + count; ++i) row_begin.push_back(g.row_begin[i] - begin);
  std::vector<Index> neighbors;
  for (Offset e = begin; e < end; ++e) neighbors.push_back(vertices.vertex[g.neighbors[e]]);
  const Rows rows = rows_of(points_file, part(vertices.local, around.begin, around.end));
  const std::vector<std::uint64_t> identity = folder.manifest().identity(tile);
  folder.write(kind::graph, tile,
               {array("identity", identity), array("row_begin", row_begin), array("neighbors", neighbors),
                array("weights", part(g.weights, begin, end)), array("logs", part(g.logs, begin, end, 2)),
                array("transports", part(g.transports, begin, end, width)), array("masses", masses),
                array("positions", positions), array("normals", normals),
                array("component", part(vertices.component, first, first + count)), array("point_rows", rows.begin),
                array("rows", rows.rows), array("removed", rows.removed)});
}

/// Computes the mean edge lengths of the graph and of its components. Sums in the order of the whole graph.
void finish_graph(TileFolder& folder) {
  Manifest& m = folder.manifest();
  double all = 0;
  std::int64_t edges = 0;
  std::vector<Vec3> middles;
  std::vector<double> sums(static_cast<std::size_t>(m.components), 0.0);
  std::vector<std::int64_t> counts(sums.size(), 0);
  for (std::size_t t = 0; t < folder.tiles(); ++t) {
    const ArrayFile file = folder.open(kind::graph, t);
    const auto row_begin = file.get<Offset>("row_begin");
    const auto logs = file.get<double>("logs");
    const auto component = file.get<Index>("component");
    for (std::size_t i = 0; i < component.size(); ++i)
      for (Offset e = row_begin[i]; e < row_begin[i + 1]; ++e) {
        const double l = length(logs.subspan(static_cast<std::size_t>(2 * e), 2));
        all += l;
        sums[component[i]] += l;
        ++counts[component[i]];
      }
    Vec3 sum{0, 0, 0};
    const auto positions = file.get<Vec3>("positions");
    for (const Vec3& p : positions) sum = sum + p;
    middles.push_back(1.0 / std::max<double>(1, static_cast<double>(positions.size())) * sum);
    m.tiles[t].edges = row_begin.back();
    edges += row_begin.back();
  }
  m.mean_edge_length = edges > 0 ? all / static_cast<double>(edges) : 1.0;
  // Distributes the mean over the components as `ComponentScales` does.
  double of_all = 0;
  for (double sum : sums) of_all += sum;
  if (edges > 0) of_all /= static_cast<double>(edges);
  std::vector<double> lengths(sums.size(), m.mean_edge_length);
  for (std::size_t c = 0; c < sums.size() && sums.size() > 1; ++c)
    if (sums[c] > 0) lengths[c] *= sums[c] / static_cast<double>(counts[c]) / of_all;
  write_arrays(folder.path() / "components", "components", {array("edge_lengths", lengths), array("middles", middles)});
  folder.finish(Stage::built);
}

}  // namespace ahm::tiles

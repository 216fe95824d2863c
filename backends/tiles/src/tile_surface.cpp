#include "ahm/tiles/tile_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/tiles/array_file.hpp"
#include "ahm/util/vec.hpp"
#include "clean_points.hpp"
#include "heat/component_scales.hpp"
#include "tile_folder.hpp"

namespace ahm::tiles {
namespace {

/// The rows of each vertex, rows without a vertex, and rows with several vertices, where a mesh was cut.
struct VertexRows {
  std::vector<Index> begin, rows, removed, shared;
};

VertexRows rows_of(const RowMap& map, Index vertices) {
  VertexRows result;
  result.begin.assign(static_cast<std::size_t>(vertices) + 1, 0);
  for (Index r = 0; r < map.row_count(); ++r) {
    const auto at = map.vertices(Row(r));
    if (at.empty()) result.removed.push_back(r);
    if (at.size() > 1) result.shared.push_back(r);
    for (const Vertex vertex : at) ++result.begin[vertex.index + 1];
  }
  for (std::size_t v = 0; v + 1 < result.begin.size(); ++v) result.begin[v + 1] += result.begin[v];
  result.rows.resize(static_cast<std::size_t>(result.begin.back()));
  std::vector<Index> next = result.begin;
  for (Index r = 0; r < map.row_count(); ++r)
    for (const Vertex vertex : map.vertices(Row(r))) result.rows[next[vertex.index]++] = r;
  return result;
}

/// The vertices in the order of the Morton curve.
std::vector<Index> along_curve(const TangentGraph& graph) {
  std::vector<std::pair<Vec3, Index>> places;
  for (Index i = 0; i < graph.size(); ++i) {
    const auto frame = graph.frame(i);
    if (!frame) throw InvalidArgument("the surface has no positions, which tiles require");
    places.emplace_back(frame->origin, i);
  }
  std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) {
    return a.first == b.first ? a.second < b.second : pointcloud::before_on_curve(a.first, b.first);
  });
  std::vector<Index> order;
  for (const auto& [position, vertex] : places) order.push_back(vertex);
  return order;
}

/// The tiles of a surface: the order of its vertices, and their distribution over tiles.
class SurfaceTiling {
 public:
  SurfaceTiling(const Surface& surface, Index tile_points)
      : graph_(surface.graph()), rows_(rows_of(surface.rows(), graph_.size())), order_(along_curve(graph_)) {
    number_.resize(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) number_[order_[i]] = static_cast<Index>(i);
    const ComponentScales scales(graph_);
    std::vector<Index> renamed(scales.edge_length.size(), -1);
    for (const Index vertex : order_) {
      const Index old = scales.components.of_vertex[vertex];
      if (renamed[old] < 0) {
        renamed[old] = static_cast<Index>(edge_lengths_.size());
        edge_lengths_.push_back(scales.edge_length[old]);
      }
      component_.push_back(renamed[old]);
    }
    const auto size = static_cast<std::int64_t>(order_.size());
    const std::int64_t tiles = std::max<std::int64_t>(1, (size + tile_points - 1) / tile_points);
    for (std::int64_t t = 0; t <= tiles; ++t) first_.push_back(static_cast<std::size_t>(t * size / tiles));
  }

  std::size_t tiles() const { return first_.size() - 1; }
  const std::vector<double>& edge_lengths() const { return edge_lengths_; }
  const std::vector<Index>& shared_rows() const { return rows_.shared; }

  /// The arrays of one tile.
  struct Tile {
    std::vector<Offset> row_begin{0};
    std::vector<Index> neighbors, component, point_rows{0}, rows, removed;
    std::vector<double> weights, logs, transports, masses;
    std::vector<Vec3> positions, normals, x_axes, y_axes;

    std::vector<NamedArray> arrays() const {
      return {array("row_begin", row_begin), array("neighbors", neighbors),   array("weights", weights),
              array("logs", logs),           array("transports", transports), array("masses", masses),
              array("positions", positions), array("normals", normals),       array("x_axes", x_axes),
              array("y_axes", y_axes),       array("component", component),   array("point_rows", point_rows),
              array("rows", rows),           array("removed", removed)};
    }
  };
  Tile tile(std::size_t t) const {
    Tile tile;
    if (t == 0) tile.removed = rows_.removed;
    const auto append = [](auto& values, auto more) { values.insert(values.end(), more.begin(), more.end()); };
    for (std::size_t i = first_[t]; i < first_[t + 1]; ++i) {
      const Index vertex = order_[i];
      const Star star = graph_.star(vertex);
      for (const Index j : star.neighbors) tile.neighbors.push_back(number_[j]);
      append(tile.weights, star.weights), append(tile.logs, star.logs), append(tile.transports, star.transports);
      tile.row_begin.push_back(static_cast<Offset>(tile.neighbors.size()));
      tile.masses.push_back(graph_.mass(vertex));
      const Frame frame = *graph_.frame(vertex);
      tile.positions.push_back(frame.origin), tile.normals.push_back(frame.normal);
      tile.x_axes.push_back(frame.x), tile.y_axes.push_back(frame.y);
      tile.component.push_back(component_[i]);
      const auto begin = static_cast<std::size_t>(rows_.begin[vertex]),
                 end = static_cast<std::size_t>(rows_.begin[vertex + 1]);
      append(tile.rows, std::span(rows_.rows).subspan(begin, end - begin));
      tile.point_rows.push_back(static_cast<Index>(tile.rows.size()));
    }
    return tile;
  }

 private:
  const TangentGraph& graph_;
  VertexRows rows_;
  std::vector<Index> order_, number_;  ///< vertex at each position in the order; position of each vertex
  std::vector<Index> component_;       ///< component of the vertex at each position
  std::vector<double> edge_lengths_;   ///< mean edge length of each component
  std::vector<std::size_t> first_;     ///< first position of each tile, and last the number of vertices
};

TileFacts facts_of(const SurfaceTiling::Tile& tile) {
  std::vector<std::uint64_t> hashes;
  for (const NamedArray& one : tile.arrays()) hashes.push_back(checksum(one.bytes));
  const auto vertices = static_cast<Index>(tile.masses.size());
  return {static_cast<std::uint64_t>(vertices), checksum(std::as_bytes(std::span(hashes))), vertices, vertices,
          tile.row_begin.back()};
}

Vec3 middle_of(const std::vector<Vec3>& positions) {
  Vec3 sum{0, 0, 0};
  for (const Vec3& p : positions) sum = sum + p;
  return 1.0 / std::max<double>(1, static_cast<double>(positions.size())) * sum;
}

}  // namespace

Manifest tile_surface(const Surface& surface, const std::string& input, const std::filesystem::path& folder,
                      Index tile_points, const Progress& progress) {
  const TangentGraph& graph = surface.graph();
  check_tile_points(tile_points);
  check_no_tiles(folder);
  const SurfaceTiling cut(surface, tile_points);
  std::filesystem::create_directories(folder);
  Manifest m;
  m.input = input;
  m.options.tile_points = tile_points;
  m.stage = Stage::built;
  m.points = static_cast<std::uint64_t>(surface.rows().row_count());
  m.exponent = std::ilogb(graph.length_unit());
  m.kind = graph.transport_kind();
  m.components = static_cast<Index>(cut.edge_lengths().size());
  m.mean_edge_length = graph.mean_edge_length();
  m.is_surface = true;
  m.is_delaunay = graph.is_delaunay();
  std::vector<Vec3> middles;
  for (std::size_t t = 0; t < cut.tiles(); ++t) {
    const SurfaceTiling::Tile tile = cut.tile(t);
    m.tiles.push_back(facts_of(tile));
    middles.push_back(middle_of(tile.positions));
  }
  for (std::size_t t = 0; t < cut.tiles(); ++t) {  // second pass: each tile contains the identity of the whole graph
    progress.step("cut", static_cast<double>(t) / static_cast<double>(cut.tiles()));
    const SurfaceTiling::Tile tile = cut.tile(t);
    const std::vector<std::uint64_t> identity = m.identity(t);
    std::vector<NamedArray> arrays = tile.arrays();
    arrays.push_back(array("identity", identity));
    write_arrays(Manifest::file(folder, kind::graph, t), kind::graph, arrays);
  }
  write_arrays(
      folder / "components", "components",
      {array("edge_lengths", cut.edge_lengths()), array("middles", middles), array("shared_rows", cut.shared_rows())});
  m.write(folder);
  return m;
}

}  // namespace ahm::tiles

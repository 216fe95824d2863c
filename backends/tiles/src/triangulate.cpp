#include <algorithm>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"
#include "local_delaunay.hpp"
#include "orient.hpp"
#include "surroundings.hpp"
#include "tufted_cover.hpp"

namespace ahm::tiles {
namespace {

pointcloud::Neighborhoods read_neighborhoods(const TileFolder& folder, std::size_t tile) {
  const ArrayFile file = folder.open(kind::neighbors, tile);
  pointcloud::Neighborhoods near;
  const auto take = [&]<class T, class Allocator>(std::vector<T, Allocator>& into, std::string_view name) {
    const auto values = file.get<T>(name);
    into.assign(values.begin(), values.end());
  };
  take(near.begin, "begin");
  take(near.indices, "indices");
  take(near.radius, "radius");
  near.k = file.get<Index>("k")[0];
  return near;
}

}  // namespace

/// Writes the triangles at points whose stars are complete, and the edge lengths of those whose first corner is in the tile.
void triangulate(TileFolder& folder, std::size_t tile) {
  const AroundFile around(folder, tile);
  const pointcloud::Neighborhoods near = read_neighborhoods(folder, tile);
  pointcloud::CloudDetails details;
  std::vector<Triangle> triangles =
      local_delaunay(around.cloud, near, around.planes, 0, folder.manifest().noise, folder.cloud_options(), details);
  std::erase_if(triangles, [&](const Triangle& t) {
    return !around.complete[t[0]] && !around.complete[t[1]] && !around.complete[t[2]];
  });
  std::vector<double> lengths;
  const auto& points = around.cloud.points;
  for (const auto& [a, b, c] : triangles)
    if (around.is_own(a))
      lengths.insert(lengths.end(),
                     {norm(points[b] - points[a]), norm(points[c] - points[b]), norm(points[a] - points[c])});
  folder.write(kind::lengths, tile, {array("lengths", lengths)});
  folder.write(kind::triangles, tile, {array("triangles", triangles)});
}

/// Computes the mollification of the whole cloud. Sums in the order of the whole cloud, each edge twice, for both layers of the tufted
/// cover.
void find_mollification(TileFolder& folder) {
  double sum = 0;
  std::int64_t count = 0;
  for (std::size_t t = 0; t < folder.tiles(); ++t) {
    const ArrayFile file = folder.open(kind::lengths, t);
    const auto l = file.get<double>("lengths");
    for (std::size_t f = 0; f < l.size(); f += 3)
      for (double length : {l[f], l[f + 1], l[f + 2], l[f + 2], l[f + 1], l[f]}) sum += length;
    count += 2 * static_cast<std::int64_t>(l.size());
  }
  if (count == 0)
    throw InvalidGeometry(
        "the local triangulations of the cloud have no triangle: the points lie on a line, or are too far apart");
  double& epsilon = folder.manifest().mollification;
  epsilon = 0;
  for (std::size_t t = 0; t < folder.tiles(); ++t) {
    const ArrayFile file = folder.open(kind::lengths, t);
    const auto l = file.get<double>("lengths");
    for (std::size_t f = 0; f < l.size(); f += 3)
      epsilon =
          std::max(epsilon, pointcloud::mollification_of(l[f], l[f + 1], l[f + 2], sum / static_cast<double>(count)));
  }
  folder.finish(Stage::triangulated);
}

/// Computes the weights of the edges at the points of a tile, and the masses of the points.
void weigh_edges(TileFolder& folder, std::size_t tile) {
  const AroundFile around(folder, tile);
  const ArrayFile file = folder.open(kind::triangles, tile);
  const auto view = file.get<Triangle>("triangles");
  const std::vector<Triangle> triangles(view.begin(), view.end());
  pointcloud::CloudDetails details;
  pointcloud::CoverPart part{folder.manifest().mollification, around.complete, {}};
  pointcloud::WeightedEdges edges;
  if (triangles.empty()) {
    edges.masses.assign(around.cloud.points.size(), 0.0);
  } else {
    edges = tufted_laplacian(around.cloud, around.planes, triangles, part, details);
    if (details.flips_stopped)
      throw InvalidGeometry("tile " + std::to_string(tile) + ": the edge flips of its triangulation did not finish");
    if (std::count(part.certain.begin() + around.begin, part.certain.begin() + around.end, 0) > 0)
      throw InvalidGeometry("tile " + std::to_string(tile) +
                            ": edge flips extend from its border to its points; plan larger tiles");
  }
  std::vector<Index> tails, heads;
  std::vector<double> weights;
  for (std::size_t e = 0; e < edges.tails.size(); ++e) {
    if (!around.is_own(edges.tails[e]) && !around.is_own(edges.heads[e])) continue;
    tails.push_back(edges.tails[e]);
    heads.push_back(edges.heads[e]);
    weights.push_back(edges.weights[e]);
  }
  const std::span own(edges.masses.data() + around.begin, static_cast<std::size_t>(around.end - around.begin));
  const TileTrees trees = tile_trees(around, tails, heads);
  folder.write(kind::edges, tile,
               {array("tails", tails), array("heads", heads), array("weights", weights),
                array("masses", std::span<const double>(own)), array("root", trees.root), array("sign", trees.sign),
                array("joints", trees.joints), array("terminals", trees.terminals)});
}

}  // namespace ahm::tiles

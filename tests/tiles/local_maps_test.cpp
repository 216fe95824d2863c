// Local maps tile by tile are those of the whole graph.
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "ahm/error.hpp"
#include "ahm/tiles/tiled_local_maps.hpp"
#include "support/expect_error.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using tiles::ArrayFile;
using tiles::Manifest;
using tiles::TiledGraph;

/// Tiles of small maps and those of the whole graph differ by at most `tolerance` radii.
void expect_same_maps(const TiledCloud& cloud, double radius, Variant variant, double tolerance) {
  const auto folder = cloud.folder.directory() / "local";
  std::filesystem::remove_all(folder);
  const TiledGraph graph(cloud.tiles, 1 << 30);
  LocalMapOptions options{.radius = radius, .bound_by_straight_line = true};
  options.heat.variant = variant;
  const auto surface = pointcloud::PointCloudSurface::build(cloud.points, {}, {.parts_apart = false});
  const LocalMaps expected = local_maps(surface.graph(), options);
  const auto row = [&](const LocalMaps& maps, Index s) {
    std::map<Index, std::array<double, 5>> entries;
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e)
      entries[maps.neighbors[e].index] = {maps.logs[2 * e], maps.logs[2 * e + 1], maps.distances[e],
                                          radius * maps.transports[2 * e], radius * maps.transports[2 * e + 1]};
    return entries;
  };
  Index compared = 0;
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    ASSERT_TRUE(write_local_maps(graph, t, folder, {.maps = options}));
    const ArrayFile file(Manifest::file(folder, "local", t), "local");
    LocalMaps maps;
    const auto take = [&]<class T>(std::vector<T>& into, const char* name) {
      const auto values = file.get<T>(name);
      into.assign(values.begin(), values.end());
    };
    take(maps.indptr, "indptr"), take(maps.neighbors, "neighbors"), take(maps.logs, "logs");
    take(maps.distances, "distances"), take(maps.transports, "transports");
    for (Index s = 0; s < maps.sources(); ++s) {
      const auto found = row(maps, s), wanted = row(expected, graph.first_vertex(t) + s);
      for (const auto& [vertex, values] : wanted) {
        const auto at = found.find(vertex);
        if (at == found.end()) {  // only at the rim
          ASSERT_GT(values[2], radius * (1 - tolerance));
          continue;
        }
        for (std::size_t c = 0; c < values.size(); ++c) ASSERT_NEAR(values[c], at->second[c], radius * tolerance);
        ++compared;
      }
      ASSERT_LE(found.size(), wanted.size() + 3);
    }
  }
  EXPECT_GT(compared, 20 * graph.size());
}

TEST(TiledLocalMaps, AreThoseOfTheWholeGraphWhereItIsFlat) {
  std::vector<Vec3> points = hills(70);
  for (Vec3& p : points) p[2] = 0;
  const TiledCloud cloud(points, {.tile_points = 1000});
  cloud.build();
  expect_same_maps(cloud, 4, Variant::adaptive, 1e-9);
  expect_same_maps(cloud, 4, Variant::localized, 1e-9);
}

TEST(TiledLocalMaps, AreThoseOfTheWholeGraphToTheMargin) {
  std::vector<Vec3> points = hills(60);
  for (const Vec3& p : hills(30, 3))
    points.push_back({300 + 2 * p[0], 2 * p[1], p[2]});  // a component of another scale
  const TiledCloud cloud(points, {.tile_points = 1000});
  cloud.build();
  expect_same_maps(cloud, 5, Variant::adaptive, 1e-3);
}

TEST(TiledLocalMaps, AreMadeOnce) {
  const TiledCloud cloud(hills(40), {.tile_points = 1000});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto folder = cloud.folder.directory() / "local";
  EXPECT_TRUE(write_local_maps(graph, 0, folder, {.maps = {.radius = 2}}));
  EXPECT_FALSE(write_local_maps(graph, 0, folder, {.maps = {.radius = 2}}));
  expect_error<InvalidArgument>([&] { write_local_maps(graph, 0, folder, {.maps = {.radius = 3}}); }, "other options");
  expect_error<InvalidArgument>([&] { write_local_maps(graph, 99, folder, {.maps = {.radius = 2}}); }, "tile 99");
  expect_error<InvalidArgument>([&] { write_local_maps(graph, 0, folder, {}); }, "radius");
}

}  // namespace
}  // namespace ahm::test

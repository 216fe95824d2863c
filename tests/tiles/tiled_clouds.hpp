/// \file
/// Clouds, their tiles on disk, and their graphs and maps.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ahm/conformance/clouds.hpp"
#include "ahm/error.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/tiles/build_tiles.hpp"
#include "ahm/tiles/tiled_graph.hpp"
#include "ahm/tiles/tiled_local_maps.hpp"
#include "ahm/tiles/tiled_log_map.hpp"
#include "files.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace ahm::test {

using tiles::ArrayFile;
using tiles::Manifest;
using tiles::TiledGraph;

constexpr double everything = std::numeric_limits<double>::infinity();

/// A grid of spacing 1 in the plane z = 0, each point shifted by at most `jitter` along x and y.
inline std::vector<Vec3> jittered_grid(Index rows, Index columns, unsigned seed, double jitter = 0.3) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  std::vector<Vec3> points;
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < columns; ++j) {
      const double x = i + shift(random), y = j + shift(random);
      points.push_back({x, y, 0});
    }
  return points;
}

inline std::vector<Vec3> hills(Index side, unsigned seed = 1, double jitter = 0.3) {
  std::vector<Vec3> points = jittered_grid(side, side, seed, jitter);
  for (Vec3& p : points) p[2] = 6 * std::sin(p[0] / 17) * std::cos(p[1] / 23);
  return points;
}

/// Two components.
inline std::vector<Vec3> two_hills(Index side, Index other_side) {
  std::vector<Vec3> points = hills(side);
  for (const Vec3& p : hills(other_side, 2)) points.push_back({400 + p[0], p[1], p[2]});
  return points;
}

/// A cloud in a file, and the plan of its tiles.
struct PlannedCloud {
  explicit PlannedCloud(std::vector<Vec3> cloud, const tiles::TileOptions& options = {.tile_points = 2500})
      : points(std::move(cloud)) {
    write_points(input, points);
    tiles::plan_tiles(input, tiles, options);
  }
  void build() const { tiles::build_tiles(tiles, {}); }
  TiledGraph graph(std::size_t memory = 1 << 30) const { return TiledGraph(tiles, memory); }
  path file(const std::string& name) const { return folder.directory() / name; }
  path tile(std::string_view kind, std::size_t number) const { return Manifest::file(tiles, kind, number); }
  /// The surface of the points in memory.
  pointcloud::PointCloudSurface surface(pointcloud::CloudOptions options = {}) const {
    options.parts_apart = false;
    return pointcloud::PointCloudSurface::build(points, {}, options);
  }

  TemporaryFolder folder;
  std::vector<Vec3> points;
  path input = file("points.ply"), tiles = file("tiles");
};

/// A cloud whose tiles are built.
struct TiledCloud : PlannedCloud {
  explicit TiledCloud(std::vector<Vec3> cloud, const tiles::TileOptions& options = {.tile_points = 2500})
      : PlannedCloud(std::move(cloud), options) {
    build();
  }
  /// A row of tile 0. A map from it loads other tiles only when its front reaches them.
  Row first_row() const { return Row(graph().rows(0).rows[0]); }
};

/// A strip of many bands along x, and another component.
struct Strip : TiledCloud {
  Strip() : TiledCloud(strip_points(), {.tile_points = 400}) {}
  /// The file of a tile that the front from `first_row` reaches late.
  path far_tile() const {
    const TiledGraph tiled = graph();
    EXPECT_LT(tiled.frame(0)->origin[0], 100);
    return tile("graph", tiled.tile_of(tiled.nearest_vertex({300, 5, 0}).index));
  }

 private:
  static std::vector<Vec3> strip_points() {
    std::vector<Vec3> points = jittered_grid(400, 12, 9);
    for (Vec3& p : points) p[2] = 4 * std::sin(p[0] / 17);
    for (const Vec3& p : hills(15, 2)) points.push_back({p[0], 100 + p[1], p[2]});
    return points;
  }
};

inline ArrayFile local_file(const path& folder, std::size_t tile) {
  return ArrayFile(Manifest::file(folder, "local", tile), "local");
}

inline ArrayFile map_file(const path& folder, std::size_t tile) {
  return ArrayFile(Manifest::file(folder, "map", tile), "map");
}

/// The arrays of a map, tile after tile. Maps without coordinates have no spread.
struct MapArrays {
  MapArrays(const TiledGraph& graph, const path& folder, bool has_coordinates = true) {
    const auto append = [](auto& values, const auto& more) { values.insert(values.end(), more.begin(), more.end()); };
    for (std::size_t t = 0; t < graph.tiles(); ++t) {
      const ArrayFile file = map_file(folder, t);
      if (has_coordinates) append(coordinates, file.get<double>("coordinates"));
      if (has_coordinates) append(spread, file.get<double>("spread"));
      append(distance, file.get<double>("distance"));
      for (std::uint8_t s : file.get<std::uint8_t>("status")) status.push_back(static_cast<Status>(s));
    }
  }
  std::vector<double> coordinates, distance, spread;
  std::vector<Status> status;
};

template <class T>
bool same_bits(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

/// Compares stars, masses, frames and rows of all vertices, bit by bit.
inline void expect_same_graph(const tiles::TiledGraph& tiled, const pointcloud::PointCloudSurface& surface) {
  const CsrGraph& graph = surface.graph();
  ASSERT_EQ(tiled.size(), graph.size());
  EXPECT_EQ(tiled.edge_count(), graph.edge_count());
  EXPECT_EQ(tiled.transport_kind(), graph.transport_kind());
  EXPECT_EQ(tiled.mean_edge_length(), graph.mean_edge_length());
  EXPECT_EQ(tiled.length_unit(), graph.length_unit());
  EXPECT_EQ(tiled.manifest().components, surface.details().components);
  EXPECT_EQ(tiled.manifest().reflections, surface.details().reflections);
  Index different = 0;
  for (Index i = 0; i < graph.size() && different < 5; ++i) {
    const Star expected = graph.star(i), star = tiled.star(i);
    const Frame frame = *graph.frame(i), found = *tiled.frame(i);
    const bool same = same_bits(star.neighbors, expected.neighbors) && same_bits(star.weights, expected.weights) &&
                      same_bits(star.logs, expected.logs) && same_bits(star.transports, expected.transports) &&
                      tiled.mass(i) == graph.mass(i) && found.origin == frame.origin && found.normal == frame.normal &&
                      found.x == frame.x && found.y == frame.y;
    EXPECT_TRUE(same) << "vertex " << i << ", tile " << tiled.tile_of(i);
    different += !same;
  }
  for (std::size_t t = 0; t < tiled.tiles(); ++t) {
    const auto rows = tiled.rows(t);
    for (Index i = 0; i + 1 < static_cast<Index>(rows.begin.size()); ++i)
      for (Index r = rows.begin[i]; r < rows.begin[i + 1]; ++r)
        ASSERT_EQ(surface.rows().vertex(Row(rows.rows[r])), Vertex(tiled.first_vertex(t) + i));
    for (Index row : rows.removed) ASSERT_FALSE(surface.rows().vertex(Row(row)).has_value());
  }
}

}  // namespace ahm::test

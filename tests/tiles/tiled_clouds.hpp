/// \file
/// Clouds on disk and in memory, and whether their graphs are the same.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "ahm/conformance/clouds.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/tiles/build_tiles.hpp"
#include "ahm/tiles/tiled_graph.hpp"
#include "support/temporary_folder.hpp"

namespace ahm::test {

/// Points as a binary PLY file, doubles.
inline void write_points(const std::filesystem::path& path, const std::vector<Vec3>& points) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << points.size()
       << "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  file.write(reinterpret_cast<const char*>(points.data()), static_cast<std::streamsize>(points.size() * sizeof(Vec3)));
}

/// A jittered grid over hills, `side` points a side, 1 apart.
inline std::vector<Vec3> hills(Index side, unsigned seed = 1, double jitter = 0.3) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  std::vector<Vec3> points;
  for (Index i = 0; i < side; ++i)
    for (Index j = 0; j < side; ++j) {
      const double x = i + shift(random), y = j + shift(random);
      points.push_back({x, y, 6 * std::sin(x / 17) * std::cos(y / 23)});
    }
  return points;
}

/// Two surfaces, so that something is disconnected.
inline std::vector<Vec3> two_hills(Index side, Index other_side) {
  std::vector<Vec3> points = hills(side);
  for (const Vec3& p : hills(other_side, 2)) points.push_back({400 + p[0], p[1], p[2]});
  return points;
}

/// A long strip, for many bands, and something else.
inline std::vector<Vec3> strip() {
  std::vector<Vec3> points;
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  for (Index i = 0; i < 400; ++i)
    for (Index j = 0; j < 12; ++j) {
      const double x = i + shift(random), y = j + shift(random);
      points.push_back({x, y, 4 * std::sin(x / 17)});
    }
  for (const Vec3& p : hills(15, 2)) points.push_back({p[0], 100 + p[1], p[2]});
  return points;
}

/// Names and bytes of all files in a folder.
inline std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> result;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    result[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return result;
}

/// A cloud of which tiles are built.
struct TiledCloud {
  explicit TiledCloud(std::vector<Vec3> given, tiles::TileOptions options = {.tile_points = 2500})
      : points(std::move(given)) {
    write_points(input, points);
    tiles::plan_tiles(input, tiles, options);
  }
  void build() const { tiles::build_tiles(tiles, {}); }

  TemporaryFolder folder;
  std::vector<Vec3> points;
  std::filesystem::path input = folder.directory() / "points.ply", tiles = folder.directory() / "tiles";
};

template <class T>
bool same_bits(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

/// Every vertex with its star, mass, frame and component's edge length, to the bit; and the rows at it.
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

/// \file
/// A tile with its surroundings and tangent planes.
#pragma once

#include <vector>

#include "clean_points.hpp"
#include "tangent_planes.hpp"
#include "tile_folder.hpp"

namespace ahm::tiles {

/// Bounding box of some points.
struct Box {
  Vec3 low, high;
};

/// The bounding boxes of each 256 consecutive points.
std::vector<Box> boxes_of(std::span<const Vec3> placed);

/// The points within some distance of a tile's own points, in the order of the whole cloud.
struct Surroundings {
  pointcloud::CleanPoints cloud;  ///< only `points` and `unit` are set
  std::vector<Index> numbers;     ///< numbers of the points in the whole cloud
  std::vector<double> covered;    ///< radius around each point within which no point of the cloud is missing
  Index begin = 0, end = 0;       ///< range of the tile's own points
  bool whole = false;             ///< these are all points of the cloud
};

/// Collects the points within `width` of a tile. @throws ResourceExhausted (more than `BuildOptions::memory`)
Surroundings gather(const TileFolder& folder, std::size_t tile, double width);

/// A neighbor search that records the neighbors it found, and the points whose neighbors may differ in the whole cloud.
class WatchedSearch final : public pointcloud::NeighborSearch {
 public:
  explicit WatchedSearch(const Surroundings& around);
  Index nearest(const Vec3& query, std::span<Index> indices, std::span<double> squared_distances) const override;

  /// For each point: whether its star of triangles is complete. All points that may form a triangle with it are here, and do not
  /// depend on points outside.
  std::vector<char> complete(const pointcloud::Neighborhoods& neighborhoods, double max_edge_ratio) const;

 private:
  std::vector<char> spread(const std::vector<char>& marks, const pointcloud::Neighborhoods& neighborhoods) const;

  const Surroundings& around_;
  std::unique_ptr<pointcloud::NeighborSearch> search_;
  mutable std::vector<char> uncertain_;            ///< whether the neighbors of each point may differ
  mutable std::vector<std::vector<Index>> found_;  ///< neighbors that the first search from each point found
};

/// The file of a tile with its surroundings and tangent planes.
struct AroundFile {
  explicit AroundFile(const TileFolder& folder, std::size_t tile) {
    const ArrayFile file = folder.open(kind::surroundings, tile);
    const auto take = [&]<class T>(std::vector<T>& into, std::string_view name) {
      const auto values = file.get<T>(name);
      into.assign(values.begin(), values.end());
    };
    take(cloud.points, "points");
    cloud.unit = folder.placement().unit();
    take(planes.normals, "normals");
    take(numbers, "numbers");
    take(complete, "complete");
    begin = file.get<Index>("own")[0];
    end = file.get<Index>("own")[1];
  }
  static void write(const TileFolder& folder, std::size_t tile, const Surroundings& around,
                    const pointcloud::TangentPlanes& planes, const std::vector<char>& complete) {
    const std::vector<Index> own{around.begin, around.end};
    folder.write(kind::surroundings, tile,
                 {array("points", around.cloud.points), array("normals", planes.normals),
                  array("numbers", around.numbers), array("complete", complete), array("own", own)});
  }

  bool is_own(Index i) const { return i >= begin && i < end; }

  pointcloud::CleanPoints cloud;
  pointcloud::TangentPlanes planes;
  std::vector<Index> numbers;
  std::vector<char> complete;
  Index begin = 0, end = 0;
};

}  // namespace ahm::tiles

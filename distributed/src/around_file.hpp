/// \file
/// A tile with its surroundings and planes, as the steps after the first hand it on.
#pragma once

#include <vector>

#include "surroundings.hpp"
#include "tangent_planes.hpp"

namespace ahm::distributed {

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

}  // namespace ahm::distributed

/// \file
/// A map over tiles as arrays.
#pragma once

#include <filesystem>
#include <vector>

#include "ahm/tiles/tiled_log_map.hpp"

namespace ahm::test {

/// All of a map's tiles, one after the other.
struct MapRows {
  MapRows(const tiles::TiledGraph& graph, const std::filesystem::path& folder) {
    for (std::size_t t = 0; t < graph.tiles(); ++t) {
      const tiles::ArrayFile file(tiles::Manifest::file(folder, "map", t), "map");
      for (double x : file.get<double>("coordinates")) coordinates.push_back(x);
      for (double x : file.get<double>("distance")) distance.push_back(x);
      for (double x : file.get<double>("spread")) spread.push_back(x);
      for (std::uint8_t s : file.get<std::uint8_t>("status")) status.push_back(static_cast<Status>(s));
    }
  }
  std::vector<double> coordinates, distance, spread;
  std::vector<Status> status;
};

}  // namespace ahm::test

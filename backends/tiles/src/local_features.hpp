/// \file
/// What is kept of the map around each vertex of a tile, instead of the map.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/maps/local_maps.hpp"
#include "ahm/tiles/array_file.hpp"
#include "ahm/tiles/tiled_graph.hpp"

namespace ahm::tiles {

/// Of the files of local maps.
inline constexpr std::string_view local_kind = "local";

/// The map around a vertex, nearest first, hence itself.
struct VertexMap {
  std::span<const Vertex> neighbors;  ///< places among the vertices of the region
  std::span<const double> logs, weights;
};

/// One of the names of `TiledLocalMapOptions::features`, or all of the same kind.
class LocalFeature {
 public:
  virtual ~LocalFeature() = default;
  /// Of what a tile is told beside the graph.
  virtual std::uint64_t identity(std::size_t) const { return 0; }
  /// @param region  vertices of the whole graph, ascending
  virtual void enter(std::span<const Index> region) = 0;
  virtual void add(const VertexMap& map) = 0;
  /// Views of what was added since `enter`.
  virtual void put(std::vector<NamedArray>& arrays) const = 0;
};

using LocalFeatures = std::vector<std::unique_ptr<LocalFeature>>;

/// @param graph   must outlive them
/// @param radius  of the maps
/// @throws InvalidArgument (a name that is none, or comes twice; a column that is not of this input), IoError
LocalFeatures local_features(const std::vector<std::string>& names, const TiledGraph& graph, double radius);

}  // namespace ahm::tiles

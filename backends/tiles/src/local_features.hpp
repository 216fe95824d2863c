/// \file
/// Features of local maps, which are written instead of the maps.
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

/// Kind of the files of local maps.
inline constexpr std::string_view local_kind = "local";

/// The map around a vertex, nearest vertices first; the first one is the vertex itself.
struct VertexMap {
  std::span<const Vertex> neighbors;  ///< indices into the vertices of the region
  std::span<const double> logs, weights;
};

/// One feature of `TiledLocalMapOptions::features`, or all features of one kind.
class LocalFeature {
 public:
  virtual ~LocalFeature() = default;
  /// Checksum of the input of a tile other than the graph.
  virtual std::uint64_t identity(std::size_t) const { return 0; }
  /// Starts a region and discards earlier results. @param region  vertices of the whole graph, ascending
  virtual void enter(std::span<const Index> region) = 0;
  /// Computes the feature of one map.
  virtual void add(const VertexMap& map) = 0;
  /// Appends views of the features computed since `enter`.
  virtual void append_to(std::vector<NamedArray>& arrays) const = 0;
};

using LocalFeatures = std::vector<std::unique_ptr<LocalFeature>>;

/// The features with these names.
/// @param graph   must outlive them
/// @param radius  radius of the maps, world units
/// @throws InvalidArgument (an unknown or repeated name; a column of another input), IoError
LocalFeatures local_features(const std::vector<std::string>& names, const TiledGraph& graph, double radius);

}  // namespace ahm::tiles

/// \file
/// Builds a `LogMap` from the values of a solve: status, coordinates, distances and spread of each vertex.
#pragma once

#include <span>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "maps/march.hpp"

namespace ahm {

class AffineHeat;

/// Options of a map after the solver's options have replaced missing values.
struct MapSettings {
  Variant variant;
  double radius;
  bool frames, spread, distances;
  Progress progress;

  /// @throws InvalidArgument (radius)
  MapSettings(const MapOptions& map, const HeatOptions& options);
  /// What a march must compute. Within a radius it needs distances, because they determine where it ends.
  MarchGoal goal() const;
};

/// The results of a wavefront for each vertex. All are empty if the distances are computed by heat.
struct FrontDistances final : KnownDistances {
  std::vector<double> distances;         ///< world units
  std::vector<double> directions;        ///< 2 per vertex; only on Delaunay triangulations, and if the map has a spread
  std::vector<double> direction_errors;  ///< expected errors of the directions, radians
  std::vector<Index> nearest;            ///< number of the nearest sample of a curve; empty for points

  double of(Index vertex) const override { return distances[vertex]; }
};

/// Builds the maps of one graph.
class MapBuilder {
 public:
  /// @param component  connected component of each vertex; it and the graph must outlive the builder
  MapBuilder(const TangentGraph& graph, std::span<const Index> component) : graph_(graph), component_(component) {}

  /// The map of source number s of a global solve.
  LogMap build(const AffineHeat& heat, std::size_t s, const Source& source, const FrontDistances& front,
               const MapSettings& map, unsigned threads) const;
  /// The map of a march.
  LogMap build(const March& march, const Source& source, const FrontDistances& front, const MapSettings& map,
               unsigned threads) const;

 private:
  template <class Values>
  LogMap build(const Values& values, Strategy strategy, const MarchStatistics& march, const Source& source,
               const FrontDistances& front, const MapSettings& map, unsigned threads) const;

  const TangentGraph& graph_;
  std::span<const Index> component_;
};

}  // namespace ahm

/// \file
/// A log map on the rows of the input.
#pragma once

#include <span>
#include <vector>

#include "ahm/maps/log_map.hpp"
#include "input/backend.hpp"

namespace ahm::app {

/// One row per input vertex, in input order. NaN where the status is not ok.
struct MapRows {
  std::vector<double> u, v, distance, angle;
  std::vector<double> quality;         ///< `map_quality`
  std::vector<double> error_estimate;  ///< of --order 2, else empty
  std::vector<Status> status;          ///< `removed` for rows without a vertex
  std::vector<Index> vertex;           ///< of the graph that the numbers are from; -1: none
};

/// Of several vertices of a row, the one nearest to the source counts.
/// @param map  with frames, of the model's graph
MapRows rows_of(const LogMap& map, const Model& model, std::size_t rows);

/// Unit vectors in space that point away from the source along the surface, one per row: the map's own direction, carried
/// to the vertex. Zero at the source, NaN where the status is not ok.
/// @param map  with frames
std::vector<Vec3> gradients(const LogMap& map, const Model& model, const MapRows& rows);

}  // namespace ahm::app

/// \file
/// Log maps in geodesic polar coordinates, computed by a front on any graph of dimension 2 [MR12].
///
/// \code
/// ahm::Wavefront front(graph, nullptr, true);               // with directions
/// front.add(source);
/// front.run();
/// ahm::LogMap map = ahm::polar_map(front, source);
/// \endcode
#pragma once

#include <limits>

#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/progress.hpp"

namespace ahm {

struct PolarMapOptions {
  /// Vertices farther than this get `Status::beyond_radius`, and the front ends there. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  bool frames = false;  ///< fill `LogMap::frames`
  Progress progress = {};
};

/// Converts the result of a front to a log map: phi_i = distance times direction, `LogMap::method` is polar. The spread of a vertex is
/// half of the largest excess of an edge's length in the map over its length. It is large at the cut locus, as for exact maps.
/// @param source  the only source of the front; not a curve. If it has several points, the nearest one defines the coordinates
///                (`LogMap::nearest`)
/// @throws InvalidArgument (a front without directions, a curve, radius)
LogMap polar_map(const Wavefront& front, const Source& source, const PolarMapOptions& options = {});

}  // namespace ahm

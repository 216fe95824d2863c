/// \file
/// A log map in geodesic polar coordinates, from a front on any graph of dimension 2 [MR12].
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

/// The polar coordinates that a front has found: phi_i = distance times direction, `LogMap::method` is polar. Its spread is half
/// of what the longest edge of a vertex has too much in the map: large at the cut locus, as of exact maps.
/// @param source  the only one of the front; no curve. Of several points the nearest counts (`LogMap::nearest`)
/// @throws InvalidArgument (a front without directions, a curve, radius)
LogMap polar_map(const Wavefront& front, const Source& source, const PolarMapOptions& options = {});

}  // namespace ahm

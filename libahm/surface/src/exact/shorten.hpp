/// \file
/// Shortening what runs in strips.
#pragma once

#include "ahm/surface/exact/geodesic_path.hpp"
#include "strip.hpp"

namespace ahm::exact {

/// Angles at a vertex below pi by less than this are pi.
inline constexpr double straight_margin = 1e-9;

/// Moves the strip to the other side of vertices until the taut line in it is locally shortest.
/// @return that line
TautLine shorten(const PolyhedralSurface& surface, Strip& strip);

/// The half-edge whose face was entered last at a bend, as the corner of that face at the vertex.
Half corner_after(const Strip& strip, const TautLine& line, const Bend& bend, std::size_t portal);

/// The line as points of the surface.
GeodesicPath path_along(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line);

}  // namespace ahm::exact

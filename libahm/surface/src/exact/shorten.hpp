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

/// Takes the strip of a locally shortest line past vertices to their other side where the line is shorter there, until
/// there is none: a line that passes an interior vertex has a second one of its kind beyond it where both sides see its
/// ends at less than pi.
/// @return the line; as short as the one given at least
TautLine pass_other_side(const PolyhedralSurface& surface, Strip& strip, TautLine line);

/// The half-edges that lead around the other side of a bend; none where the boundary is there.
std::optional<std::vector<Half>> other_side(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line,
                                            const Bend& bend);

/// The half-edge whose face was entered last at a bend, as the corner of that face at the vertex.
Half corner_after(const Strip& strip, const TautLine& line, const Bend& bend, std::size_t portal);

/// The line as points of the surface.
GeodesicPath path_along(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line);

}  // namespace ahm::exact

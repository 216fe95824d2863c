/// \file
/// The points of a surface that its graph has, and triangles between them: what a picture of a cloud shows.
///
/// \code
/// scene.points = mapped = ahm::mapped_positions(surface);   // points that are not finite are left out
/// \endcode
#pragma once

#include <vector>

#include "ahm/surface/surface.hpp"

namespace ahm {

/// Where the graph has the rows: in a cloud with noise the smoothed points. NaN where a row has no vertex: in a cloud that was
/// thinned, all but the points that stand for the others. Drawn beside these, the others would hide them.
/// @return  rows x 3, world units; empty for a surface given by lengths alone
std::vector<Vec3> mapped_positions(const Surface& surface);

/// The triangles of `Surface::flat_approximation` by their rows, where at most one vertex in fifty is in none of them; else none: these
/// points would not be seen. None for a surface with faces.
std::vector<Triangle> mapped_triangles(const Surface& surface);

}  // namespace ahm

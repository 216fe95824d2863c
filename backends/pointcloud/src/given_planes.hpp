/// \file
/// Planes by given normals, where the points bear them out.
#pragma once

#include <span>

#include "tangent_planes.hpp"

namespace ahm::pointcloud {

/// Puts the given planes (zero where there are none) in place of the fitted ones of `planes`, except where the points
/// contradict them: there the fitted plane stays, on the given side. Fills the counts of `planes`.
/// @return for every point, whether neither plane nor side was given
std::vector<char> take_given_planes(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                    std::span<const Vec3> given, unsigned threads, TangentPlanes& planes);

}  // namespace ahm::pointcloud

/// \file
/// Points much nearer to each other than the spacing.
#pragma once

#include <memory>

#include "tangent_planes.hpp"

namespace ahm::pointcloud {

/// Makes one point of points that lie much nearer to each other than the spacing there. Neighborhoods that lose a neighbor get
/// the next one, so that results are those of the cloud without the near duplicates.
/// Clusters of more than half of k points are parts of their own, and not merged.
/// @return the number of points merged into another one
Index merge_near_points(CleanPoints& cloud, std::unique_ptr<NeighborSearch>& search, const CloudOptions& options,
                        Neighborhoods& neighborhoods);

}  // namespace ahm::pointcloud

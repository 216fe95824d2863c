/// \file
/// Merging of points much nearer to each other than the spacing.
#pragma once

#include <memory>

#include "tangent_planes.hpp"

namespace ahm::pointcloud {

/// Merges points that lie much nearer to each other than the spacing there. Neighborhoods that lose a neighbor get the next
/// one, so that results equal those of the cloud without near duplicates. Clusters of more than half of k points are separate
/// parts and are not merged.
/// @return the number of points merged into another one
Index merge_near_points(CleanPoints& cloud, std::unique_ptr<NeighborSearch>& search, const CloudOptions& options,
                        Neighborhoods& neighborhoods);

}  // namespace ahm::pointcloud

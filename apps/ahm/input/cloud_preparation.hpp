/// \file
/// What happens to a cloud before its graph is built: non-finite points, voxel grid, outliers, normals.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// The points that remain.
struct PreparedCloud {
  std::vector<Index> rows;   ///< of the input, ascending
  Index non_finite = 0;      ///< input points dropped
  Index voxel_replaced = 0;  ///< points represented by another one of their voxel
  Index outliers = 0;        ///< points removed as outliers
  Index beyond = 0;          ///< points left out by --local
  double seconds = 0;
};

/// Applies the options that concern the input cloud, in the order non-finite, surroundings, voxel grid, outliers.
/// Rows that the command names (`options.named`, `source`) represent their voxels.
/// @param source  where the map starts: a row is no outlier, or the call is refused
/// @throws InvalidGeometry (non-finite points without --drop-nan; unusable normals), InvalidArgument
PreparedCloud prepare_cloud(const io::Geometry& input, const InputOptions& options,
                            const std::optional<SourceSpec>& source);

}  // namespace ahm::app

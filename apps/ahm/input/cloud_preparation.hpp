/// \file
/// Filters a cloud before its graph is built: non-finite points, surroundings of the source, voxel grid, outliers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// The points that remain, and how many were removed.
struct PreparedCloud {
  std::vector<Index> rows;   ///< rows of the input that remain, ascending
  Index non_finite = 0;      ///< points dropped because they are not finite
  Index voxel_replaced = 0;  ///< points replaced by another point of their voxel
  Index outliers = 0;        ///< points removed as outliers
  Index beyond = 0;          ///< points left out by --local
  double seconds = 0;
};

/// Applies the filters of the options in the order non-finite points, surroundings, voxel grid, outliers. The voxel grid keeps the
/// rows named in the command (`options.named`, `source`).
/// @param source  source of the single map, if there is one
/// @throws InvalidGeometry (non-finite points without --drop-nan), InvalidArgument (no normals; too few points around the source; the
/// source is an outlier; no PCL)
PreparedCloud prepare_cloud(const io::Geometry& input, const InputOptions& options,
                            const std::optional<SourceSpec>& source);

}  // namespace ahm::app

/// \file
/// What the program takes from PCL, loaded when it is first needed.
#pragma once

#include "ahm/pcl/filters.hpp"
#include "ahm/pcl/search.hpp"

namespace ahm::app {

/// What the module pcl offers, under the name ahm_pcl.
struct PclFunctions {
  decltype(&pcl_bridge::voxel_grid) voxel_grid;
  std::vector<Index> (*outlier_removal)(std::span<const Vec3> points);  ///< with its usual numbers
  decltype(&pcl_bridge::kdtree_search) kdtree_search;
};

/// @throws IoError where the module cannot be loaded
const PclFunctions& pcl_functions();

}  // namespace ahm::app

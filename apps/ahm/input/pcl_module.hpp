/// \file
/// What the program takes from PCL, loaded when it is first needed.
#pragma once

#include "ahm/pcl/filters.hpp"
#include "ahm/pcl/search.hpp"

namespace ahm::app {

/// What the module pcl offers, under the name ahm_pcl.
struct PclFunctions {
  decltype(&pcl_bridge::voxel_grid) voxel_grid;
  decltype(&pcl_bridge::outlier_removal) outlier_removal;
  decltype(&pcl_bridge::kdtree_search) kdtree_search;
};

/// @throws Error where the module cannot be loaded
const PclFunctions& pcl_functions();

}  // namespace ahm::app

/// \file
/// The functions of PCL that the program uses, in a module that is loaded when first needed.
#pragma once

#include "ahm/pcl/filters.hpp"
#include "ahm/pcl/search.hpp"

namespace ahm::app {

/// The functions of the module pcl, exported as `ahm_pcl`.
struct PclFunctions {
  decltype(&pcl_bridge::voxel_grid) voxel_grid;
  std::vector<Index> (*outlier_removal)(std::span<const Vec3> points);  ///< with the default parameters
  decltype(&pcl_bridge::kdtree_search) kdtree_search;
};

/// Loads the module if necessary. @throws IoError (the module cannot be loaded)
const PclFunctions& pcl_functions();

}  // namespace ahm::app

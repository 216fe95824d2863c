#include "input/pcl_module.hpp"

extern "C" const ahm::app::PclFunctions ahm_pcl;
const ahm::app::PclFunctions ahm_pcl{ahm::pcl_bridge::voxel_grid, ahm::pcl_bridge::outlier_removal,
                                     ahm::pcl_bridge::kdtree_search};

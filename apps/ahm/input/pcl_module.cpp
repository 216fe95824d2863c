#include "input/pcl_module.hpp"

extern "C" const ahm::app::PclFunctions ahm_pcl;
const ahm::app::PclFunctions ahm_pcl{
    ahm::pcl_bridge::voxel_grid,
    [](std::span<const ahm::Vec3> points) { return ahm::pcl_bridge::outlier_removal(points); },
    ahm::pcl_bridge::kdtree_search};

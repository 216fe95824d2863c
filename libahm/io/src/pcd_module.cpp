#include "pcd_module.hpp"

#include "read/pcl_read_pcd.hpp"

extern "C" const ahm::io::PcdFunctions ahm_pcd;
const ahm::io::PcdFunctions ahm_pcd{ahm::io::read_pcd};

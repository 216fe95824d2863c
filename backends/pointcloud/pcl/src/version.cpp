#include <pcl/pcl_config.h>

#include "ahm/pcl/search.hpp"

namespace ahm::pcl_bridge {

std::string version() { return PCL_VERSION_PRETTY; }

}  // namespace ahm::pcl_bridge

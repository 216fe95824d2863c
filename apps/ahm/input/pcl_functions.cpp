#include "ahm/util/module.hpp"
#include "input/pcl_module.hpp"

namespace ahm::app {

const PclFunctions& pcl_functions() { return module_functions<PclFunctions>("pcl", "this needs ahm's"); }

}  // namespace ahm::app

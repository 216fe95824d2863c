#include "ahm/error.hpp"
#include "ahm/util/module.hpp"
#include "input/pcl_module.hpp"

namespace ahm::app {

const PclFunctions& pcl_functions() {
  static std::string error;
  static const auto* found = static_cast<const PclFunctions*>(module_symbol("pcl", "ahm_pcl", error));
  if (found == nullptr) throw IoError("this needs ahm's module for PCL, which cannot be loaded: " + error);
  return *found;
}

}  // namespace ahm::app

#include "formats/format.hpp"
#ifdef AHM_WITH_PCL
#include "ahm/error.hpp"
#include "ahm/util/module.hpp"
#include "pcd_module.hpp"
#endif

namespace ahm::io {

#ifdef AHM_WITH_PCL
namespace {

const PcdFunctions& functions() {
  static std::string error;
  static const auto* found = static_cast<const PcdFunctions*>(module_symbol("pcd", "ahm_pcd", error));
  if (found == nullptr) throw IoError("PCD files need libahm's module for PCL, which cannot be loaded: " + error);
  return *found;
}

Geometry read(const Input& in) { return functions().read(in); }
void write(AtomicFile& file, const Table& table) { functions().write(file, table); }

}  // namespace

Format pcd_format() { return {.extensions = {".pcd"}, .read = read, .write = write}; }
#else
Format pcd_format() { return {.extensions = {".pcd"}, .missing = "PCL"}; }
#endif

}  // namespace ahm::io

#include "formats/format.hpp"
#include "read/point_stream.hpp"
#ifdef AHM_WITH_PCL
#include "ahm/util/module.hpp"
#include "pcd_module.hpp"
#endif

namespace ahm::io {

#ifdef AHM_WITH_PCL
namespace {

Geometry read(const Input& in) {
  return module_functions<PcdFunctions>("pcd", "PCD files are read by libahm's").read(in);
}

}  // namespace
#endif

Format pcd_format() {
  Format format{.extensions = {".pcd"},
                .signatures = {"# .PCD", "VERSION"},
                .records = pcd_records,
                .take_points = take_pcd_points,
                .write = write_pcd};
#ifdef AHM_WITH_PCL
  format.read = read;
#else
  format.missing = "PCL";
#endif
  return format;
}

}  // namespace ahm::io

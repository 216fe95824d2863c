#include "formats/format.hpp"
#ifdef AHM_WITH_PCL
#include "read/pcl_read_pcd.hpp"
#include "write/pcl_write_pcd.hpp"
#endif

namespace ahm::io {

#ifdef AHM_WITH_PCL
Format pcd_format() { return {.extensions = {".pcd"}, .read = read_pcd, .write = write_pcd}; }
#else
Format pcd_format() { return {.extensions = {".pcd"}, .missing = "PCL"}; }
#endif

}  // namespace ahm::io

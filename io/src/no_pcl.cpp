// Stands in for the PCL sources in a build without PCL.
#include "read/readers.hpp"
#include "write/writers.hpp"

namespace ahm::io {

Geometry read_pcd(const Input& in) {
  fail(in, "this build has no PCL, which reads PCD files; convert it to .ply or .xyz");
}
bool has_pcd() noexcept { return false; }
void write_pcd(AtomicFile&, const Table&) { throw IoError("this build has no PCL, which writes PCD files"); }

}  // namespace ahm::io

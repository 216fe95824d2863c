#include "read/gunzip.hpp"

namespace ahm::io {

bool is_gzip(const Input& in) { return in.bytes.starts_with("\x1f\x8b"); }

void gunzip(Input& in) {
  fail(in, "the file is compressed with gzip and this build has no zlib; unpack it first (gunzip -k " +
               in.path.filename().string() + ")");
}

}  // namespace ahm::io

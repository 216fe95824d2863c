#include "read/gunzip.hpp"

namespace ahm::io {

bool is_gzip(const Input& in) { return in.bytes.starts_with("\x1f\x8b"); }

void gunzip(Input& in) {
  fail(in, "the file is compressed with gzip and this build has no zlib; unpack it first (gunzip -k " +
               in.path.filename().string() + ")");
}

void inflate_block(const Input& in, std::string_view, std::span<char>, const std::string& what) {
  fail(in, what + " is compressed and this build has no zlib; save the file without compression");
}

}  // namespace ahm::io

#include "read/gunzip.hpp"

namespace ahm::io {

bool is_gzip(const Input& in) { return in.bytes.starts_with("\x1f\x8b"); }

class Gunzip::Inflater {};

Gunzip::Gunzip(const Input& in, std::function<std::string_view()>) {
  fail(in, "the file is compressed with gzip and this build has no zlib; unpack it first (gunzip -k " +
               in.path.filename().string() + ")");
}

Gunzip::~Gunzip() = default;

std::size_t Gunzip::read(std::span<char>) { return 0; }

void gunzip(Input& in) { Gunzip(in, {}); }

void inflate_block(const Input& in, std::string_view, std::span<char>, const std::string& what) {
  fail(in, what + " is compressed and this build has no zlib; save the file without compression");
}

}  // namespace ahm::io

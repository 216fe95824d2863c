// Replaces stb.cpp in builds without stb.
#include "ahm/io/image.hpp"

namespace ahm::io {

bool has_images() noexcept { return false; }
Image decode_image(std::string_view, const std::string& name) {
  throw IoError(name + ": this build has no stb, which reads images (Debian: libstb-dev)");
}
Image read_image(const std::filesystem::path& path) { return decode_image({}, path.string()); }
std::string png_bytes(const Image&) {
  throw IoError("this build has no stb, which writes images (Debian: libstb-dev)");
}

}  // namespace ahm::io

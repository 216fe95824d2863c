#include "ahm/io/atomic_file.hpp"
#include "ahm/io/image.hpp"

namespace ahm::io {

void write_png(const std::filesystem::path& path, const Image& image) {
  const std::string bytes = png_bytes(image);
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace ahm::io

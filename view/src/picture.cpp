#include "ahm/view/picture.hpp"

#include "ahm/error.hpp"
#include "ahm/io/formats.hpp"

namespace ahm::view {

void write_picture(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options) {
  const std::string extension = io::lower_extension(path);
  if (extension == ".png") return write_png(path, scene, options);
  if (extension == ".html" || extension == ".htm") return write_html(path, scene, options);
  throw InvalidArgument("path: " + path.string() + " must end with .png or .html");
}

}  // namespace ahm::view

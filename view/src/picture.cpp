#include "ahm/view/picture.hpp"

#include <algorithm>
#include <cctype>

#include "ahm/error.hpp"

namespace ahm::view {

void write_picture(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".png") return write_png(path, scene, options);
  if (extension == ".html" || extension == ".htm") return write_html(path, scene, options);
  throw InvalidArgument("path: " + path.string() + " must end with .png or .html");
}

}  // namespace ahm::view

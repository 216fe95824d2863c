// The only file of io that includes stb_image and stb_image_write.
#include <algorithm>
#include <climits>
#include <fstream>
#include <iterator>
#include <memory>

#include "ahm/io/image.hpp"
#include "ahm/util/text.hpp"

#ifdef AHM_WITH_ZLIB
#include <zlib.h>

#include <cstdlib>

namespace {

/// Compressor for stb; faster and smaller output than stb's own. @return memory to be released by `free`; null on failure
unsigned char* deflate_by_zlib(unsigned char* data, int length, int* size, int) {
  uLongf room = compressBound(static_cast<uLong>(length));
  auto* made = static_cast<unsigned char*>(std::malloc(room));
  if (made == nullptr || room > INT_MAX || compress2(made, &room, data, static_cast<uLong>(length), 5) != Z_OK) {
    std::free(made);
    return nullptr;
  }
  *size = static_cast<int>(room);
  return made;
}

}  // namespace
#define STBIW_ZLIB_COMPRESS deflate_by_zlib
#endif

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#endif
#include <stb_image.h>
#include <stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace ahm::io {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::error_code error;
  if (!file || std::filesystem::is_directory(path, error))
    throw IoError(path.string() + ": cannot be opened; give a PNG or JPEG image");
  return {std::istreambuf_iterator<char>(file), {}};
}

void append(void* context, void* data, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

bool has_images() noexcept { return true; }

Image decode_image(std::string_view bytes, const std::string& name) {
  if (bytes.size() > INT_MAX) throw IoError(name + ": larger than 2 GB; scale the image down");
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()), &width,
                            &height, &channels, 4),
      stbi_image_free);
  if (!pixels) throw IoError(name + ": not a readable PNG or JPEG image (" + stbi_failure_reason() + ")");
  Image image(width, height);
  std::copy_n(pixels.get(), image.rgba.size(), image.rgba.begin());
  return image;
}

Image read_image(const std::filesystem::path& path) { return decode_image(bytes_of(path), path.string()); }

std::string png_bytes(const Image& image) {
  if (image.width < 1 || image.height < 1 ||
      image.rgba.size() != 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    throw InvalidArgument("image: " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                          " pixels do not fit " + detail::counted(image.rgba.size(), "byte"));
  // Fully opaque images are written without the alpha channel: a quarter less data to compress.
  bool opaque = true;
  for (std::size_t k = 3; k < image.rgba.size() && opaque; k += 4) opaque = image.rgba[k] == 255;
  std::vector<std::uint8_t> rgb;
  if (opaque) {
    rgb.reserve(image.rgba.size() / 4 * 3);
    for (std::size_t k = 0; k < image.rgba.size(); k += 4)
      rgb.insert(rgb.end(), {image.rgba[k], image.rgba[k + 1], image.rgba[k + 2]});
  }
  const int channels = opaque ? 3 : 4;
  std::string png;
  if (stbi_write_png_to_func(append, &png, image.width, image.height, channels, opaque ? rgb.data() : image.rgba.data(),
                             channels * image.width) == 0)
    throw ResourceExhausted("out of memory while encoding an image of " + std::to_string(image.width) + " x " +
                            std::to_string(image.height) + " pixels");
  return png;
}

}  // namespace ahm::io

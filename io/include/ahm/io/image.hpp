/// \file
/// Pictures with transparency, as textures.
///
/// \code
/// ahm::io::Image logo = ahm::io::read_image("logo.png");
/// auto [red, green, blue, alpha] = logo.sample(0.5, 0.5);
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ahm/error.hpp"

namespace ahm::io {

/// Pixels, eight bits each of red, green, blue and opacity.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< height x width x 4, the uppermost row first; colours not multiplied by opacity

  Image() = default;
  /// Transparent black.
  Image(int width, int height);

  std::uint8_t* pixel(int column, int row) {
    return rgba.data() + 4 * (static_cast<std::size_t>(row) * width + column);
  }
  const std::uint8_t* pixel(int column, int row) const {
    return rgba.data() + 4 * (static_cast<std::size_t>(row) * width + column);
  }
  /// Colour at (u, v), (0, 0) the lower left corner and (1, 1) the upper right one; bilinear between the middles of the
  /// pixels, colours weighted by opacity, constant outside. Four numbers in [0, 1].
  std::array<double, 4> sample(double u, double v) const;
};

/// Whether this build can read and write images (needs stb).
bool has_images() noexcept;

/// Reads a PNG or JPEG file.
/// @throws IoError naming the file and what is wrong with it
Image read_image(const std::filesystem::path& path);

/// The image as the bytes of a PNG file.
/// @throws InvalidArgument (size and pixels do not fit), IoError (no stb)
std::string png_bytes(const Image& image);

/// @throws as `png_bytes`, IoError
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace ahm::io

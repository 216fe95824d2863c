/// \file
/// Files of images: PNG in and out, JPEG in.
///
/// \code
/// ahm::Image logo = ahm::io::read_image("logo.png");
/// ahm::io::write_png("copy.png", logo);
/// \endcode
#pragma once

#include <filesystem>
#include <string>

#include "ahm/error.hpp"
#include "ahm/image.hpp"

namespace ahm::io {

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

/// \file
/// Image files: reads PNG and JPEG, writes PNG.
///
/// \code
/// ahm::Image logo = ahm::io::read_image("logo.png");
/// ahm::io::write_png("copy.png", logo);
/// \endcode
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "ahm/error.hpp"
#include "ahm/image.hpp"

namespace ahm::io {

/// Whether this build can read and write images (requires stb).
bool has_images() noexcept;

/// Reads a PNG or JPEG file.
/// @throws IoError with the file name and the reason
Image read_image(const std::filesystem::path& path);

/// Decodes a PNG or JPEG file in memory.
/// @param name  name of the file, for messages
/// @throws IoError with the name and the reason
Image decode_image(std::string_view bytes, const std::string& name = "image");

/// Encodes an image as a PNG file in memory.
/// @throws InvalidArgument (the size does not match the number of pixels), IoError (this build has no stb)
std::string png_bytes(const Image& image);

/// Writes a PNG file. @throws as `png_bytes`; IoError
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace ahm::io

// A file that is written and sent, and does not stay.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "ahm/image.hpp"

namespace ahm::viewer {

/// The bytes that `write` puts into a file with this ending. @throws IoError, what `write` throws
std::string exported(const std::string& format, const std::function<void(const std::filesystem::path&)>& write);

/// A PNG or JPEG file in base64. @throws InvalidArgument: no such text, no such image
Image image_of(const std::string& base64);

}  // namespace ahm::viewer

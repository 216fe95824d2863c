#include "exported.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>

#include "ahm/error.hpp"
#include "ahm/io/image.hpp"
#include "ahm/io/temporary_folder.hpp"

namespace ahm::viewer {

std::string exported(const std::string& format, const std::function<void(const std::filesystem::path&)>& write) {
  const io::TemporaryFolder folder("ahm-view-");
  const std::filesystem::path file = folder.directory() / ("map." + format);
  write(file);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream || bytes.empty()) throw IoError("cannot read the export again");
  return bytes;
}

namespace {

std::string decoded(const std::string& base64) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : base64.substr(0, base64.find('='))) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos) throw InvalidArgument("request: \"image\" must be a file in base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<char>(bits >> count & 0xff));
  }
  return bytes;
}

}  // namespace

Image image_of(const std::string& base64) {
  const io::TemporaryFolder folder("ahm-view-");
  const std::filesystem::path file = folder.directory() / "image";
  std::ofstream(file, std::ios::binary) << decoded(base64);
  try {
    return io::read_image(file);
  } catch (const IoError&) {
    throw InvalidArgument("the image is neither a PNG nor a JPEG file that ahm reads");
  }
}

}  // namespace ahm::viewer

#include "formats/format.hpp"

#include <algorithm>

#include "ahm/io/formats.hpp"

namespace ahm::io {
namespace {

bool serves(const Format& format, Use use) {
  if (!format.missing.empty()) return use != Use::write_textured;
  switch (use) {
    case Use::read:
      return format.read != nullptr;
    case Use::write:
      return format.write != nullptr;
    case Use::write_textured:
      return format.write_textured != nullptr;
  }
  return false;
}

}  // namespace

std::vector<std::string> extensions(Use use) {
  std::vector<std::string> result;
  for (const Format& format : formats())
    if (serves(format, use)) result.insert(result.end(), format.extensions.begin(), format.extensions.end());
  return result;
}

const Format* find_format(const std::string& extension) {
  for (const Format& format : formats())
    if (std::ranges::find(format.extensions, extension) != format.extensions.end()) return &format;
  return nullptr;
}

const Format* recognized_format(std::string_view bytes) {
  for (const Format& format : formats())
    for (const std::string& signature : format.signatures)
      if (bytes.starts_with(signature)) return &format;
  return nullptr;
}

std::string list_of(const std::vector<std::string>& extensions, const std::string& last) {
  std::string text;
  for (std::size_t k = 0; k < extensions.size(); ++k)
    text += (k == 0 ? "" : k + 1 < extensions.size() ? ", " : " " + last + " ") + extensions[k];
  return text;
}

}  // namespace ahm::io

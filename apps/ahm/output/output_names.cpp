#include "output/output_names.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "ahm/error.hpp"
#include "ahm/io/formats.hpp"
#include "output/output_paths.hpp"

namespace ahm::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view placeholder = "{}";

bool is_folder(const std::string& name) {
  std::error_code ignored;
  return name.ends_with('/') || fs::is_directory(name, ignored);
}

void make_folder(const std::string& name) {
  std::error_code error;
  fs::create_directory(name, error);
  if (error) throw IoError(fmt::format("the folder '{}' cannot be made: {}", name, error.message()));
}

}  // namespace

std::string stem_of(const std::string& path) {
  if (path == "-") return "stdin";
  const fs::path name = fs::path(path).filename();
  return (io::lower_extension(path) == ".gz" ? name.stem() : name).stem().string();
}

bool is_pattern(const std::string& name) { return is_folder(name) || name.find(placeholder) != std::string::npos; }

std::string filled(const std::string& name, const std::string& stem, const std::string& ending) {
  if (is_folder(name)) {
    make_folder(name);
    return (fs::path(name) / (stem + "_map" + ending)).string();
  }
  std::string result = name;
  for (std::size_t at = 0; (at = result.find(placeholder, at)) != std::string::npos; at += stem.size())
    result.replace(at, placeholder.size(), stem);
  return result;
}

}  // namespace ahm::app

#include "output/output_paths.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "ahm/error.hpp"

namespace ahm::app {
namespace {

namespace fs = std::filesystem;

bool is_file(const OutputPath& output) { return !output.path.empty() && output.path != "-"; }

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  const fs::path x = fs::weakly_canonical(a, error), y = fs::weakly_canonical(b, error);
  return !error && x == y;
}

void check_directory(const OutputPath& output) {
  const fs::path path(output.path);
  std::error_code error;
  if (is_stream(output.path)) return;
  if (fs::is_directory(path, error)) throw IoError(fmt::format("{} {}: is a directory", output.option, output.path));
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(parent, error))
    throw IoError(fmt::format("{} {}: there is no directory '{}'", output.option, output.path, parent.string()));
  if (access(parent.c_str(), W_OK | X_OK) != 0)
    throw IoError(fmt::format("{} {}: cannot write in '{}': {}", output.option, output.path, parent.string(),
                              std::generic_category().message(errno)));
}

}  // namespace

void check_outputs(const std::string& input, const std::vector<OutputPath>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!is_file(outputs[i])) continue;
    check_directory(outputs[i]);
    if (same_file(outputs[i].path, input))
      throw InvalidArgument(
          fmt::format("{} {}: is the input file; it would be overwritten", outputs[i].option, outputs[i].path));
    for (std::size_t j = 0; j < i; ++j)
      if (is_file(outputs[j]) && same_file(outputs[i].path, outputs[j].path))
        throw InvalidArgument(
            fmt::format("{} and {} name the same file {}", outputs[j].option, outputs[i].option, outputs[i].path));
  }
}

void check_ending(const OutputPath& output, const std::vector<std::string>& endings) {
  if (std::find(endings.begin(), endings.end(), extension_of(output.path)) != endings.end()) return;
  const std::string& last = endings.back();
  const std::string others = fmt::format("{}", fmt::join(endings.begin(), endings.end() - 1, ", "));
  throw InvalidArgument(fmt::format("{} {}: the name must end in {}{}{}", output.option, output.path, others,
                                    others.empty() ? "" : " or ", last));
}

bool is_stream(const std::string& path) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  return type == fs::file_type::character || type == fs::file_type::fifo || type == fs::file_type::socket;
}

std::string extension_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace ahm::app

#include "output/output_paths.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <map>
#include <system_error>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/io/read.hpp"
#include "cli/source_list.hpp"

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
  if (error) throw IoError(fmt::format("the folder '{}' cannot be created: {}", name, error.message()));
}

}  // namespace

std::string stem_of(const std::string& path) {
  if (path == "-") return "stdin";
  const fs::path name = fs::path(path).filename();
  return (io::lower_extension(path) == ".gz" ? name.stem() : name).stem().string();
}

bool is_pattern(const std::string& name) { return is_folder(name) || name.find(placeholder) != std::string::npos; }

std::string output_name(const std::string& name, const std::string& stem, const std::string& ending) {
  if (is_folder(name)) {
    make_folder(name);
    return (fs::path(name) / (stem + "_map" + ending)).string();
  }
  std::string result = name;
  for (std::size_t at = 0; (at = result.find(placeholder, at)) != std::string::npos; at += stem.size())
    result.replace(at, placeholder.size(), stem);
  return result;
}

namespace {

namespace fs = std::filesystem;

bool is_file(const OutputPath& output) { return !output.path.empty() && output.path != "-"; }

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  return io::without_links(a) == io::without_links(b);
}

/// Whether a file is the input or belongs to it. The files of each input are looked up once.
bool is_read(const fs::path& file, const std::string& input) {
  static std::map<std::string, std::vector<fs::path>> companion_files;
  if (same_file(file, input == "-" ? "/dev/stdin" : input)) return true;
  auto found = companion_files.find(input);
  if (found == companion_files.end()) found = companion_files.emplace(input, io::files_beside(input)).first;
  return std::ranges::any_of(found->second, [&](const fs::path& other) { return same_file(file, other); });
}

void check_directory(const OutputPath& output) {
  const fs::path path(output.path);
  std::error_code error;
  if (fs::is_directory(path, error))
    throw IoError(fmt::format("{} {}: this is a directory; write the name of a file", output.option, output.path));
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(parent, error))
    throw IoError(fmt::format("{} {}: there is no directory '{}'", output.option, output.path, parent.string()));
  if (access(parent.c_str(), W_OK | X_OK) != 0)
    throw IoError(fmt::format("{} {}: cannot write in '{}': {}", output.option, output.path, parent.string(),
                              std::generic_category().message(errno)));
}

}  // namespace

void check_outputs(const std::vector<std::string>& inputs, const std::vector<OutputPath>& outputs, bool keep_existing) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!is_file(outputs[i])) continue;
    const auto& [option, path] = outputs[i];
    const bool is_stream = io::is_stream(path);
    if (!is_stream) check_directory(outputs[i]);
    for (const std::string& input : inputs)
      if (!is_stream && is_read(path, input))
        throw InvalidArgument(fmt::format(
            "{} {}: would overwrite the input file, or a file that belongs to it; choose another name", option, path));
    for (const std::string& list : lists_read())
      if (same_file(path, list))
        throw InvalidArgument(
            fmt::format("{} {}: would overwrite a list that this command reads; choose another name", option, path));
    if (keep_existing && fs::exists(path) && !is_stream)
      throw InvalidArgument(
          fmt::format("{} {}: the file exists; leave --no-overwrite out to replace it", option, path));
    for (std::size_t j = 0; j < i; ++j)
      if (is_file(outputs[j]) && same_file(path, outputs[j].path))
        throw InvalidArgument(
            fmt::format("{} and {} are the same file {}; choose different names", outputs[j].option, option, path));
  }
}

void check_ending(const OutputPath& output, const std::vector<std::string>& endings, const std::string& format) {
  std::string ending = format.empty() ? io::lower_extension(output.path) : format;
  if (ending.empty() && io::is_stream(output.path)) ending = ".csv";
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  const std::string& last = endings.back();
  const std::string others = fmt::format("{}", fmt::join(endings.begin(), endings.end() - 1, ", "));
  throw InvalidArgument(fmt::format("{} {}: {} {}{}{}", output.option, output.path,
                                    format.empty() ? "the name must end in" : "--format must be the format of", others,
                                    others.empty() ? "" : " or ", last));
}

}  // namespace ahm::app

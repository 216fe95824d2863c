#include "ahm/io/write.hpp"

#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

#include "ahm/io/formats.hpp"
#include "formats/format.hpp"
#include "read/input.hpp"

namespace ahm::io {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw IoError("cannot write " + quoted_path(path) + ": " + what);
}

/// What a file is written as: as asked for, or else by its name.
std::string extension_to_write(const std::filesystem::path& path, const std::string& asked) {
  const std::string extension = asked.empty() ? lower_extension(path) : asked;
  return extension.empty() && is_stream(path) ? ".csv" : extension;
}

/// The format to write to. @throws IoError
const Format& format_to_write(const std::filesystem::path& path, const std::string& asked) {
  const std::string extension = extension_to_write(path, asked);
  const Format* format = find_format(extension);
  if (format == nullptr || (format->write == nullptr && format->missing.empty()))
    fail(path, "unknown file type " + in_quotes(extension) + "; known are " + list_of(extensions(Use::write)));
  if (format->write == nullptr)
    fail(path, "this build has no " + format->missing + ", which writes " + extension + " files; choose .ply or .csv");
  return *format;
}

}  // namespace

void write(const std::filesystem::path& path, const Table& table, const std::string& extension) {
  const Format& format = format_to_write(path, extension);
  check(table);
  AtomicFile file(path);
  if (format.for_viewers) {
    format.write(file, table);
  } else {
    Table numbers = table;
    std::erase_if(numbers.columns, [](const Column& column) { return column.for_viewers; });
    format.write(file, numbers);
  }
  file.commit();
}

bool writes_for_viewers(const std::filesystem::path& path, const std::string& extension) {
  const Format* format = find_format(extension_to_write(path, extension));
  return format == nullptr || format->for_viewers;
}

void check_writable(const std::filesystem::path& path, const std::string& extension) {
  format_to_write(path, extension);
  std::error_code error;
  const auto reason = [](int code) { return std::generic_category().message(code); };
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) fail(path, reason(EISDIR));
  if (std::filesystem::exists(status) && ::access(path.c_str(), W_OK) != 0) fail(path, reason(errno));
  if (is_stream(path)) return;  // written to directly
  std::filesystem::path directory = std::filesystem::weakly_canonical(path, error).parent_path();
  if (error || directory.empty()) directory = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(directory, error)) fail(path, "there is no directory " + quoted_path(directory));
  if (::access(directory.c_str(), W_OK | X_OK) != 0)
    fail(path, "directory " + quoted_path(directory) + ": " + reason(errno));
}

}  // namespace ahm::io

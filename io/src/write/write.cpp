#include "ahm/io/write.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <limits>
#include <string>
#include <system_error>

#include "read/input.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

enum class Format { csv, ply, pcd };

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw IoError("cannot write " + quoted_path(path) + ": " + what);
}

Format format_of(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".csv") return Format::csv;
  if (extension == ".ply") return Format::ply;
  if (extension == ".pcd") {
    if (!has_pcd()) fail(path, "this build has no PCL, which writes PCD files; choose .ply or .csv");
    return Format::pcd;
  }
  if (extension.empty() && is_stream(path)) return Format::csv;
  fail(path, "unknown file type " + in_quotes(extension) + "; known are .csv, .ply and .pcd");
}

void check_length(const char* name, std::size_t length, std::size_t n) {
  if (length == n) return;
  throw InvalidArgument("table: " + std::string(name) + " has " + std::to_string(length) + " rows, but there are " +
                        std::to_string(n) + " points");
}

void check_faces(const Table& table) {
  const auto corners = static_cast<Offset>(table.face_vertices.size());
  const bool bounds =
      table.face_begin.empty() ? corners == 0 : table.face_begin.front() == 0 && table.face_begin.back() == corners;
  if (!bounds || !std::ranges::is_sorted(table.face_begin)) {
    throw InvalidArgument("table: face_begin must rise from 0 to the length of face_vertices, " +
                          std::to_string(corners));
  }
  for (std::size_t k = 0; k < table.face_vertices.size(); ++k) {
    const Index vertex = table.face_vertices[k];
    if (vertex >= 0 && static_cast<std::size_t>(vertex) < table.points.size()) continue;
    throw InvalidArgument("table: face_vertices[" + std::to_string(k) + "] is " + std::to_string(vertex) +
                          ", but there are " + std::to_string(table.points.size()) + " points");
  }
}

void check(const Table& table) {
  const std::size_t n = table.points.size();
  if (n > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw InvalidArgument("table: more than 2147483647 points");
  if (!table.normals.empty()) check_length("normals", table.normals.size(), n);
  for (const Column& column : map_columns(table)) check_length(column.name.c_str(), column.values.size(), n);
  check_length("status", table.status.size(), n);
  for (const Column& column : table.further) {
    check_length(column.name.c_str(), column.values.size(), n);
    const auto plain = [](unsigned char c) { return c < 128 && (std::isalnum(c) != 0 || c == '_'); };
    if (column.name.empty() || !std::ranges::all_of(column.name, plain))
      throw InvalidArgument("table: a column cannot have the name '" + column.name + "'; use letters, digits and _");
  }
  check_faces(table);
}

}  // namespace

std::vector<Column> map_columns(const Table& table) {
  std::vector<Column> result{{"u", table.u}, {"v", table.v}, {"distance", table.distance}, {"angle", table.angle}};
  std::erase_if(result, [](const Column& column) { return column.values.empty(); });
  return result;
}

double value_of(const Table& table, const Column& column, std::size_t vertex) {
  return table.status[vertex] == Status::ok ? column.values[vertex] : std::numeric_limits<double>::quiet_NaN();
}

void write(const std::filesystem::path& path, const Table& table) {
  const Format format = format_of(path);
  check(table);
  AtomicFile file(path);
  switch (format) {
    case Format::csv:
      write_csv(file, table);
      break;
    case Format::ply:
      write_ply(file, table);
      break;
    case Format::pcd:
      write_pcd(file, table);
      break;
  }
  file.commit();
}

void check_writable(const std::filesystem::path& path) {
  format_of(path);
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

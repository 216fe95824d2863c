/// \file
/// A file format: its extensions, and who reads and writes it.
///
/// A format NAME is a file src/formats/NAME.cpp that defines `Format NAME_format()`, and a word in the list of formats
/// in io/CMakeLists.txt. `read`, `write`, `check_writable`, `write_textured`, `extensions` and their messages follow.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"
#include "read/point_stream.hpp"
#include "write/writers.hpp"

namespace ahm::io {

/// What cannot be done with a format stays null.
struct Format {
  std::vector<std::string> extensions;  ///< lower case, with their dot
  std::vector<std::string> signatures =
      {};  ///< a file without a name is of this format where it begins with one of these
  Geometry (*read)(const Input& in) = nullptr;
  /// What it reads beside a file of its own; null: nothing.
  std::vector<std::filesystem::path> (*files_beside)(const Input& in) = nullptr;
  /// For `PointStream`: where points are, from a file's beginning; nullopt: nowhere in particular (text, compressed).
  std::optional<PointRecords> (*records)(const Input& in) = nullptr;
  /// Of such files: hands over all points, and says whether they have normals.
  bool (*take_points)(const ByteStream& file, const TakePoint& take) = nullptr;
  void (*write)(AtomicFile& file, const Table& table) = nullptr;
  bool for_viewers = true;  ///< `write` is given the columns that are for viewers only, too
  void (*write_textured)(const std::filesystem::path& path, std::span<const MeshPart> parts) = nullptr;
  std::string missing = {};  ///< a library this build is without, and the functions above therefore null
};

/// All formats, in the order in which people should see them.
const std::vector<Format>& formats();
/// The format of an extension; null when there is none.
const Format* find_format(const std::string& extension);
/// The format of bytes that begin like its own; null when there is none.
const Format* recognized_format(std::string_view bytes);
/// ".off, .obj and .stl"
std::string list_of(const std::vector<std::string>& extensions, const std::string& last = "and");

}  // namespace ahm::io

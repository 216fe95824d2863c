/// \file
/// A file format: its extensions and the functions that read and write it.
///
/// To add a format NAME, write src/formats/NAME.cpp with a function `Format NAME_format()`, and add NAME to the list of formats in
/// io/CMakeLists.txt. `read`, `write`, `check_writable`, `write_textured`, `extensions` and their messages then include it.
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

/// Unsupported operations are null.
struct Format {
  std::vector<std::string> extensions;       ///< lower case, with the dot
  std::vector<std::string> signatures = {};  ///< first bytes of files, to identify input without a name
  Geometry (*read)(const Input& in) = nullptr;
  /// Other files that a file refers to; null: none.
  std::vector<std::filesystem::path> (*files_beside)(const Input& in) = nullptr;
  /// For `PointStream`: the layout of the points, from the beginning of a file; nullopt if they have no fixed size (text,
  /// compressed).
  std::optional<PointRecords> (*records)(const Input& in) = nullptr;
  /// For files without fixed-size records: passes every point to `take`. @return whether the points have normals
  bool (*take_points)(const ByteStream& file, const TakePoint& take) = nullptr;
  void (*write)(AtomicFile& file, const Table& table) = nullptr;
  bool for_viewers = true;  ///< `write` receives columns for viewers, too
  void (*write_textured)(const std::filesystem::path& path, std::span<const MeshPart> parts) = nullptr;
  std::string missing = {};  ///< library that this build lacks, so that the functions above are null
};

/// All formats, in the order in which they are shown to users.
const std::vector<Format>& formats();
/// The format of an extension; null if the extension is unknown.
const Format* find_format(const std::string& extension);
/// The format with a signature that `bytes` begins with; null if there is none.
const Format* recognized_format(std::string_view bytes);
/// The extensions as a list in English: ".off, .obj and .stl".
std::string list_of(const std::vector<std::string>& extensions, const std::string& last = "and");

}  // namespace ahm::io

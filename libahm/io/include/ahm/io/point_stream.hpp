/// \file
/// Reads points block by block, for files larger than memory.
///
/// \code
/// ahm::io::PointStream stream("scan.ply");
/// std::vector<ahm::Vec3> block(1 << 16);
/// while (const std::size_t count = stream.read(block)) use(std::span(block).first(count));
/// \endcode
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "ahm/types.hpp"

namespace ahm::io {

/// Reads the points of a PLY, PCD, LAS, XYZ, TXT, ASC, CSV or PTS file, optionally compressed with gzip. The points and their order
/// are the same as with `read`. The constructor converts text, compressed files and points with lists to an unnamed temporary file of 24 bytes per
/// point, which disappears with this object or the process.
class PointStream {
 public:
  /// @param scratch  folder for the temporary file
  /// @throws IoError as `read`, when the disk is full, or when the file cannot be streamed:
  /// - it has faces or another format (fault "no_cloud"), or is text in UTF-16
  /// - PCD: coordinates are integers of 8 bytes, or numbers in text do not fit their type
  explicit PointStream(const std::filesystem::path& path,
                       const std::filesystem::path& scratch = std::filesystem::temp_directory_path());
  ~PointStream();
  PointStream(PointStream&&) noexcept;
  PointStream& operator=(PointStream&&) noexcept;

  /// Number of points of the file.
  std::uint64_t size() const noexcept;
  /// Whether the file has a normal for every point. Normals are not read.
  bool has_normals() const noexcept;
  /// Fills `points` with the next points. @return their number; 0 at the end
  /// @throws IoError
  std::size_t read(std::span<Vec3> points);
  /// Goes back to the first point.
  void rewind();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm::io

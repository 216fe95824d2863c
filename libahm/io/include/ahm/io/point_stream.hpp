/// \file
/// The points of a file that need not fit into memory.
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

/// Reads the points of a PLY, PCD, LAS, XYZ, TXT, ASC, CSV or PTS file, or of one of these compressed with gzip, block by block, in
/// the order of the file: those that `read` finds. Text and what is compressed are read once and for all into a file without a
/// name, 24 bytes per point, which is gone with this object or the process.
class PointStream {
 public:
  /// @param scratch  folder whose disk has room for such a file
  /// @throws IoError as `read`, and when the file is none that can be streamed (of another format; lists at vertices of
  /// binary PLY; coordinates of PCD that are whole numbers of 8 bytes, or in text such as do not fit their type), has faces, or the
  /// disk is full; fault "no_cloud" where it has faces, or is of another format
  explicit PointStream(const std::filesystem::path& path,
                       const std::filesystem::path& scratch = std::filesystem::temp_directory_path());
  ~PointStream();
  PointStream(PointStream&&) noexcept;
  PointStream& operator=(PointStream&&) noexcept;

  std::uint64_t size() const noexcept;
  /// Whether every point has a normal, which is not read.
  bool has_normals() const noexcept;
  /// The next points, as many as fit. @return how many; 0 at the end
  /// @throws IoError
  std::size_t read(std::span<Vec3> points);
  /// Goes back to the first point.
  void rewind();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm::io

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

/// Reads the points of a binary PLY or PCD file, or of a LAS file, block by block, in the order of the file: those that `read` finds.
class PointStream {
 public:
  /// @throws IoError when the file cannot be read, is none that can be streamed (text, compressed, of another format; lists
  /// at vertices), has faces, or is cut short
  explicit PointStream(const std::filesystem::path& path);
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

/// \file
/// Compares `PointStream` with `read`: the same points, or the same message.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/io/point_stream.hpp"
#include "ahm/io/read.hpp"

namespace ahm::io::test {

/// Result of reading one file: points, or a message.
struct Cloud {
  std::vector<Vec3> points;
  bool has_normals = false;
  std::string error;
};

inline Cloud find_whole(const std::filesystem::path& path) try {
  Geometry g = read(path);
  return {std::move(g.points), !g.normals.empty(), ""};
} catch (const IoError& e) {
  return {.error = e.what()};
}

inline Cloud find_streamed(const std::filesystem::path& path, std::size_t block = 1000) try {
  PointStream stream(path, path.parent_path());
  Cloud cloud{.has_normals = stream.has_normals()};
  std::vector<Vec3> points(block);
  while (const std::size_t count = stream.read(points))
    cloud.points.insert(cloud.points.end(), points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count));
  EXPECT_EQ(stream.size(), cloud.points.size());
  return cloud;
} catch (const IoError& e) {
  return {.error = e.what()};
}

/// @return whether the file was read
inline bool expect_streamed_as_read(const std::filesystem::path& path) {
  const Cloud whole = find_whole(path), streamed = find_streamed(path);
  EXPECT_EQ(streamed.error, whole.error);
  EXPECT_EQ(streamed.points.size(), whole.points.size()) << path;
  if (streamed.points.size() != whole.points.size()) return false;
  if (!whole.points.empty()) {
    EXPECT_EQ(streamed.has_normals, whole.has_normals) << path;
    EXPECT_EQ(std::memcmp(streamed.points.data(), whole.points.data(), whole.points.size() * sizeof(Vec3)), 0) << path;
  }
  return whole.error.empty();
}

}  // namespace ahm::io::test

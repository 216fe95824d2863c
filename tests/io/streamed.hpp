/// \file
/// That points read block by block are those that `read` finds in the whole file, and what is wrong is told in the same words.
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

struct Found {
  std::vector<Vec3> points;
  bool has_normals = false;
  std::string error;
};

inline Found find_whole(const std::filesystem::path& path) {
  Found found;
  try {
    Geometry g = read(path);
    found.has_normals = !g.normals.empty();
    found.points = std::move(g.points);
  } catch (const IoError& e) {
    found.error = e.what();
  }
  return found;
}

inline Found find_streamed(const std::filesystem::path& path, std::size_t block = 1000) {
  Found found;
  try {
    PointStream stream(path, path.parent_path());
    found.has_normals = stream.has_normals();
    std::vector<Vec3> points(block);
    while (const std::size_t count = stream.read(points))
      found.points.insert(found.points.end(), points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count));
    EXPECT_EQ(stream.size(), found.points.size());
  } catch (const IoError& e) {
    found.error = e.what();
  }
  return found;
}

/// @return whether the file was read
inline bool expect_streamed_as_read(const std::filesystem::path& path) {
  const Found whole = find_whole(path), streamed = find_streamed(path);
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

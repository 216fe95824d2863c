// Points read block by block are those that `read` finds in the whole file.
#include "ahm/io/point_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/io/read.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace ahm::test {
namespace {

template <class T>
void append(std::string& bytes, T value, bool big) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// Points with other properties between the coordinates, behind another element.
std::string mixed_ply(int count, bool big) {
  std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                     "_endian 1.0\ncomment scanned\nelement camera 2\nproperty float focus\nelement vertex " +
                     std::to_string(count) +
                     "\nproperty uchar red\nproperty float x\nproperty double y\nproperty short z\nend_header\n";
  append(text, 1.0f, big);
  append(text, 2.0f, big);
  for (int i = 0; i < count; ++i) {
    text += static_cast<char>(i);
    append(text, 0.5f * static_cast<float>(i), big);
    append(text, 0.1 * i, big);
    append(text, static_cast<std::int16_t>(-i), big);
  }
  return text;
}

class PointStreams : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& bytes) const {
    const auto path = folder_.directory() / "points.ply";
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  void expect_refused(const std::string& bytes, const std::string& why) const {
    const auto path = file(bytes);
    expect_error<IoError>([&] { io::PointStream stream(path); }, why);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(PointStreams, ReadWhatTheWholeFileHolds) {
  for (bool big : {false, true}) {
    const auto path = file(mixed_ply(1000, big));
    const std::vector<Vec3> expected = io::read(path).points;
    io::PointStream stream(path);
    EXPECT_EQ(stream.size(), 1000u);
    EXPECT_FALSE(stream.has_normals());
    for (std::size_t block : {1u, 7u, 1000u, 5000u}) {
      std::vector<Vec3> points, part(block);
      stream.rewind();
      while (const std::size_t count = stream.read(part))
        points.insert(points.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(count));
      EXPECT_EQ(points, expected);
    }
  }
}

TEST_F(PointStreams, KnowOfNormals) {
  const io::PointStream stream(
      file("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
           "float z\nproperty float nx\nproperty float ny\nproperty float nz\nend_header\n" +
           std::string(24, '\0')));
  EXPECT_TRUE(stream.has_normals());
}

TEST_F(PointStreams, RefuseWhatTheyCannotRead) {
  const std::string binary = "ply\nformat binary_little_endian 1.0\n", xyz = "property float x\nproperty float y\n",
                    z = "property float z\n", end = "end_header\n";
  expect_refused("", "points.ply");
  expect_refused("solid stl\n", "ply");
  expect_refused("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + z + end + "0 0 0\n", "text file");
  expect_refused(binary + "element vertex 2\n" + xyz + z + end + std::string(23, '\0'), "cut short");
  expect_refused(binary + "element vertex 1\n" + xyz + end + std::string(8, '\0'), "no property 'z'");
  expect_refused(
      binary + "element vertex 1\n" + xyz + z + "property list uchar int more\n" + end + std::string(13, '\0'),
      "lists");
  expect_refused(binary + "element strip 1\nproperty list uchar int of\nelement vertex 1\n" + xyz + z + end +
                     std::string(13, '\0'),
                 "'strip'");
  expect_refused(binary + "element vertex 1\n" + xyz + z + "element face 1\nproperty list uchar int vertex_indices\n" +
                     end + std::string(13, '\0'),
                 "faces");
  expect_refused(binary + "element point 1\n" + xyz + z + end + std::string(12, '\0'), "no element 'vertex'");
}

TEST_F(PointStreams, NoteThatAFileBecameShorter) {
  const auto path = file(mixed_ply(100'000, false));
  io::PointStream stream(path);
  std::filesystem::resize_file(path, 1000);
  std::vector<Vec3> points(100'000);
  EXPECT_THROW(stream.read(points), IoError);
}

}  // namespace
}  // namespace ahm::test

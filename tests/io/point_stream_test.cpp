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
  std::filesystem::path file(const std::string& bytes, const std::string& name = "points.ply") const {
    const auto path = folder_.directory() / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  void expect_refused(const std::string& bytes, const std::string& why, const std::string& name = "points.ply") const {
    const auto path = file(bytes, name);
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

/// LAS 1.2 of point format 1, with three bytes before the points and two behind each.
std::string las(int count, std::uint32_t told, std::uint8_t format = 1) {
  std::string bytes = "LASF" + std::string(20, '\0') + '\1' + '\2';
  bytes.resize(94, '\0');
  append(bytes, std::uint16_t{227}, false), append(bytes, std::uint32_t{230}, false);
  append(bytes, std::uint32_t{0}, false);
  bytes += static_cast<char>(format);
  append(bytes, std::uint16_t{30}, false), append(bytes, told, false);
  bytes.resize(131, '\0');
  for (double x : {0.001, 0.002, 0.5, 431000.0, 5412000.0, -100.0}) append(bytes, x, false);
  bytes.resize(230, '\0');
  for (int i = 0; i < count; ++i) {
    for (std::int32_t x : {7 * i - 1500, -i, i * i}) append(bytes, x, false);
    bytes.resize(230 + 30 * (static_cast<std::size_t>(i) + 1), '\0');
  }
  return bytes;
}

TEST_F(PointStreams, ReadLasAsTheWholeFileIsRead) {
  const auto path = file(las(100, 100), "points.las");
  const std::vector<Vec3> expected = io::read(path).points;
  ASSERT_EQ(expected.size(), 100u);
  io::PointStream stream(path);
  EXPECT_EQ(stream.size(), 100u);
  EXPECT_FALSE(stream.has_normals());
  std::vector<Vec3> points(150);
  EXPECT_EQ(stream.read(points), 100u);
  points.resize(100);
  EXPECT_EQ(points, expected);
  EXPECT_EQ(points[3][1], -3 * 0.002 + 5412000);
  expect_refused(las(99, 100), "100 points of 30 bytes do not fit", "points.las");
  expect_refused(las(1, 1, 0x81), "compressed (LAZ)", "points.las");
  expect_refused("LASF", "ends within its header", "points.las");
}

/// Coordinates of several types, out of order, among others.
std::string pcd(const std::string& data, int count, const std::string& types = "F U F I F") {
  const std::string points = std::to_string(count);
  std::string bytes = "# .PCD v0.7\nVERSION 0.7\nFIELDS z ring x y more\nSIZE 8 1 4 2 4\nTYPE " + types +
                      "\nCOUNT 1 1 1 1 3\nWIDTH " + points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points +
                      "\nDATA " + data + "\n";
  for (int i = 0; i < count; ++i) {
    append(bytes, 0.1 * i, false);
    bytes += '\n';
    append(bytes, 0.25f * static_cast<float>(i), false), append(bytes, static_cast<std::int16_t>(-i), false);
    bytes += std::string(12, '\n');
  }
  return bytes;
}

TEST_F(PointStreams, ReadBinaryPcd) {
  io::PointStream stream(file(pcd("binary", 1000), "points.pcd"));
  ASSERT_EQ(stream.size(), 1000u);
  EXPECT_FALSE(stream.has_normals());
  std::vector<Vec3> points(1000);
  EXPECT_EQ(stream.read(points), 1000u);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(points[i], (Vec3{0.25 * i, -1.0 * i, 0.1 * i}));
  const std::string normals =
      "FIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nPOINTS 1\nDATA binary\n";
  EXPECT_TRUE(io::PointStream(file(normals + std::string(24, '\0'), "points.pcd")).has_normals());
  std::string cut = pcd("binary", 10);
  cut.pop_back();
  expect_refused(cut, "cut short", "points.pcd");
  const std::string long_x = "FIELDS x y z\nSIZE 8 4 4\nTYPE I F F\nPOINTS 0\nDATA binary\n";
  expect_refused(long_x, "integers of 8 bytes", "points.pcd");
}

TEST_F(PointStreams, AreOfFormatsThatCanBeReadBlockByBlock) {
  for (const char* name : {"points.obj", "points.off.gz", "points.gz", "points"})
    expect_refused("0 0 0\n", ".ply, .pcd, .las, .xyz, .txt, .asc, .csv or .pts", name);
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
  expect_refused(binary + "element vertex 2\n" + xyz + z + end + std::string(23, '\0'), "cut short");
  expect_refused(binary + "element vertex 1\n" + xyz + end + std::string(8, '\0'), "no property 'z'");
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

// Points that are read block by block. readers_test.cpp compares them with `read` on many small files.
#include "ahm/io/point_stream.hpp"

#include "files.hpp"
#include "streamed.hpp"
#include "support/expect_error.hpp"

namespace ahm::io::test {
namespace {

class PointStreams : public Files {
 protected:
  void expect_not_streamed(const std::string& name, const std::string& bytes, const std::string& part) const {
    const auto file = make(name, bytes);
    ahm::test::expect_error<IoError>([&] { const PointStream stream(file); }, part);
  }
};

/// Points with other properties between the coordinates, after another element.
std::string mixed_ply(int count, std::endian order) {
  std::string text = std::string("ply\nformat binary_") + (order == std::endian::big ? "big" : "little") +
                     "_endian 1.0\ncomment scanned\nelement camera 2\nproperty float focus\nelement vertex " +
                     std::to_string(count) +
                     "\nproperty uchar red\nproperty float x\nproperty double y\nproperty short z\nend_header\n" +
                     bytes_of(1.0f, order) + bytes_of(2.0f, order);
  for (int i = 0; i < count; ++i)
    text += static_cast<char>(i) + bytes_of(0.5f * static_cast<float>(i), order) + bytes_of(0.1 * i, order) +
            bytes_of(static_cast<std::int16_t>(-i), order);
  return text;
}

TEST_F(PointStreams, DoNotDependOnTheSizeOfBlocks) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const auto file = make("a.ply", mixed_ply(1000, order));
    EXPECT_TRUE(expect_streamed_as_read(file));
    PointStream stream(file);
    for (const std::size_t block : {1u, 7u, 1000u, 5000u}) {
      std::vector<Vec3> points, part(block);
      stream.rewind();
      while (const std::size_t count = stream.read(part))
        points.insert(points.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(count));
      EXPECT_EQ(points, read(file).points);
    }
  }
}

/// Text longer than what is in memory at a time, with lines of many lengths.
TEST_F(PointStreams, ReadLongTexts) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (int i = 0; i < 60'000; ++i)
      text += std::to_string(0.1 * i) + std::string(i % 13, ' ') + " -" + std::to_string(i) + " 1e" +
              std::to_string(i % 200) + end;
    EXPECT_TRUE(expect_streamed_as_read(make("a.xyz", text)));
    EXPECT_TRUE(expect_streamed_as_read(make("a.ply",
                                             "ply\nformat ascii 1.0\nelement vertex 60000\nproperty double x\n"
                                             "property double y\nproperty double z\nend_header\n" +
                                                 text)));
    EXPECT_FALSE(expect_streamed_as_read(make("b.xyz", text + "1 2 x" + end)));
  }
}

TEST_F(PointStreams, RefuseWhatIsNotACloud) {
  for (const char* name : {"points.obj", "points.off.gz", "points.gz", "points"})
    expect_not_streamed(name, "0 0 0\n", ".ply, .pcd, .las, .xyz, .txt, .asc, .csv or .pts");
  const std::string head = "ply\nformat binary_little_endian 1.0\n",
                    vertex = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string end = "end_header\n" + std::string(13, '\0');
  expect_not_streamed("missing.ply", head + "element vertex 1\nproperty uchar x\nproperty uchar y\n" + end, "'z'");
  expect_not_streamed("point.ply", head + "element point 1\nproperty uchar x\n" + end, "no element 'vertex'");
  expect_not_streamed("faces.ply", head + vertex + "element face 1\nproperty list uchar int vertex_indices\n" + end,
                      "faces");
}

TEST_F(PointStreams, RefuseAFileThatBecameShorter) {
  const auto file = make("a.ply", mixed_ply(100'000, std::endian::little));
  PointStream stream(file);
  std::filesystem::resize_file(file, 1000);
  std::vector<Vec3> points(100'000);
  EXPECT_THROW(stream.read(points), IoError);
}

TEST_F(PointStreams, LeaveNoFileBehind) {
  const auto file = make("a.xyz", "1 2 3\n4 5 6\n");
  PointStream stream(file, file.parent_path());
  EXPECT_EQ(stream.size(), 2u);
  EXPECT_EQ(files_left(), 1u);
  EXPECT_THROW(PointStream(file, file.parent_path() / "none"), IoError);
}

}  // namespace
}  // namespace ahm::io::test

#include <cmath>
#include <cstring>

#include "ahm/io/write.hpp"
#include "comma_locale.hpp"
#include "files.hpp"
#include "streamed.hpp"
#include "table.hpp"

namespace ahm::io::test {
namespace {

using ReadPcd = Files;

std::string header(const std::string& fields, const std::string& size, const std::string& type,
                   const std::string& count, int points, const std::string& data) {
  const std::string n = std::to_string(points);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\nCOUNT " + count +
         "\nWIDTH " + n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}

std::string doubles(int points, const std::string& data) {
  return header("x y z", "8 8 8", "F F F", "1 1 1", points, data);
}

/// LZF that only copies: runs of at most 32 literal bytes.
std::string stored_lzf(const std::string& bytes) {
  std::string result;
  for (std::size_t k = 0; k < bytes.size(); k += 32) {
    const std::string run = bytes.substr(k, 32);
    result += static_cast<char>(run.size() - 1) + run;
  }
  return result;
}

std::string compressed(const std::string& planes) {
  const std::string packed = stored_lzf(planes);
  return bytes_of(static_cast<std::uint32_t>(packed.size())) + bytes_of(static_cast<std::uint32_t>(planes.size())) +
         packed;
}

TEST_F(ReadPcd, ReadsTextWithNanPaddingAndSeveralValuesPerField) {
  const Geometry g = read_bytes("a.pcd", header("y _ x hist z", "4 1 4 4 4", "F U F F F", "1 2 1 3 1", 2, "ascii") +
                                             "2 9 9 1 7 7 7 3.5\r\nnan 9 9 -1 7 7 7 -inf\n");
  ASSERT_EQ(g.points.size(), 2u);
  EXPECT_EQ(g.points[0], (Vec3{1, 2, 3.5}));
  EXPECT_TRUE(std::isnan(g.points[1][1]));
  EXPECT_TRUE(std::isinf(g.points[1][2]));
  EXPECT_EQ(g.format, "PCD text");
}

TEST_F(ReadPcd, ReadsBinaryWithPaddingDoublesNormalsAndColors) {
  const std::uint32_t rgb = 0x000a141e;
  std::string body;
  for (int i = 0; i < 2; ++i) {
    body += "pad" + bytes_of(431234.567891 + i) + bytes_of(5412345.678912) + bytes_of(7.0) + bytes_of(rgb);
    for (float c : {0.0f, 0.0f, 1.0f}) body += bytes_of(c);
  }
  const Geometry g = read_bytes("b.pcd", header("_ x y z rgb normal_x normal_y normal_z", "1 8 8 8 4 4 4 4",
                                                "U F F F F F F F", "3 1 1 1 1 1 1 1", 2, "binary") +
                                             body);
  EXPECT_EQ(g.points[1], (Vec3{431235.567891, 5412345.678912, 7}));
  EXPECT_EQ(g.normals[1], (Vec3{0, 0, 1}));
  EXPECT_EQ(g.colors[0], (std::array<std::uint8_t, 3>{10, 20, 30}));
}

TEST_F(ReadPcd, ReadsCompressedFieldByField) {
  std::string planes;
  for (float x : {1.0f, 4.0f}) planes += bytes_of(x);
  planes += "hist";
  for (float y : {2.0f, 5.0f}) planes += bytes_of(y);
  for (float z : {3.0f, 6.0f}) planes += bytes_of(z);
  const std::string body = compressed(planes);
  const Geometry g =
      read_bytes("c.pcd", header("x hist y z", "4 1 4 4", "F U F F", "1 2 1 1", 2, "binary_compressed") + body);
  ASSERT_EQ(g.points.size(), 2u);
  EXPECT_EQ(g.points[0], (Vec3{1, 2, 3}));
  EXPECT_EQ(g.points[1], (Vec3{4, 5, 6}));
}

// What follows is no comment: PCL would leave out the point.
TEST_F(ReadPcd, RefusesTextWithAZeroByte) {
  const std::string text = header("x y z", "4 4 4", "F F F", "1 1 1", 2, "ascii");
  expect_refused("z.pcd", text + "0 1 2 " + std::string(3, '\0') + "\n3 4 5\n", {"line"});
  expect_refused("z.pcd", text + std::string(3, '\0') + "\n3 4 5\n", {"line"});
}

// To PCL these are parts of a number, for which it leaves the point out, and a line of them is one with a point.
TEST_F(ReadPcd, ReadsTextWithVerticalTabs) {
  for (const std::string apart : {"\v", " \v", "\v\t\v", "\f", "\r"}) {
    const Geometry g = read_bytes(
        "v.pcd", doubles(2, "ascii") + apart + "\n0 1" + apart + "2\n\n" + apart + "3 4 5" + apart + "\n" + apart);
    EXPECT_EQ(g.points, (std::vector<Vec3>{{0, 1, 2}, {3, 4, 5}}));
  }
}

TEST_F(ReadPcd, ReadsAnEmptyCloud) { EXPECT_TRUE(read_bytes("e.pcd", doubles(0, "ascii")).points.empty()); }

TEST_F(ReadPcd, ReadsWholeNumberFieldsAndOrganisedClouds) {
  const Geometry g = read_bytes("i.pcd",
                                "FIELDS x y z\nSIZE 2 4 1\nTYPE I I U\nWIDTH 2\nHEIGHT 2\nPOINTS 4\nDATA ascii\n"
                                "-3 70000 200\n1 1 1\n2 2 2\n3 3 3\n");
  EXPECT_EQ(g.points[0], (Vec3{-3, 70000, 200}));
  EXPECT_EQ(g.points.size(), 4u);
}

TEST_F(ReadPcd, KeepsThePictureAndTheViewpoint) {
  const Geometry g = read_bytes("v.pcd",
                                "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 2\n"
                                "VIEWPOINT 431234.567891 -2 0.1 0.5 0.5 -0.5 0.5\nPOINTS 6\nDATA ascii\n"
                                "1 1 1\n2 2 2\n3 3 3\n4 4 4\nnan nan nan\n6 6 6\n");
  ASSERT_TRUE(g.acquisition.has_value());
  EXPECT_EQ(g.acquisition->width, 3u);
  EXPECT_EQ(g.acquisition->height, 2u);
  EXPECT_EQ(g.acquisition->position, (Vec3{431234.567891, -2, 0.1}));
  EXPECT_EQ(g.acquisition->orientation, (std::array<double, 4>{0.5, 0.5, -0.5, 0.5}));
  EXPECT_EQ(read_bytes("u.pcd", doubles(1, "ascii") + "1 2 3\n").acquisition->height, 1u);
}

TEST_F(ReadPcd, RefusesViewpointsItCannotKeep) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\n", body = "POINTS 1\nDATA ascii\n1 2 3\n";
  expect_refused("v.pcd", head + "VIEWPOINT 0 0 0 1 0 0\n" + body, {"line 5", "seven"});
  expect_refused("v.pcd", head + "VIEWPOINT 0 0 0 1 0 0 a\n" + body, {"line 5", "'a'"});
  expect_refused("v.pcd", head + "VIEWPOINT 0 0 0 1 0 0 0\nVIEWPOINT 1 0 0 1 0 0 0\n" + body, {"line 6", "twice"});
}

TEST_F(ReadPcd, KeepsFurtherFieldsAsProperties) {
  std::string body;
  for (int i = 0; i < 2; ++i) {
    for (const float x : {1.f, 2.f, 3.f, 0.25f + static_cast<float>(i)}) body += bytes_of(x);
    for (const std::uint16_t x : {7, 8, 9}) body += bytes_of(static_cast<std::uint16_t>(x + i));
  }
  const Geometry g =
      read_bytes("p.pcd", header("x y z intensity hist", "4 4 4 4 2", "F F F F U", "1 1 1 1 3", 2, "binary") + body);
  std::vector<std::string> names;
  for (const Property& property : g.properties) names.push_back(property.name);
  ASSERT_EQ(names, (std::vector<std::string>{"intensity", "hist_0", "hist_1", "hist_2"}));
  EXPECT_EQ(g.properties[0].values, (std::vector<double>{0.25, 1.25}));
  EXPECT_EQ(g.properties[2].values, (std::vector<double>{8, 9}));
}

TEST_F(ReadPcd, LeavesOutWholeNumbersThatNoDoubleHolds) {
  const auto stamped = [&](const std::string& stamp) {
    return read_bytes("s.pcd",
                      header("x y z t", "4 4 4 8", "F F F U", "1 1 1 1", 1, "ascii") + "1 2 3 " + stamp + "\n");
  };
  EXPECT_EQ(stamped("9007199254740991").properties[0].values, (std::vector<double>{9007199254740991}));
  const Geometry g = stamped("9007199254740993");
  EXPECT_TRUE(g.properties.empty());
  ASSERT_EQ(g.warnings.size(), 1u);
  EXPECT_EQ(g.warnings[0].name, "t");
}

TEST_F(ReadPcd, ReadsFilesWithoutPointsOrWithoutWidth) {
  const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  std::string binary;
  for (const float x : {1.f, 2.f, 3.f, 4.f, 5.f, 6.f}) binary += bytes_of(x);
  for (const char* size : {"WIDTH 2\nHEIGHT 1\n", "WIDTH 1\nHEIGHT 2\n", "WIDTH 2\n", "POINTS 2\n"}) {
    for (const Geometry& g : {read_bytes("s.pcd", fields + size + "DATA ascii\n1 2 3\n4 5 6\n"),
                              read_bytes("s.pcd", fields + size + "DATA binary\n" + binary)})
      EXPECT_EQ(g.points, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}})) << size;
  }
  expect_refused("s.pcd", fields + "DATA ascii\n1 2 3\n", {"WIDTH"});
}

TEST_F(ReadPcd, RefusesCountsBeyondTheFile) {
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    const std::string body = bytes_of<std::uint32_t>(10) + bytes_of<std::uint32_t>(0xfffffff0) + std::string(20, '\x1');
    EXPECT_THROW(read_bytes("n.pcd", doubles(2147483647, data) + body), IoError) << data;
    EXPECT_THROW(read_bytes("n.pcd", doubles(100, data) + body), IoError) << data;
  }
  expect_refused("n.pcd", doubles(2, "binary") + std::string(47, '\0'), {"48", "47"});
}

TEST_F(ReadPcd, RefusesWidthTimesHeightThatIsNotPoints) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  expect_refused("w.pcd", head + "WIDTH 2\nHEIGHT 2\nPOINTS 3\nDATA ascii\n1 1 1\n2 2 2\n3 3 3\n",
                 {"WIDTH 2", "POINTS 3"});
  expect_refused("w.pcd", head + "WIDTH 4294967296\nHEIGHT 4294967297\nPOINTS 0\nDATA binary\n", {"WIDTH 4294967296"});
  expect_refused("w.pcd", head + "WIDTH 9223372036854775807\nHEIGHT 9223372036854775807\nDATA binary\n", {"WIDTH"});
  expect_refused("w.pcd", head + "WIDTH 65536\nHEIGHT 65536\nPOINTS 4294967296\nDATA binary\n", {"4294967296"});
}

TEST_F(ReadPcd, RefusesEveryTruncation) {
  std::string body;
  for (int k = 0; k < 6; ++k) body += bytes_of(double(k));
  for (const std::string& whole : {doubles(2, "binary") + body, doubles(2, "binary_compressed") + compressed(body)}) {
    for (std::size_t size = 1; size < whole.size(); ++size) {
      EXPECT_THROW(read_bytes("cut.pcd", whole.substr(0, size)), IoError) << size;
    }
  }
  const std::string text = doubles(2, "ascii") + "0 0 0\n1 1 ";
  expect_refused("cut.pcd", text, {"line 13", "found 2"});
  expect_refused("cut.pcd", doubles(3, "ascii") + "0 0 0\n1 1 1", {"2 of 3"});
  expect_refused("cut.pcd", doubles(1, "ascii") + "0 0 0\n1 1 1\n", {"line 13"});
}

TEST_F(ReadPcd, RefusesCompressedSizesThatLie) {
  std::string body;
  for (int k = 0; k < 6; ++k) body += bytes_of(double(k));
  const std::string packed = stored_lzf(body);
  const auto with = [&](std::uint32_t small, std::uint32_t large) {
    return doubles(2, "binary_compressed") + bytes_of(small) + bytes_of(large) + packed;
  };
  const auto size = static_cast<std::uint32_t>(packed.size());
  EXPECT_EQ(read_bytes("l.pcd", with(size, 48)).points[1][2], 5.0);
  expect_refused("l.pcd", with(size + 1, 48), {"compressed size"});
  expect_refused("l.pcd", with(0xffffffff, 48), {"4294967295"});
  expect_refused("l.pcd", with(size, 47), {"47"});
  expect_refused("l.pcd", with(size, 0xffffffff), {"4294967295"});
  expect_refused("l.pcd", with(size - 3, 48), {});
  expect_refused("l.pcd", with(0, 48), {});
}

TEST_F(ReadPcd, RefusesMissingOrDuplicateCoordinates) {
  expect_refused("x.pcd", header("x y", "4 4", "F F", "1 1", 1, "ascii") + "1 2\n", {"'z'"});
  expect_refused("x.pcd", header("x y z x", "4 4 4 4", "F F F F", "1 1 1 1", 1, "ascii") + "1 2 3 4\n",
                 {"'x'", "twice"});
  expect_refused("x.pcd", header("x y z", "4 4 4", "F F F", "1 2 1", 1, "ascii") + "1 2 3 4\n", {"'y'"});
}

TEST_F(ReadPcd, RefusesWhatIsNoNumber) {
  for (const char* word : {"1,5", "1e400", "1.#IND", "abc"}) {
    expect_refused("w.pcd", doubles(1, "ascii") + "0 0 " + word + "\n", {"line 12", word});
  }
}

TEST_F(ReadPcd, RefusesHeadersItCannotTrust) {
  expect_refused("h.pcd", "FIELDS x y z\n", {"DATA"});
  expect_refused("h.pcd", header("x y z", "4 4", "F F F", "1 1 1", 1, "ascii") + "1 2 3\n", {"SIZE"});
  expect_refused("h.pcd", header("x y z", "4 4 3", "F F F", "1 1 1", 1, "ascii") + "1 2 3\n", {"SIZE 3"});
  expect_refused("h.pcd", header("x y z", "4 4 4", "F F Q", "1 1 1", 1, "ascii") + "1 2 3\n", {"TYPE Q"});
  expect_refused("h.pcd", header("x y z w", "4 4 4 4", "F F F F", "1 1 1 -1", 1, "ascii") + "1 2 3\n", {"-1"});
  expect_refused("h.pcd", header("x y z w", "4 4 4 8", "F F F F", "1 1 1 4294967296", 1, "binary") + "1 2 3\n",
                 {"4294967296"});
  expect_refused("h.pcd", header("x y z", "4 4 4", "F F F", "1 1 1", 1, "morse") + "1 2 3\n", {"morse"});
  expect_refused("h.pcd", "", {"empty"});
}

TEST_F(ReadPcd, ReadsTheSameInALocaleWithCommas) {
  Geometry g;
  {
    const CommaLocale locale;
    g = read_bytes("l.pcd", doubles(1, "ascii") + "1.5 -2.25 1234567.5\n");
    write(path("out.pcd"), Result().table());
  }
  EXPECT_EQ(g.points[0], (Vec3{1.5, -2.25, 1234567.5}));
  EXPECT_EQ(read(path("out.pcd")).points.size(), 4u);
}

/// LZF with repetitions of near and of the farthest bytes.
std::string lzf(const std::string& bytes) {
  std::string result, literals;
  const auto flush = [&] {
    result += stored_lzf(literals);
    literals.clear();
  };
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t length = 0, back = 0;
    for (const std::size_t b : {1u, 2u, 4u, 8u, 12u, 100u, 4000u, 8191u, 8192u}) {
      std::size_t same = 0;
      while (b <= at && same < 264 && at + same < bytes.size() && bytes[at + same] == bytes[at + same - b]) ++same;
      if (same > length) length = same, back = b - 1;
    }
    if (length < 3) {
      literals += bytes[at++];
      continue;
    }
    flush();
    const std::size_t told = length - 2;
    result += static_cast<char>((std::min<std::size_t>(told, 7) << 5) + (back >> 8));
    if (told >= 7) result += static_cast<char>(told - 7);
    result += static_cast<char>(back & 255);
    at += length;
  }
  flush();
  return result;
}

TEST_F(ReadPcd, OfCompressedPointsIsStreamedAsItIsRead) {
  const int points = 40'000;
  std::string planes;
  for (int i = 0; i < points; ++i) planes += bytes_of(0.5F * static_cast<float>(i % 2048));
  for (int i = 0; i < points; ++i) planes += "hi";
  for (int i = 0; i < points; ++i) planes += bytes_of(std::sin(0.1 * i));
  for (int i = 0; i < points; ++i) planes += bytes_of(static_cast<std::int16_t>(i / 100));
  for (int i = 0; i < points; ++i) planes += "end";
  const std::string packed = lzf(planes), head = header("y hist x z more", "4 1 8 2 1", "F U F I U", "1 2 1 1 3",
                                                        points, "binary_compressed");
  ASSERT_LT(packed.size(), planes.size() * 3 / 4);
  const auto sized = [&](const std::string& body) {
    return head + bytes_of(static_cast<std::uint32_t>(body.size())) +
           bytes_of(static_cast<std::uint32_t>(planes.size())) + body;
  };
  EXPECT_TRUE(expect_streamed_as_read(make("a.pcd", sized(packed))));
  EXPECT_FALSE(expect_streamed_as_read(make("a.pcd", sized(packed).substr(0, packed.size()))));
  std::string damaged = packed;
  for (const std::string& body : {packed + '\0' + 'x', packed.substr(0, packed.size() - 1), "\xff" + packed}) {
    EXPECT_NE(find_whole(make("a.pcd", sized(body))).error.find("damaged"), std::string::npos);
    EXPECT_NE(find_streamed(make("a.pcd", sized(body))).error.find("damaged"), std::string::npos);
  }
  EXPECT_FALSE(expect_streamed_as_read(make("a.pcd", head)));
  EXPECT_TRUE(expect_streamed_as_read(make("a.pcd", doubles(0, "binary_compressed") + compressed(""))));
}

TEST_F(ReadPcd, OfTextIsStreamedAsItIsRead) {
  const std::string head = header("y _ x hist z", "4 1 8 4 4", "F U F F F", "1 2 1 3 1", 2, "ascii"), rest = " 9 9 ";
  for (const std::string body : {"2 9 9 1 7 7 7 3.5\r\nnan 9 9 -1 7 7 7 -inf\n", "2 9 9 1 7 7 7 3.5\n2 9 9 1 7 7 7\n",
                                 "2 9 9 1 7 7 7 3,5\n2 9 9 1 7 7 7 1\n", "2 9 9 1 7 7 7 1\n",
                                 "1 9 9 1 7 7 7 1\n1 9 9 1 7 7 7 1\n1 9 9 1 7 7 7 1\n"})
    for (std::size_t length = 0; length <= body.size(); ++length)
      expect_streamed_as_read(make("a.pcd", head + body.substr(0, length)));
  std::string numbers;
  const int points = 20'000;
  for (int i = 0; i < points; ++i) {
    std::array<char, 100> line{};
    std::snprintf(line.data(), line.size(), "%.9g %.17g %d 0 0 1\n", std::exp(0.01 * (i - 10'000)), std::sin(1.0 * i),
                  i);
    numbers += line.data();
  }
  EXPECT_TRUE(expect_streamed_as_read(make("b.pcd", header("x y z normal_x normal_y normal_z", "4 8 2 4 4 4",
                                                           "F F U F F F", "1 1 1 1 1 1", points, "ascii") +
                                                        numbers)));
  const auto unfit = make("c.pcd", header("x y z", "4 4 1", "F F I", "1 1 1", 1, "ascii") + "1 2 128\n");
  EXPECT_NE(find_streamed(unfit).error.find("'128' does not fit"), std::string::npos);
}

}  // namespace
}  // namespace ahm::io::test

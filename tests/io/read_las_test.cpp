#include <cmath>
#include <limits>

#include "files.hpp"

namespace ahm::io::test {
namespace {

using ReadLas = Files;

/// A LAS file of two points, as the ASPRS specification lays it out, with `extra` bytes behind each.
struct Las {
  unsigned minor = 2, format = 0;
  std::size_t extra = 0;
  std::array<std::uint16_t, 3> color = {256 * 10, 256 * 20, 65535};
  Vec3 scale = {0.001, 0.001, 0.5}, offset = {431000, 5412000, -100};
  std::uint32_t legacy_points = 2;
  std::uint64_t points = 2;

  static constexpr std::array<std::size_t, 11> sizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  static constexpr std::array<std::size_t, 11> colors = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

  std::size_t header_size() const { return minor < 3 ? 227 : minor == 3 ? 235 : 375; }
  bool has_color() const { return colors[format] != 0; }

  std::string header() const {
    std::string bytes = "LASF" + std::string(20, '\0');
    bytes += std::string{1, static_cast<char>(minor)};
    bytes.resize(94, '\0');
    bytes += bytes_of(static_cast<std::uint16_t>(header_size()));
    bytes += bytes_of(static_cast<std::uint32_t>(header_size() + 3)) + bytes_of(std::uint32_t{0});
    bytes += static_cast<char>(format);
    bytes += bytes_of(static_cast<std::uint16_t>(sizes[format] + extra)) + bytes_of(legacy_points);
    bytes.resize(131, '\0');
    for (const Vec3& v : {scale, offset})
      for (const double x : v) bytes += bytes_of(x);
    bytes.resize(247, '\0');
    bytes += bytes_of(points);
    bytes.resize(header_size(), '\0');
    return bytes + "VLR";
  }

  std::string point(std::array<std::int32_t, 3> position, std::uint16_t intensity, std::uint8_t classification) const {
    std::string bytes;
    for (const std::int32_t x : position) bytes += bytes_of(x);
    bytes += bytes_of(intensity);
    bytes.resize(format < 6 ? 15 : 16, '\0');
    bytes += static_cast<char>(classification);
    if (has_color()) {
      bytes.resize(colors[format], '\0');
      for (const std::uint16_t level : color) bytes += bytes_of(level);
    }
    bytes.resize(sizes[format] + extra, '\0');
    return bytes;
  }

  std::string file() const { return header() + point({1500, -2000, 3}, 700, 2) + point({-1, 0, 7}, 65535, 6); }
};

TEST_F(ReadLas, ReadsEveryVersionAndPointFormat) {
  for (unsigned minor = 0; minor <= 4; ++minor)
    for (unsigned format = 0; format <= 10; ++format) {
      const Las las{.minor = minor, .format = format, .extra = format % 3};
      const Geometry g = read_bytes("a.las", las.file());
      ASSERT_EQ(g.points.size(), 2u);
      EXPECT_EQ(g.points[0], (Vec3{1500 * 0.001 + 431000, -2000 * 0.001 + 5412000, 3 * 0.5 - 100}));
      EXPECT_EQ(g.points[1], (Vec3{-1 * 0.001 + 431000, 5412000, 7 * 0.5 - 100}));
      ASSERT_EQ(g.properties.size(), 2u);
      EXPECT_EQ(g.properties[0].name, "intensity");
      EXPECT_EQ(g.properties[0].values, (std::vector<double>{700, 65535}));
      EXPECT_EQ(g.properties[1].name, "classification");
      EXPECT_EQ(g.properties[1].values, (std::vector<double>{2, 6}));
      EXPECT_EQ(g.colors.size(), las.has_color() ? 2u : 0u);
      for (const auto& color : g.colors) EXPECT_EQ(color, (std::array<std::uint8_t, 3>{10, 20, 255}));
      EXPECT_TRUE(g.face_begin.empty());
      EXPECT_EQ(g.warnings.size(), las.extra > 0 ? 1u : 0u);  // extra bytes without a description
    }
}

TEST_F(ReadLas, TakesTheFlagsOffOldClassesOnly) {
  const Las old{.format = 1}, recent{.minor = 4, .format = 6};
  const auto first_class = [&](const Las& las) {
    return read_bytes("c.las", las.header() + las.point({}, 0, 0xE2) + las.point({}, 0, 0)).properties[1].values[0];
  };
  EXPECT_EQ(first_class(old), 2);
  EXPECT_EQ(first_class(recent), 0xE2);
}

TEST_F(ReadLas, TakesLevelsUpTo255AsTheyAreAndZerosAsNoColors) {
  EXPECT_EQ(read_bytes("c.las", Las{.format = 2, .color = {10, 20, 255}}.file()).colors[0],
            (std::array<std::uint8_t, 3>{10, 20, 255}));
  EXPECT_TRUE(read_bytes("c.las", Las{.format = 2, .color = {0, 0, 0}}.file()).colors.empty());
}

TEST_F(ReadLas, CountsPointsOf14In64Bits) {
  EXPECT_EQ(read_bytes("n.las", Las{.minor = 4, .format = 6, .legacy_points = 0}.file()).points.size(), 2u);
  expect_refused("n.las", Las{.minor = 4, .points = 1}.file(), {"byte 107", "2 and 1"});
}

TEST_F(ReadLas, RefusesEveryTruncation) {
  for (const Las& las : {Las{.format = 3}, Las{.minor = 4, .format = 7, .extra = 2}}) {
    const std::string whole = las.file();
    for (std::size_t size = 1; size < whole.size(); ++size)
      EXPECT_THROW(read_bytes("t.las", whole.substr(0, size)), IoError) << size;
  }
}

TEST_F(ReadLas, RefusesCountsBeyondTheFile) {
  expect_refused("n.las", Las{.legacy_points = 3}.file(), {"byte 230", "3 points of 20 bytes", "40 bytes"});
  expect_refused("n.las", Las{.legacy_points = 4294967295u}.file(), {"4294967295"});
  for (const std::uint64_t points : {std::uint64_t{1} << 31, std::numeric_limits<std::uint64_t>::max()})
    expect_refused("n.las", Las{.minor = 4, .legacy_points = 0, .points = points}.file(), {std::to_string(points)});
}

TEST_F(ReadLas, RefusesCompressedPointsAndSaysWhatToDo) {
  std::string bytes = Las{}.file();
  bytes[104] = static_cast<char>(0x80 | 3);
  expect_refused("z.las", bytes, {"LAZ", "laszip"});
  expect_refused("z.laz", bytes, {"LAZ", "laszip"});
}

TEST_F(ReadLas, RefusesHeadersItCannotTrust) {
  const std::string whole = Las{}.file();
  const auto with = [&](std::size_t at, std::string_view bytes) {
    std::string changed = whole;
    changed.replace(at, bytes.size(), bytes);
    return changed;
  };
  expect_refused("h.las", with(0, "LAS_"), {"'LASF'"});
  expect_refused("h.las", with(24, "\2"), {"LAS 2.2"});
  expect_refused("h.las", with(25, "\5"), {"LAS 1.5"});
  expect_refused("h.las", with(94, bytes_of(std::uint16_t{226})), {"226"});
  expect_refused("h.las", with(96, bytes_of(std::uint32_t{100})), {"byte 100"});
  expect_refused("h.las", with(96, bytes_of(std::uint32_t{4000000000u})), {"4000000000"});
  expect_refused("h.las", with(104, "\13"), {"point format 11"});
  expect_refused("h.las", with(105, bytes_of(std::uint16_t{19})), {"19 bytes"});
  for (const double bad : {0.0, std::numeric_limits<double>::infinity(), std::nan("")})
    expect_refused("h.las", with(139, bytes_of(bad)), {"scale"});
  expect_refused("h.las", with(163, bytes_of(std::nan(""))), {"offset"});
}

}  // namespace
}  // namespace ahm::io::test

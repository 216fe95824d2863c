#include <cmath>
#include <limits>

#include "io/cases.hpp"
#include "io/files.hpp"

namespace ahm::io::test {
namespace las_files {

/// A LAS file of two points, after the specification of the ASPRS, with `extra` bytes after each.
struct Las {
  unsigned minor = 2, format = 0;
  std::size_t extra = 0;
  std::array<std::uint16_t, 3> color = {256 * 10, 256 * 20, 65535};
  std::uint32_t legacy_points = 2;
  std::uint64_t points = 2;
  std::uint8_t classification = 2;

  static constexpr std::array<std::size_t, 11> sizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  static constexpr std::array<std::size_t, 11> colors = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

  bool has_color() const { return colors[format] != 0; }

  std::string header() const {
    const std::size_t size = minor < 3 ? 227 : minor == 3 ? 235 : 375;
    std::string bytes = "LASF" + std::string(20, '\0') + '\1' + static_cast<char>(minor);
    bytes.resize(94, '\0');
    bytes += bytes_of(static_cast<std::uint16_t>(size)) + bytes_of(static_cast<std::uint32_t>(size + 3)) +
             bytes_of(std::uint32_t{0}) + static_cast<char>(format) +
             bytes_of(static_cast<std::uint16_t>(sizes[format] + extra)) + bytes_of(legacy_points);
    bytes.resize(131, '\0');
    for (const double x : {0.001, 0.001, 0.5, 431000., 5412000., -100.}) bytes += bytes_of(x);  // scale, offset
    bytes.resize(247, '\0');
    bytes += bytes_of(points);
    bytes.resize(size, '\0');
    return bytes + "VLR";
  }

  std::string point(std::array<std::int32_t, 3> position, std::uint16_t intensity, std::uint8_t code) const {
    std::string bytes;
    for (const std::int32_t x : position) bytes += bytes_of(x);
    bytes += bytes_of(intensity);
    bytes.resize(format < 6 ? 15 : 16, '\0');
    bytes += static_cast<char>(code);
    if (has_color()) {
      bytes.resize(colors[format], '\0');
      for (const std::uint16_t level : color) bytes += bytes_of(level);
    }
    bytes.resize(sizes[format] + extra, '\0');
    return bytes;
  }

  std::string file() const {
    return header() + point({1500, -2000, 3}, 700, classification) + point({-1, 0, 7}, 65535, 6);
  }
};

std::string contents(const std::string& colors, int classification = 2) {
  return "431001.5 5411998 -98.5, 430999.999 5412000 -96.5" + colors + "; intensity 700 65535; classification " +
         std::to_string(classification) + " 6";
}

}  // namespace las_files

Cases las_cases() {
  using namespace las_files;
  const std::string colors = "; colors 10 20 255, 10 20 255";
  Cases c;
  for (unsigned minor = 0; minor <= 4; ++minor)
    for (unsigned format = 0; format <= 10; ++format) {
      const Las las{.minor = minor, .format = format, .extra = format % 3};
      c.good("formats.las", las.file(),
             contents(las.has_color() ? colors : "") +
                 (las.extra > 0 ? "; bytes_ignored " + std::to_string(las.extra) : ""),
             Cases::all);
    }
  c.good("levels.las", Las{.format = 2, .color = {10, 20, 255}}.file(), contents(colors));
  c.good("black.las", Las{.format = 2, .color = {0, 0, 0}}.file(), contents(""));
  c.good("flags.las", Las{.format = 1, .classification = 0xE2}.file(), contents("", 2));
  c.good("classes.las", Las{.minor = 4, .format = 6, .classification = 0xE2}.file(), contents("", 0xE2));
  c.good("wide.las", Las{.minor = 4, .format = 6, .legacy_points = 0}.file(), contents(""));

  c.bad("counts.las", Las{.minor = 4, .points = 1}.file(), {"byte 107", "2 and 1"});
  c.bad("three.las", Las{.legacy_points = 3}.file(), {"byte 230", "3 points of 20 bytes", "40 bytes"});
  c.bad("many.las", Las{.legacy_points = 4294967295u}.file(), {"4294967295"});
  for (const std::uint64_t points : {std::uint64_t{1} << 31, std::numeric_limits<std::uint64_t>::max()})
    c.bad("wide.las", Las{.minor = 4, .legacy_points = 0, .points = points}.file(), {std::to_string(points)});
  const auto with = [&](std::size_t at, std::string_view bytes, std::vector<std::string> parts) {
    c.bad("header.las", Las{}.file().replace(at, bytes.size(), bytes), std::move(parts));
  };
  with(0, "LAS_", {"'LASF'"});
  with(24, "\2", {"LAS 2.2"});
  with(25, "\5", {"LAS 1.5"});
  with(94, bytes_of(std::uint16_t{226}), {"226"});
  with(96, bytes_of(std::uint32_t{100}), {"byte 100"});
  with(96, bytes_of(std::uint32_t{4000000000u}), {"4000000000"});
  with(104, "\13", {"point format 11"});
  with(104, "\x83", {"LAZ", "laszip"});
  with(105, bytes_of(std::uint16_t{19}), {"19 bytes"});
  for (const double scale : {0.0, std::numeric_limits<double>::infinity(), std::nan("")})
    with(139, bytes_of(scale), {"scale"});
  with(163, bytes_of(std::nan("")), {"offset"});
  return c;
}

}  // namespace ahm::io::test

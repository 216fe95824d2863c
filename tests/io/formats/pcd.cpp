#include <cmath>

#include "io/cases.hpp"
#include "io/files.hpp"
#include "io/streamed.hpp"

namespace ahm::io::test {
namespace pcd_files {

std::string header(const std::string& fields, const std::string& size, const std::string& type,
                   const std::string& count, int points, const std::string& data) {
  const std::string n = std::to_string(points);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\nCOUNT " + count +
         "\nWIDTH " + n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}

std::string doubles(int points, const std::string& data) {
  return header("x y z", "8 8 8", "F F F", "1 1 1", points, data);
}

template <class... Values>
std::string bytes_of_all(Values... values) {
  return (bytes_of(values) + ...);
}

/// LZF that only copies: runs of at most 32 bytes.
std::string stored_lzf(const std::string& bytes) {
  std::string result;
  for (std::size_t k = 0; k < bytes.size(); k += 32) {
    const std::string run = bytes.substr(k, 32);
    result += static_cast<char>(run.size() - 1) + run;
  }
  return result;
}

/// LZF with repetitions of near and of the farthest bytes.
std::string lzf(const std::string& bytes) {
  std::string result, literals;
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
    result += stored_lzf(std::exchange(literals, {}));
    const std::size_t more = length - 2;
    result += static_cast<char>((std::min<std::size_t>(more, 7) << 5) + (back >> 8));
    if (more >= 7) result += static_cast<char>(more - 7);
    result += static_cast<char>(back & 255);
    at += length;
  }
  return result + stored_lzf(literals);
}

/// Packed bytes after their size and the size of the planes.
std::string sized(const std::string& packed, std::size_t planes) {
  return bytes_of_all(static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(planes)) + packed;
}

std::string compressed(const std::string& planes) { return sized(stored_lzf(planes), planes.size()); }

void add_text(Cases& c) {
  c.good("fields.pcd",
         header("y _ x hist z", "4 1 8 4 4", "F U F F F", "1 2 1 3 1", 2, "ascii") +
             "2 9 9 1 7 7 7 3.5\r\nnan 9 9 -1 7 7 7 -inf\n",
         "1 2 3.5, -1 nan -inf; hist_0 7 7; hist_1 7 7; hist_2 7 7");
  for (const std::string apart : {"\v", " \v", "\v\t\v", "\f", "\r"})  // PCL would leave points out
    c.good("blanks.pcd",
           doubles(2, "ascii") + apart + "\n0 1" + apart + "2\n\n" + apart + "3 4 5" + apart + "\n" + apart,
           "0 1 2, 3 4 5");
  c.good("empty.pcd", doubles(0, "ascii"), "");
  c.good("whole.pcd",
         "FIELDS x y z\nSIZE 2 4 1\nTYPE I I U\nWIDTH 2\nHEIGHT 2\nPOINTS 4\nDATA ascii\n-3 70000 200\n1 1 1\n2 2 2\n3 "
         "3 3\n",
         "-3 70000 200, 1 1 1, 2 2 2, 3 3 3; image 2 x 2 from 0 0 0 along 1 0 0 0");
  c.good(
      "image.pcd",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 2\nVIEWPOINT 431234.567891 -2 0.1 0.5 0.5 -0.5 0.5\n"
      "POINTS 6\nDATA ascii\n1 1 1\n2 2 2\n3 3 3\n4 4 4\nnan nan nan\n6 6 6\n",
      "1 1 1, 2 2 2, 3 3 3, 4 4 4, nan nan nan, 6 6 6; image 3 x 2 from 431234.567891 -2 0.1 along 0.5 0.5 -0.5 0.5");
  const std::string stamp = header("x y z t", "4 4 4 8", "F F F U", "1 1 1 1", 1, "ascii") + "1 2 3 ";
  c.good("stamp.pcd", stamp + "9007199254740991\n", "1 2 3; t 9007199254740991");
  c.good("no_double.pcd", stamp + "9007199254740993\n", "1 2 3; element_ignored t");

  // PCL would leave out the point.
  const std::string text = header("x y z", "4 4 4", "F F F", "1 1 1", 2, "ascii");
  c.bad("zero.pcd", text + "0 1 2 " + std::string(3, '\0') + "\n3 4 5\n", {"line"});
  c.bad("zero.pcd", text + std::string(3, '\0') + "\n3 4 5\n", {"line"});
  c.bad("cut.pcd", doubles(2, "ascii") + "0 0 0\n1 1 ", {"line 13", "found 2"});
  c.bad("cut.pcd", doubles(3, "ascii") + "0 0 0\n1 1 1", {"2 of 3"});
  c.bad("more.pcd", doubles(1, "ascii") + "0 0 0\n1 1 1\n", {"line 13"});
  for (const char* word : {"1,5", "1e400", "1.#IND", "abc"})
    c.bad("number.pcd", doubles(1, "ascii") + "0 0 " + word + "\n", {"line 12", word});
}

void add_binary(Cases& c) {
  std::string body;
  for (int i = 0; i < 2; ++i)
    body += "pad" + bytes_of_all(431234.567891 + i, 5412345.678912, 7.0, std::uint32_t{0x000a141e}, 0.0f, 0.0f, 1.0f);
  c.good(
      "fields.pcd",
      header("_ x y z rgb normal_x normal_y normal_z", "1 8 8 8 4 4 4 4", "U F F F F F F F", "3 1 1 1 1 1 1 1", 2,
             "binary") +
          body,
      "431234.567891 5412345.678912 7, 431235.567891 5412345.678912 7; normals 0 0 1, 0 0 1; colors 10 20 30, 10 20 30",
      Cases::all);
  body.clear();
  for (std::uint16_t i = 0; i < 2; ++i) {
    body += bytes_of_all(1.f, 2.f, 3.f, 0.25f + static_cast<float>(i));
    for (const int x : {7, 8, 9}) body += bytes_of(static_cast<std::uint16_t>(x + i));
  }
  c.good("properties.pcd", header("x y z intensity hist", "4 4 4 4 2", "F F F F U", "1 1 1 1 3", 2, "binary") + body,
         "1 2 3, 1 2 3; intensity 0.25 1.25; hist_0 7 8; hist_1 8 9; hist_2 9 10", Cases::all);
  const std::string planes = bytes_of_all(1.f, 4.f) + "hist" + bytes_of_all(2.f, 5.f, 3.f, 6.f);
  c.good("planes.pcd",
         header("x hist y z", "4 1 4 4", "F U F F", "1 2 1 1", 2, "binary_compressed") + compressed(planes),
         "1 2 3, 4 5 6; hist_0 104 115; hist_1 105 116", Cases::all);
  c.good("padding.pcd",
         header("x _ y z", "4 1 4 4", "F U F F", "1 2 1 1", 2, "binary_compressed") + compressed(std::string(28, '\0')),
         "0 0 0, 0 0 0", Cases::all);

  body = bytes_of_all(0., 1., 2., 3., 4., 5.);
  c.good("doubles.pcd", doubles(2, "binary") + body, "0 1 2, 3 4 5", Cases::all);
  const std::string packed = stored_lzf(body);
  const auto with_sizes = [&](std::size_t small, std::uint32_t large) {
    return doubles(2, "binary_compressed") + bytes_of_all(static_cast<std::uint32_t>(small), large) + packed;
  };
  c.good("sizes.pcd", with_sizes(packed.size(), 48), "0 2 4, 1 3 5", Cases::all);
  c.bad("sizes.pcd", with_sizes(packed.size() + 1, 48), {"compressed size"});
  c.bad("sizes.pcd", with_sizes(0xffffffff, 48), {"4294967295"});
  c.bad("sizes.pcd", with_sizes(packed.size(), 47), {"47"});
  c.bad("sizes.pcd", with_sizes(packed.size(), 0xffffffff), {"4294967295"});
  c.bad("sizes.pcd", with_sizes(packed.size() - 3, 48));
  c.bad("sizes.pcd", with_sizes(0, 48));
  for (const char* data : {"ascii", "binary", "binary_compressed"})
    for (const int points : {2147483647, 100})
      c.bad("count.pcd", doubles(points, data) + bytes_of_all(std::uint32_t{10}, 0xfffffff0u) + std::string(20, '\x1'));
  c.bad("short.pcd", doubles(2, "binary") + std::string(47, '\0'), {"48", "47"});
}

void add_headers(Cases& c) {
  const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n", body = "DATA ascii\n1 2 3\n4 5 6\n";
  for (const std::string size : {"WIDTH 2\nHEIGHT 1\n", "WIDTH 1\nHEIGHT 2\n", "WIDTH 2\n", "POINTS 2\n"}) {
    const std::string contents =
        std::string("1 2 3, 4 5 6") + (size.ends_with("HEIGHT 2\n") ? "; image 1 x 2 from 0 0 0 along 1 0 0 0" : "");
    c.good("sizes.pcd", fields + size + body, contents);
    c.good("sizes.pcd", fields + size + "DATA binary\n" + bytes_of_all(1.f, 2.f, 3.f, 4.f, 5.f, 6.f), contents);
  }
  c.bad("sizes.pcd", fields + body, {"WIDTH"});
  c.bad("sizes.pcd", fields + "WIDTH 2\nHEIGHT 2\nPOINTS 3\nDATA ascii\n1 1 1\n2 2 2\n3 3 3\n",
        {"WIDTH 2", "POINTS 3"});
  c.bad("sizes.pcd", fields + "WIDTH 4294967296\nHEIGHT 4294967297\nPOINTS 0\nDATA binary\n", {"WIDTH 4294967296"});
  c.bad("sizes.pcd", fields + "WIDTH 9223372036854775807\nHEIGHT 9223372036854775807\nDATA binary\n", {"WIDTH"});
  c.bad("sizes.pcd", fields + "WIDTH 65536\nHEIGHT 65536\nPOINTS 4294967296\nDATA binary\n", {"4294967296"});
  c.bad("view.pcd", fields + "WIDTH 2\nVIEWPOINT 0 0 0 1 0 0\n" + body, {"line 5", "seven"});
  c.bad("view.pcd", fields + "WIDTH 2\nVIEWPOINT 0 0 0 1 0 0 a\n" + body, {"line 5", "'a'"});
  c.bad("view.pcd", fields + "WIDTH 2\nVIEWPOINT 0 0 0 1 0 0 0\nVIEWPOINT 1 0 0 1 0 0 0\n" + body, {"line 6", "twice"});

  const auto bad = [&](const std::string& names, const std::string& size, const std::string& type,
                       const std::string& count, const std::string& data, std::vector<std::string> parts) {
    c.bad("header.pcd", header(names, size, type, count, 1, data) + "1 2 3 4\n", std::move(parts));
  };
  bad("x y", "4 4", "F F", "1 1", "ascii", {"'z'"});
  bad("x y z x", "4 4 4 4", "F F F F", "1 1 1 1", "ascii", {"'x'", "twice"});
  bad("x y z", "4 4 4", "F F F", "1 2 1", "ascii", {"'y'"});
  bad("x y z", "4 4", "F F F", "1 1 1", "ascii", {"SIZE"});
  bad("x y z", "4 4 3", "F F F", "1 1 1", "ascii", {"SIZE 3"});
  bad("x y z", "4 4 4", "F F Q", "1 1 1", "ascii", {"TYPE Q"});
  bad("x y z w", "4 4 4 4", "F F F F", "1 1 1 -1", "ascii", {"-1"});
  bad("x y z w", "4 4 4 8", "F F F F", "1 1 1 4294967296", "binary", {"4294967296"});
  bad("x y z", "4 4 4", "F F F", "1 1 1", "morse", {"morse"});
  c.bad("fields.pcd", "FIELDS x y z\n", {"DATA"});
}

class StreamedPcd : public Files {};

TEST_F(StreamedPcd, OfManyCompressedPointsIsWhatIsRead) {
  const int points = 40'000;
  std::string planes;
  for (int i = 0; i < points; ++i) planes += bytes_of(0.5F * static_cast<float>(i % 2048));
  for (int i = 0; i < points; ++i) planes += "hi";
  for (int i = 0; i < points; ++i) planes += bytes_of(std::sin(0.1 * i));
  for (int i = 0; i < points; ++i) planes += bytes_of(static_cast<std::int16_t>(i / 100));
  for (int i = 0; i < points; ++i) planes += "end";
  const std::string packed = lzf(planes);
  ASSERT_LT(packed.size(), planes.size() * 3 / 4);
  const auto file = [&](const std::string& body) {
    return make("a.pcd",
                header("y hist x z more", "4 1 8 2 1", "F U F I U", "1 2 1 1 3", points, "binary_compressed") + body);
  };
  EXPECT_TRUE(expect_streamed_as_read(file(sized(packed, planes.size()))));
  EXPECT_FALSE(expect_streamed_as_read(file(sized(packed, planes.size()).substr(0, packed.size()))));
  EXPECT_FALSE(expect_streamed_as_read(file("")));
  for (const std::string& damaged : {packed + '\0' + 'x', packed.substr(0, packed.size() - 1), "\xff" + packed}) {
    const auto path = file(sized(damaged, planes.size()));
    EXPECT_NE(find_whole(path).error.find("damaged"), std::string::npos);
    EXPECT_NE(find_streamed(path).error.find("damaged"), std::string::npos);
  }
  EXPECT_TRUE(expect_streamed_as_read(make("a.pcd", doubles(0, "binary_compressed") + compressed(""))));
}

TEST_F(StreamedPcd, OfManyLinesIsWhatIsRead) {
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
}

TEST_F(StreamedPcd, RefusesNumbersThatDoNotFitTheirType) {
  const auto text = make("c.pcd", header("x y z", "4 4 1", "F F I", "1 1 1", 1, "ascii") + "1 2 128\n");
  EXPECT_NE(find_streamed(text).error.find("'128' does not fit"), std::string::npos);
  const auto binary = make("d.pcd", header("x y z", "8 4 4", "I F F", "1 1 1", 0, "binary"));
  EXPECT_NE(find_streamed(binary).error.find("integers of 8 bytes"), std::string::npos);
}

}  // namespace pcd_files

Cases pcd_cases() {
  using namespace pcd_files;
  Cases c;
  add_text(c), add_binary(c), add_headers(c);
  return c;
}

}  // namespace ahm::io::test

#include <sys/resource.h>
#include <zlib.h>

#include "cases.hpp"
#include "files.hpp"
#include "streamed.hpp"
#include "support/child_process.hpp"

namespace ahm::io::test {
namespace {

class ReadGzip : public Files {};

std::string gzip(std::string_view bytes) {
  z_stream stream{};
  EXPECT_EQ(::deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 9, Z_DEFAULT_STRATEGY), Z_OK);
  std::string result(::deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  EXPECT_EQ(::deflate(&stream, Z_FINISH), Z_STREAM_END);
  result.resize(stream.total_out);
  ::deflateEnd(&stream);
  return result;
}

const std::string off_triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST_F(ReadGzip, ReadsEveryFileOfEveryFormat) {
  for (const auto& [format, cases] : all_cases())
    for (const GoodFile& file : cases.good_files)
      EXPECT_EQ(contents_of(read_bytes(file.name + ".gz", gzip(file.bytes))), file.contents) << file.name;
  EXPECT_EQ(contents_of(read_bytes("A.XYZ.GZ", gzip("1 2 3\n"))), "1 2 3");
}

TEST_F(ReadGzip, RecognizesCompressedBytes) {
  EXPECT_EQ(read_bytes("a.off", gzip(off_triangle)).points.size(), 3u);
  expect_refused("a.off.gz", off_triangle, {"not compressed with gzip"});
  expect_refused("a.gz", gzip(off_triangle), {"unknown file type"});
}

TEST_F(ReadGzip, JoinsMembersAndIgnoresZerosAfterThem) {
  const std::string halves = gzip(off_triangle.substr(0, 20)) + gzip(off_triangle.substr(20));
  EXPECT_EQ(read_bytes("m.off.gz", halves).points.size(), 3u);
  EXPECT_EQ(read_bytes("m.off.gz", halves + std::string(512, '\0')).points.size(), 3u);
  expect_refused("m.off.gz", halves + "more", {"byte " + std::to_string(halves.size()), "continues"});
}

TEST_F(ReadGzip, ReadsFilesThatAreAHundredTimesLarger) {
  std::string text;
  for (int k = 0; k < 100000; ++k) text += "1 2 3\n";
  const std::string packed = gzip(text);
  ASSERT_LT(packed.size() * 100, text.size());
  EXPECT_EQ(read_bytes("g.xyz.gz", packed).points.size(), 100000u);
}

TEST_F(ReadGzip, RefusesEveryTruncation) {
  const std::string packed = gzip(off_triangle);
  for (std::size_t size = 2; size < packed.size(); ++size)
    expect_refused("t.off.gz", packed.substr(0, size), {"byte " + std::to_string(size), "cut short"});
}

TEST_F(ReadGzip, RefusesEveryChangedByte) {
  const std::string packed = gzip(off_triangle);
  constexpr std::size_t header = 10;
  for (std::size_t k = header; k < packed.size(); ++k) {
    std::string damaged = packed;
    damaged[k] = static_cast<char>(damaged[k] ^ 0x10);
    EXPECT_THROW(read_bytes("d.off.gz", damaged), IoError) << k;
  }
  std::string damaged = packed;
  damaged[packed.size() - 5] = static_cast<char>(damaged[packed.size() - 5] ^ 1);
  expect_refused("d.off.gz", damaged, {"damaged", "incorrect data check"});
}

TEST_F(ReadGzip, RefusesEmptyContents) { expect_refused("e.off.gz", gzip(""), {"empty", "unpacked"}); }

TEST_F(ReadGzip, RefusesMoreThanAThirdOfTheFreeMemory) {
#ifdef AHM_SANITIZED
  GTEST_SKIP() << "the sanitizer needs the whole address space";
#endif
  std::string bomb;
  const std::string member = gzip(std::string(8 << 20, '\n'));
  for (int k = 0; k < 32; ++k) bomb += member;
  const std::filesystem::path packed = make("bomb.xyz.gz", bomb);
  EXPECT_EQ(ahm::test::status_of_child([&] {
              std::ifstream statm("/proc/self/statm");
              rlim_t pages = 0;
              statm >> pages;
              const rlim_t bytes = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (rlim_t{256} << 20);
              const rlimit limit{bytes, bytes};
              ::setrlimit(RLIMIT_AS, &limit);
              try {
                read(packed);
                return 1;
              } catch (const ResourceExhausted& error) {
                return std::string_view(error.what()).find("third of the free memory") == std::string_view::npos ? 2
                                                                                                                 : 0;
              }
            }),
            0);
}

TEST_F(ReadGzip, StreamsWhatItReads) {
  std::string text, numbers;
  for (int i = 0; i < 50'000; ++i) {
    text += std::to_string(i * 37 % 1000) + " " + std::to_string(i) + " " + std::to_string(0.3 * i) + "\n";
    for (const float x : {1.5F * static_cast<float>(i), 2.F, -static_cast<float>(i)}) numbers += bytes_of(x);
  }
  const std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 50000\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n" +
      numbers;
  for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"a.xyz", text}, {"a.ply", binary}}) {
    const std::string packed = gzip(bytes.substr(0, 100'000)) + gzip(bytes.substr(100'000));
    EXPECT_TRUE(expect_streamed_as_read(make(name + ".gz", packed)));
    EXPECT_TRUE(expect_streamed_as_read(make(name, packed + std::string(100, '\0'))));
    EXPECT_FALSE(expect_streamed_as_read(make(name, packed + "more")));
    for (const std::size_t length : {std::size_t{3}, std::size_t{100}, packed.size() / 2, packed.size() - 1})
      EXPECT_FALSE(expect_streamed_as_read(make(name, packed.substr(0, length))));
    std::string damaged = packed;
    damaged[packed.size() - 6] = static_cast<char>(damaged[packed.size() - 6] ^ 1);
    EXPECT_FALSE(expect_streamed_as_read(make(name, damaged)));
  }
  EXPECT_FALSE(expect_streamed_as_read(make("cut.ply.gz", gzip(binary.substr(0, binary.size() - 1)))));
  EXPECT_FALSE(expect_streamed_as_read(make("e.xyz.gz", gzip(""))));
}

}  // namespace
}  // namespace ahm::io::test

#include "ahm/io/npz.hpp"

#include <gtest/gtest.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <span>

#include "files.hpp"

namespace ahm::io::test {
namespace {

class Npz : public Files {};

/// The bytes of one file of the archive; unzip checks their CRC.
std::string unzipped(const std::string& archive, const std::string& name) {
  const unzFile zip = unzOpen64(archive.c_str());
  EXPECT_NE(zip, nullptr);
  EXPECT_EQ(unzLocateFile(zip, name.c_str(), 1), UNZ_OK) << name;
  EXPECT_EQ(unzOpenCurrentFile(zip), UNZ_OK);
  std::string bytes;
  char buffer[4096];
  for (int count; (count = unzReadCurrentFile(zip, buffer, sizeof buffer)) > 0;)
    bytes.append(buffer, static_cast<std::size_t>(count));
  EXPECT_EQ(unzCloseCurrentFile(zip), UNZ_OK);
  unzClose(zip);
  return bytes;
}

template <class Stored>
std::vector<Stored> values_of(const std::string& npy, const std::string& type, const std::string& shape) {
  EXPECT_EQ(npy.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t begin = 10 + static_cast<unsigned char>(npy[8]) + 256 * static_cast<unsigned char>(npy[9]);
  EXPECT_EQ(begin % 64, 0u);
  EXPECT_EQ(npy[begin - 1], '\n');
  EXPECT_NE(npy.find("{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }"), npy.npos) << npy;
  std::vector<Stored> values((npy.size() - begin) / sizeof(Stored));
  std::ranges::copy(std::as_bytes(std::span(npy).subspan(begin)), std::as_writable_bytes(std::span(values)).begin());
  return values;
}

TEST_F(Npz, ReadsBackAsWritten) {
  const std::vector<double> x{1.5, -2, 3e-300, 4, 5, 6};
  const std::vector<std::int32_t> i{1, -2, 3};
  const std::vector<std::int64_t> o{0, std::int64_t{1} << 40};
  const std::vector<std::uint8_t> mask{1, 0, 1};
  const std::string path = this->path("a.npz");
  NpzFile file(path);
  file.add("x", {3, 2}, x);
  file.add("single", {6}, x, NpyType::float32);
  file.add("z", {3}, x, NpyType::complex128);
  file.add("i", {3}, std::span<const std::int32_t>(i));
  file.add("o", {2}, std::span<const std::int64_t>(o));
  file.add("mask", {3}, std::span<const std::uint8_t>(mask));
  file.add("none", {0, 2}, std::span<const double>());
  file.commit();
  EXPECT_EQ(values_of<double>(unzipped(path, "x.npy"), "<f8", "(3, 2)"), x);
  EXPECT_EQ(values_of<float>(unzipped(path, "single.npy"), "<f4", "(6,)"), std::vector<float>(x.begin(), x.end()));
  EXPECT_EQ(values_of<double>(unzipped(path, "z.npy"), "<c16", "(3,)"), x);
  EXPECT_EQ(values_of<std::int32_t>(unzipped(path, "i.npy"), "<i4", "(3,)"), i);
  EXPECT_EQ(values_of<std::int64_t>(unzipped(path, "o.npy"), "<i8", "(2,)"), o);
  EXPECT_EQ(values_of<std::uint8_t>(unzipped(path, "mask.npy"), "|b1", "(3,)"), mask);
  EXPECT_TRUE(values_of<double>(unzipped(path, "none.npy"), "<f8", "(0, 2)").empty());
}

TEST_F(Npz, AppearsOnCommitOrNotAtAll) {
  const std::string path = this->path("a.npz");
  { NpzFile file(path); }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST_F(Npz, RefusesOtherPlacesAndShapes) {
  EXPECT_THROW(NpzFile("/nonexistent/a.npz"), IoError);
  EXPECT_THROW(NpzFile("/dev/null"), IoError);
  NpzFile file(this->path("a.npz"));
  EXPECT_THROW(file.add("x", {4}, std::vector<double>(3)), InvalidArgument);
  EXPECT_THROW(file.add("x", {3}, std::vector<double>(3), NpyType::complex64), InvalidArgument);
}

}  // namespace
}  // namespace ahm::io::test

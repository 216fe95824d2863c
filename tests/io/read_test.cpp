// Which reader a file gets, and files that no reader gets.
#include <sys/stat.h>

#include <sstream>

#include "ahm/io/formats.hpp"
#include "cases.hpp"
#include "files.hpp"

namespace ahm::io::test {
namespace {

class Read : public Files {};

Geometry read_text(const std::string& text, const std::string& extension = {}) {
  std::istringstream stream(text);
  return read(stream, extension);
}

TEST_F(Read, RefusesWhatIsNotARegularFile) {
  expect_refused(path("absent.ply"), {"No such file"});
  std::filesystem::create_directory(path("dir.ply"));
  expect_refused(path("dir.ply"), {"it is a folder"});
  make("locked.ply", "ply\n");
  std::filesystem::permissions(path("locked.ply"), std::filesystem::perms::none);
  if (::geteuid() != 0) expect_refused(path("locked.ply"), {"Permission denied"});
  ASSERT_EQ(::mkfifo(path("pipe.ply").c_str(), 0600), 0);
  expect_refused(path("pipe.ply"), {"regular"});
  std::filesystem::create_symlink("/dev/zero", path("zero.xyz"));
  expect_refused(path("zero.xyz"), {"regular"});
}

TEST_F(Read, RefusesEmptyFilesOfEveryFormat) {
  for (const std::string& extension : extensions(Use::read)) expect_refused("e" + extension, "", {"empty"});
}

TEST_F(Read, ListsTheFormats) {
  expect_refused("a.3ds", "solid", extensions(Use::read));
  expect_refused("a.3ds", "solid", {"'.3ds'", ".stl", ".ply", ".off", ".obj", ".pcd", ".xyz", ".txt", ".csv"});
  expect_refused("a", "1 2 3\n", {".ply"});
}

TEST_F(Read, NamesToolsForOtherFormats) {
  const std::pair<const char*, const char*> tools[] = {
      {"a.ply.zip", "unzip"},  {"a.ply.xz", "unxz"}, {"a.ply.bz2", "bunzip2"},
      {"a.ply.zst", "unzstd"}, {"a.laz", "laszip"},  {"a.vtu", "save its surface as .vtp in ParaView"},
      {"a.pvtp", "ParaView"},  {"a.jsonl", ".csv"},  {"a.e57", "CloudCompare"}};
  for (const auto& [name, tool] : tools) expect_refused(name, "x", {tool});
}

TEST_F(Read, ChoosesTheFormatByExtensionOrByName) {
  EXPECT_EQ(contents_of(read_bytes("A.XYZ", "1 2 3\n")), "1 2 3");
  EXPECT_EQ(contents_of(read(make("points.dat", "1 2 3\n"), ".xyz")), "1 2 3");
}

TEST_F(Read, NamesTheVariantOfTheFormat) {
  const auto format = [&](const std::string& name, std::size_t file) {
    const GoodFile& good = all_cases().at(name).good_files[file];
    return read_bytes(good.name, good.bytes).format;
  };
  EXPECT_EQ(format("obj", 0), "OBJ");
  EXPECT_EQ(format("ply", 0), "PLY binary little endian");
  EXPECT_EQ(format("ply", 1), "PLY binary big endian");
  EXPECT_EQ(format("ply", 2), "PLY text");
  EXPECT_EQ(format("stl", 0), "STL text");
  EXPECT_EQ(format("stl", 2), "STL binary");
}

TEST_F(Read, RecognizesStreamsByTheirFirstBytes) {
  for (const auto& [format, number] : {std::pair{"off", 1}, {"ply", 0}, {"las", 0}, {"stl", 0}, {"gltf", 0}}) {
    const GoodFile& file = all_cases().at(format).good_files[static_cast<std::size_t>(number)];
    EXPECT_EQ(contents_of(read_text(file.bytes)), file.contents) << file.name;
  }
  try {
    read_text("1 2 3\n");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_EQ(error.fault(), "unknown_bytes");
  }
  EXPECT_THROW(read_text("1 2 3\n", ".nothing"), IoError);
  EXPECT_THROW(read_text("", ".xyz"), IoError);
}

TEST_F(Read, ReadsStreamsToTheirEnd) {
  std::string text;
  for (int i = 0; i < 300000; ++i) text += "1 2 " + std::to_string(i) + "\n";  // more than a block
  const Geometry g = read_text(text, ".xyz");
  ASSERT_EQ(g.points.size(), 300000u);
  EXPECT_EQ(g.points.back(), (Vec3{1, 2, 299999}));
}

}  // namespace
}  // namespace ahm::io::test

#include <sys/stat.h>

#include <clocale>

#include "ahm/io/formats.hpp"
#include "comma_locale.hpp"
#include "files.hpp"

namespace ahm::io::test {
namespace {

using ReadFile = Files;

TEST_F(ReadFile, NamesTheSystemsReason) {
  expect_refused(path("absent.ply"), {"No such file"});
  std::filesystem::create_directory(path("dir.ply"));
  expect_refused(path("dir.ply"), {"it is a folder"});
  make("locked.ply", "ply\n");
  std::filesystem::permissions(path("locked.ply"), std::filesystem::perms::none);
  if (::geteuid() != 0) expect_refused(path("locked.ply"), {"Permission denied"});
}

TEST_F(ReadFile, RefusesEmptyFilesOfEveryType) {
  for (const char* name : {"e.ply", "e.off", "e.obj", "e.xyz", "e.txt", "e.csv"}) expect_refused(name, "", {"empty"});
}

TEST_F(ReadFile, ListsTheKnownTypes) {
  expect_refused("a.3ds", "solid", extensions(Use::read));
  expect_refused("a.3ds", "solid", {"'.3ds'", ".stl", ".ply", ".off", ".obj", ".pcd", ".xyz", ".txt", ".csv"});
  expect_refused("a", "1 2 3\n", {".ply"});
}

TEST_F(ReadFile, ChoosesByExtensionInAnyCase) { EXPECT_EQ(read_bytes("A.XYZ", "1 2 3\n").points.size(), 1u); }

TEST_F(ReadFile, TellsHowToUnpackAndConvertWhatItDoesNotRead) {
  expect_refused("a.ply.zip", "PK", {"unzip"});
  expect_refused("a.ply.xz",
                 "\xfd"
                 "7zXZ",
                 {"unxz"});
  expect_refused("a.ply.bz2", "BZh", {"bunzip2"});
  expect_refused("a.ply.zst", "x", {"unzstd"});
  expect_refused("a.laz", "LASF", {"laszip"});
  expect_refused("a.vtu", "<VTKFile>", {"ParaView"});
  expect_refused("a.pvtp", "<VTKFile>", {"ParaView"});
  expect_refused("a.jsonl", "{}", {".csv"});
  expect_refused("a.e57", "ASTM-E57", {"CloudCompare"});
}

TEST_F(ReadFile, DoesNotWaitForPipesNorReadDevices) {
  ASSERT_EQ(::mkfifo(path("pipe.ply").c_str(), 0600), 0);
  expect_refused(path("pipe.ply"), {"regular"});
  std::filesystem::create_symlink("/dev/zero", path("zero.xyz"));
  expect_refused(path("zero.xyz"), {"regular"});
}

/// Everything that reads text, under the given state of the process.
class ReadsInEveryLocale : public Files {
 protected:
  void expect_right_numbers() const {
    const Vec3 p{1.5, -2.25, 1234567.5};
    EXPECT_EQ(read_bytes("l.xyz", "1.5 -2.25 1234567.5\n").points[0], p);
    EXPECT_EQ(read_bytes("l.csv", "x,y,z\n1.5,-2.25,1234567.5\n").points[0], p);
    EXPECT_EQ(read_bytes("l.off", "OFF\n1 0 0\n1.5 -2.25 1234567.5\n").points[0], p);
    EXPECT_EQ(read_bytes("l.obj", "v 1.5 -2.25 1234567.5\n").points[0], p);
    EXPECT_EQ(read_bytes("l.ply",
                         "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
                         "property double z\nend_header\n1.5 -2.25 1234567.5\n")
                  .points[0],
              p);
    expect_refused("l.xyz", "1,5 2 3\n", {"1,5"});
  }
};

TEST_F(ReadsInEveryLocale, OfTheCLibrary) {
  const char* name = nullptr;
  for (const char* candidate : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"}) {
    if (name == nullptr) name = std::setlocale(LC_ALL, candidate);
  }
  if (name == nullptr) GTEST_SKIP() << "no locale with a decimal comma is installed";
  expect_right_numbers();
  std::setlocale(LC_ALL, "C");
}

TEST_F(ReadsInEveryLocale, OfCpp) {
  const CommaLocale locale;
  expect_right_numbers();
}

}  // namespace
}  // namespace ahm::io::test

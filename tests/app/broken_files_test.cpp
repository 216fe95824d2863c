// Files that are broken, and files that only look so.
#include <gtest/gtest.h>
#include <unistd.h>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

struct Case {
  std::string name;  ///< of the test
  std::string file;
  std::string bytes;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

const std::string floats = "property float x\nproperty float y\nproperty float z\n";

std::string ply(const std::string& format, const std::string& elements, const std::string& body) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + body;
}

[[maybe_unused]] std::string pcd(const std::string& header, const std::string& body) {
  return "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + header + "DATA ascii\n" + body;
}

const std::string four = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";

const std::vector<Case> refused = {
    {"PlyCountBeyondTheFile", "a.ply",
     ply("binary_little_endian", "element vertex 4000000000\n" + floats, std::string(48, '\0'))},
    {"PlyCountOfText", "a.ply", ply("ascii", "element vertex 2000000000\n" + floats, four)},
    {"PlyTextCutShort", "a.ply", ply("ascii", "element vertex 9\n" + floats, four)},
    {"PlyBinaryCutShort", "a.ply", ply("binary_little_endian", "element vertex 9\n" + floats, std::string(100, '\0'))},
    {"PlyListBeyondTheFile", "a.ply",
     ply("ascii", "element vertex 4\n" + floats + "element face 1\nproperty list uchar int vertex_indices\n",
         four + "200 0 1 2\n")},
    {"PlyListAsVertexProperty", "a.ply",
     ply("ascii", "element vertex 4\nproperty list uchar float x\nproperty float y\nproperty float z\n", four)},
    {"PlyWithoutZ", "a.ply",
     ply("ascii", "element vertex 4\nproperty float x\nproperty float y\n", "0 0\n1 0\n0 1\n1 1\n")},
    {"PlyWithTwoX", "a.ply",
     ply("ascii", "element vertex 4\nproperty float x\n" + floats, "0 0 0 0\n1 1 0 0\n0 0 1 0\n1 1 1 0\n")},
    {"PlyFaceOutOfRange", "a.ply",
     ply("ascii", "element vertex 4\n" + floats + "element face 1\nproperty list uchar int vertex_indices\n",
         four + "3 0 1 4\n")},
    {"PlyNumberTooLarge", "a.ply",
     ply("ascii", "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n",
         "0 0 0\n1e400 0 0\n0 1 0\n1 1 0\n")},
    {"ObjFaceOutOfRange", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 5\n"},
    {"ObjFaceZero", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 0 1 2\n"},
    {"OffFaceOutOfRange", "a.off", "OFF\n4 1 0\n" + four + "3 0 1 4\n"},
    {"OffCutShort", "a.off", "OFF\n9 1 0\n" + four},
    {"OffCountBeyondTheFile", "a.off", "OFF\n2000000000 1 0\n" + four},
    {"XyzDecimalComma", "a.xyz", "0 0 0\n1,5 0 0\n0 1 0\n1 1 0\n"},
    {"XyzWord", "a.xyz", "0 0 0\n1 zero 0\n0 1 0\n"},
    {"XyzTwoColumns", "a.xyz", "0 0\n1 0\n0 1\n"},
    {"XyzNumberTooLarge", "a.xyz", "0 0 0\n1e400 0 0\n0 1 0\n1 1 0\n"},
    {"Empty", "a.ply", ""},
    {"EmptyXyz", "a.xyz", ""},
    {"EmptyObj", "a.obj", ""},
    {"NoPoints", "a.ply", ply("ascii", "element vertex 0\n" + floats, "")},
    {"UnknownType", "a.docx", four},
    {"NoType", "a", four},
#ifdef AHM_WITH_PCL
    {"PcdSizesDisagree", "a.pcd", pcd("WIDTH 2\nHEIGHT 3\nPOINTS 4\n", four)},
    {"PcdProductOverflows", "a.pcd", pcd("WIDTH 65536\nHEIGHT 65536\nPOINTS 0\n", four)},
    {"PcdCountBeyondTheFile", "a.pcd", pcd("WIDTH 2000000000\nHEIGHT 1\nPOINTS 2000000000\n", four)},
    {"PcdCutShort", "a.pcd", pcd("WIDTH 9\nHEIGHT 1\nPOINTS 9\n", four)},
#endif
};

class BrokenFile : public testing::TestWithParam<Case> {};

TEST_P(BrokenFile, IsRefusedByNameAndLeavesNothing) {
  Folder folder;
  const auto input = folder.write(GetParam().file, GetParam().bytes);
  for (const Words& words : {Words{"logmap", input, "--source", "0", "-o", folder / "map.csv"}, Words{"info", input}}) {
    const auto outcome = run(words);
    if (words[0] == "info" && GetParam().name == "NoPoints") continue;  // a file like others to a doctor
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_EQ(outcome.err.substr(0, 12), "ahm: error: ") << outcome.err;
    EXPECT_NE(outcome.err.find(GetParam().file), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(folder.files(), Words{GetParam().file});
  }
}

INSTANTIATE_TEST_SUITE_P(Every, BrokenFile, testing::ValuesIn(refused),
                         [](const auto& info) { return info.param.name; });

TEST(Files, DirectoriesAndMissingOnesAreRefusedWithTheReason) {
  Folder folder;
  std::filesystem::create_directory(folder / "a.ply");
  const auto directory = run({"logmap", folder / "a.ply", "--source", "0", "-o", folder / "map.csv"});
  EXPECT_EQ(directory.status, 1);
  EXPECT_NE(directory.err.find("it is a folder"), std::string::npos) << directory.err;
  const auto unnamed = run({"logmap", folder / "", "--source", "0", "-o", folder / "map.csv"});
  EXPECT_EQ(unnamed.status, 1);
  EXPECT_NE(unnamed.err.find("it is a folder"), std::string::npos) << unnamed.err;
  const auto missing = run({"logmap", folder / "b.ply", "--source", "0", "-o", folder / "map.csv"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.err.find("No such file"), std::string::npos) << missing.err;
  EXPECT_EQ(folder.files(), Words{"a.ply"});
}

TEST(Files, UnreadableOnesAreRefusedWithTheReason) {
  if (geteuid() == 0) GTEST_SKIP() << "root reads everything";
  Folder folder;
  const auto input = folder.write("a.xyz", four);
  std::filesystem::permissions(input, std::filesystem::perms::none);
  const auto outcome = run({"logmap", input, "--source", "0", "-o", folder / "map.csv"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("ermission"), std::string::npos) << outcome.err;
}

TEST(Files, UnusualButValidOnesAreRead) {
  std::string crlf, extra;
  for (const Vec3& p : sphere(300)) {
    const auto xyz_text = std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]);
    crlf += xyz_text + "\r\n";
    extra += "7 " + xyz_text + " 9\n";
  }
  const std::vector<std::pair<std::string, std::string>> files = {
      {"crlf.xyz", crlf},
      {"extra.ply", ply("ascii",
                        "comment made by hand\nelement camera 1\nproperty float f\nproperty list uchar int "
                        "tags\nelement vertex 300\nproperty uchar quality\n" +
                            floats + "property int label\n",
                        "35 3 1 2 3\n" + extra)}};
  for (const auto& [name, bytes] : files) {
    Folder folder;
    const auto outcome = run({"logmap", folder.write(name, bytes), "--source", "0", "-o", folder / "map.csv"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const auto rows = read_numbers(folder / "map.csv");
    EXPECT_EQ(rows.size(), 300U) << name;
    if (!name.starts_with("extra")) continue;
    EXPECT_EQ(rows.back().at("input_quality"), 7);  // the map has a quality of its own
    EXPECT_EQ(rows.back().at("input_label"), 9);
    EXPECT_NE(rows.back().at("quality"), 7);
  }
}

TEST(Files, FacesAreIgnoredAloud) {
  Folder folder;
  std::string obj;
  for (const Vec3& p : sphere(300))
    obj += "v " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
  const auto input = folder.write("mesh.obj", obj + "vt 0 0\nf 1 2 3\nf -1 -2 -3\n");
  const auto outcome = run({"logmap", input, "--source", "0", "-o", folder / "map.csv", "--backend", "pointcloud"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("faces"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace ahm::test

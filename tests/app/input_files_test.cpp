// Input files: broken ones are rejected, unusual ones are read.
#include <unistd.h>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

struct Case {
  std::string name;  ///< of the test
  std::string file;
  std::string bytes;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

const std::string floats = "property float x\nproperty float y\nproperty float z\n";
const std::string one_face = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string four = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
const std::string four_v = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";

std::string raw_ply(const std::string& format, const std::string& elements, const std::string& body) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + body;
}

[[maybe_unused]] std::string pcd(const std::string& header, const std::string& body) {
  return "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + header + "DATA ascii\n" + body;
}

const std::vector<Case> broken = {
    {"PlyCountBeyondTheFile", "a.ply",
     raw_ply("binary_little_endian", "element vertex 4000000000\n" + floats, std::string(48, '\0'))},
    {"PlyCountOfText", "a.ply", raw_ply("ascii", "element vertex 2000000000\n" + floats, four)},
    {"PlyTextCutShort", "a.ply", raw_ply("ascii", "element vertex 9\n" + floats, four)},
    {"PlyBinaryCutShort", "a.ply",
     raw_ply("binary_little_endian", "element vertex 9\n" + floats, std::string(100, '\0'))},
    {"PlyListBeyondTheFile", "a.ply", raw_ply("ascii", "element vertex 4\n" + floats + one_face, four + "200 0 1 2\n")},
    {"PlyListAsVertexProperty", "a.ply",
     raw_ply("ascii", "element vertex 4\nproperty list uchar float x\nproperty float y\nproperty float z\n", four)},
    {"PlyWithoutZ", "a.ply",
     raw_ply("ascii", "element vertex 4\nproperty float x\nproperty float y\n", "0 0\n1 0\n0 1\n1 1\n")},
    {"PlyWithTwoX", "a.ply",
     raw_ply("ascii", "element vertex 4\nproperty float x\n" + floats, "0 0 0 0\n1 1 0 0\n0 0 1 0\n1 1 1 0\n")},
    {"PlyFaceOutOfRange", "a.ply", raw_ply("ascii", "element vertex 4\n" + floats + one_face, four + "3 0 1 4\n")},
    {"PlyNumberTooLarge", "a.ply",
     raw_ply("ascii", "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n",
             "0 0 0\n1e400 0 0\n0 1 0\n1 1 0\n")},
    {"ObjFaceOutOfRange", "a.obj", four_v + "f 1 2 5\n"},
    {"ObjFaceZero", "a.obj", four_v + "f 0 1 2\n"},
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
    {"NoPoints", "a.ply", raw_ply("ascii", "element vertex 0\n" + floats, "")},
    {"UnknownType", "a.docx", four},
    {"NoType", "a", four},
#ifdef AHM_WITH_PCL
    {"PcdSizesDisagree", "a.pcd", pcd("WIDTH 2\nHEIGHT 3\nPOINTS 4\n", four)},
    {"PcdProductOverflows", "a.pcd", pcd("WIDTH 65536\nHEIGHT 65536\nPOINTS 0\n", four)},
    {"PcdCountBeyondTheFile", "a.pcd", pcd("WIDTH 2000000000\nHEIGHT 1\nPOINTS 2000000000\n", four)},
    {"PcdCutShort", "a.pcd", pcd("WIDTH 9\nHEIGHT 1\nPOINTS 9\n", four)},
#endif
};

class BrokenFile : public InFolder, public testing::WithParamInterface<Case> {};

TEST_P(BrokenFile, IsRejectedByName) {
  const auto& [name, file, bytes] = GetParam();
  write(file, bytes);
  expect_refused("logmap", {{file + " --source 0 -o map.csv", 1, {file}}});
  if (name == "NoPoints") return;  // info reports on it
  expect_refused("info", {{file, 1, {file}}});
}

INSTANTIATE_TEST_SUITE_P(Every, BrokenFile, testing::ValuesIn(broken),
                         [](const auto& info) { return info.param.name; });

using InputFile = InFolder;

TEST_F(InputFile, ErrorsHaveTheReasonOfTheSystem) {
  std::filesystem::create_directory("a.ply");
  expect_refused("logmap --source 0 -o map.csv",
                 {{"a.ply", 1, {"it is a folder"}}, {"./", 1, {"it is a folder"}}, {"b.ply", 1, {"No such file"}}});
  const Outcome folder = finish(start("info - --input-format xyz", false, "."));
  EXPECT_EQ(folder.status, 1);
  EXPECT_TRUE(has(folder.err, "Is a directory"));
  if (geteuid() == 0) GTEST_SKIP() << "root can read every file";
  write("a.xyz", four);
  std::filesystem::permissions("a.xyz", std::filesystem::perms::none);
  expect_refused("logmap a.xyz", {{"--source 0 -o map.csv", 1, {"ermission"}}});
}

TEST_F(InputFile, OfAnUnusualKindIsRead) {
  std::string crlf, columns;
  for (const Vec3& p : sphere(300)) {
    const std::string text = std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]);
    crlf += text + "\r\n";
    columns += "7 " + text + " 9\n";
  }
  write("crlf.xyz", crlf);
  EXPECT_EQ(table("logmap crlf.xyz --source 0").size(), 300U);
  write("columns.ply",
        raw_ply("ascii",
                "comment made by hand\nelement camera 1\nproperty float f\nproperty list uchar int tags\n"
                "element vertex 300\nproperty uchar quality\n" +
                    floats + "property int label\n",
                "35 3 1 2 3\n" + columns));
  const auto rows = table("logmap columns.ply --source 0");
  ASSERT_EQ(rows.size(), 300U);
  EXPECT_EQ(rows.back()["input_quality"], 7);  // the map has its own quality
  EXPECT_EQ(rows.back()["input_label"], 9);
  EXPECT_NE(rows.back()["quality"], 7);
}

TEST_F(InputFile, WithIgnoredFacesIsReported) {
  write("mesh.obj", obj(sphere(300), {}) + "vt 0 0\nf 1 2 3\nf -1 -2 -3\n");
  EXPECT_TRUE(has(run_ok("logmap mesh.obj --source 0 -o map.csv --backend pointcloud").err, "faces"));
}

TEST_F(InputFile, AtStandardInputNeedsAFormat) {
  write("plane.xyz", xyz(plane(12)));
  table("logmap plane.xyz -s 5");
  const std::string command = "logmap - -s 5 -o piped.csv";
  const Outcome outcome = finish(start(command + " --input-format xyz", false, "plane.xyz"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_text("piped.csv"), read_text("table.csv"));
  const Outcome unknown = finish(start(command, false, "plane.xyz"));
  EXPECT_EQ(unknown.status, 1);
  EXPECT_TRUE(has(unknown.err, "--input-format"));
}

}  // namespace
}  // namespace ahm::test

// Text is streamed as it is read: every dialect, every fault, every cut.
#include "files.hpp"
#include "streamed.hpp"

namespace ahm::io::test {
namespace {

using StreamedText = Files;

/// Files of columns: what `read` takes, and what it refuses.
const std::vector<std::pair<std::string, std::string>> columns = {
    {"a.xyz", "1 2 3\n4 5 6\n7 8 9"},
    {"b.xyz", "# utm\n431234.567891 5412345.678912 12\n\n  +1 -2e-3\t.5  # tail\r\n"},
    {"c.txt", "1 2 3 0 0 1\n4 5 6 0 1 0\n"},
    {"d.txt", "1 2 3 0 0 1\n4 5 6 200 1 0\n"},
    {"e.asc", "1;2;3;9\n4;5;6;9\n"},
    {"f.csv", "x,y,z,nx,ny,nz,class\n1,2,3,0,0,1,a\n4,5,6,0,0,1,b\n"},
    {"g.csv", "z\ty\tx\tmore\n1\t2\t3\t\n4\t5\t6\t7\n"},
    {"h.csv", "\xEF\xBB\xBF\"x\",\"y\",\"z\"\n1,2,3\n"},
    {"i.pts", "2\n1 2 3 -17 200 10 20\n4 5 6 99 0 0 0\n1\n7 8 9 1 1 1 1\n"},
    {"j.pts", "2\n1 2 3 4\n5 6 7 8\n"},
    {"k.pts", "1\n1 2 3 4\n5 6 7 8\n"},
    {"l.xyz", "//X Y Z R G B Nx Ny Nz\n1 2 3 9 9 9 0 0 1\n"},
    {"m.xyz", "1 2 3 4 5 6 7 8 9\n1 2 3 200 5 6 200 8 9\n"},
    {"n.xyz", "nan inf -inf\n1 2 3\n"},
    {"o.xyz", "1 2 3\r4 5 6\r7 8 9\r"},
    {"p.xyz", "1 2 3\n4 5\n"},
    {"q.xyz", "1 2 3\n4 five 6\n"},
    {"r.xyz", "1,5 2,5 3,5\n"},
    {"s.xyz", "1 2 1e400\n"},
    {"t.xyz", "1 2 3 x 0 1\n"},
    {"u.pts", "1 2 3 high\n"},
    {"v.csv", "x,y\n1,2\n"},
    {"w.csv", "x,y,z\n"},
    {"x.xyz", "# nothing\n"},
    {"y.xyz", ""},
    {"z.xyz.gz", "1 2 3\n"},
};

TEST_F(StreamedText, OfColumnsIsWhatIsRead) {
  int good = 0;
  for (const auto& [name, text] : columns) good += expect_streamed_as_read(make(name, text));
  EXPECT_EQ(good, 13);
}

TEST_F(StreamedText, OfColumnsCutAnywhereIsWhatIsRead) {
  for (const auto& [name, text] : columns)
    for (std::size_t length = 0; length < text.size(); ++length)
      expect_streamed_as_read(make(name, text.substr(0, length)));
}

std::string ply(const std::string& elements, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}

const std::string xyz = "property float x\nproperty double y\nproperty int z\n";

TEST_F(StreamedText, OfPlyIsWhatIsRead) {
  const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n",
                    colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::vector<std::string> files = {
      ply("element vertex 3\n" + xyz, "1 2 3\n.1 .2 3\nnan inf -4\n"),
      ply("element vertex 2\n" + xyz + normals, "1 2 3 0 0 1\n4 5 6 0 1 0\n"),
      ply("element camera 1\nproperty list uchar int of\nelement vertex 1\n" + xyz + "element more 2\nproperty int a\n",
          "3 1 2 3\n1 2 3\n7\n8\nand more\n"),
      ply("element vertex 1\n" + colors + xyz, "1 2 3 4 5 6\n"),
      ply("element vertex 0\n" + xyz, ""),
      ply("element vertex 1\n" + colors + xyz, "256 2 3 4 5 6\n"),
      ply("element vertex 2\n" + xyz, "1 2 3\n4 5\n"),
      ply("element vertex 2\n" + xyz, "1 2 3\n4 5 6 7\n"),
      ply("element vertex 2\n" + xyz, "1 2 3\n4 5 6,5\n"),
      ply("element vertex 2\n" + xyz + "element more 1\nproperty int a\n", "1 2 3\n4 5 6\nx\n"),
      ply("element vertex 1\n" + xyz + "property list uchar int of\n", "1 2 3 0\n"),
      ply("element vertex 1\nproperty float x\nproperty float y\n", "1 2\n"),
      ply("element point 1\n" + xyz, "1 2 3\n"),
  };
  int good = 0;
  for (const std::string& text : files) {
    good += expect_streamed_as_read(make("a.ply", text));
    for (std::size_t length = text.find("end_header") + 5; length < text.size(); ++length)
      expect_streamed_as_read(make("a.ply", text.substr(0, length)));
  }
  EXPECT_EQ(good, 7);
  EXPECT_NE(find_streamed(make("a.ply", ply("element vertex 1\n" + xyz +
                                                "element face 1\nproperty list uchar int vertex_indices\n",
                                            "1 2 3\n3 0 0 0\n")))
                .error.find("faces"),
            std::string::npos);
}

/// Longer than what is in memory at a time, with lines of many lengths.
TEST_F(StreamedText, OfManyBlocksIsWhatIsRead) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (int i = 0; i < 60'000; ++i)
      text += std::to_string(0.1 * i) + std::string(i % 13, ' ') + " -" + std::to_string(i) + " 1e" +
              std::to_string(i % 200) + end;
    EXPECT_TRUE(expect_streamed_as_read(make("a.xyz", text)));
    EXPECT_TRUE(expect_streamed_as_read(make("a.ply", ply("element vertex 60000\nproperty double x\n"
                                                          "property double y\nproperty double z\n",
                                                          text))));
    EXPECT_FALSE(expect_streamed_as_read(make("b.xyz", text + "1 2 x" + end)));
  }
}

TEST_F(StreamedText, LeavesNoFileBehind) {
  const auto file = make("a.xyz", "1 2 3\n4 5 6\n");
  PointStream stream(file, file.parent_path());
  EXPECT_EQ(stream.size(), 2u);
  EXPECT_EQ(files_left(), 1u);
  EXPECT_THROW(PointStream(file, file.parent_path() / "none"), IoError);
}

}  // namespace
}  // namespace ahm::io::test

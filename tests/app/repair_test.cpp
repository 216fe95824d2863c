// Meshes that cannot be mapped say which option mends them, and with it they are, row by row of the file.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

/// A flat m x m grid in the unit square, every triangle with vertices of its own; then more statements.
std::string torn_sheet(int m, const std::string& more = "") {
  std::ostringstream text;
  text.precision(17);
  int vertices = 0;
  for (int j = 0; j + 1 < m; ++j)
    for (int i = 0; i + 1 < m; ++i)
      for (const bool upper : {false, true}) {
        for (const auto& [x, y] : {std::pair{i, j}, upper ? std::pair{i + 1, j + 1} : std::pair{i + 1, j},
                                   upper ? std::pair{i, j + 1} : std::pair{i + 1, j + 1}})
          text << "v " << x / (m - 1.0) << ' ' << y / (m - 1.0) << " 0\n";
        text << "f " << vertices + 1 << ' ' << vertices + 2 << ' ' << vertices + 3 << '\n';
        vertices += 3;
      }
  return text.str() + more;
}

class Repair : public testing::Test {
 protected:
  Folder folder;

  Outcome map(const std::string& input, Words more, const std::string& source = "0") {
    Words words{"logmap", input, "--source=" + source, "-o", folder / "map.csv", "--json", folder / "map.json"};
    words.insert(words.end(), more.begin(), more.end());
    return ahm::test::run(words);
  }

  void expect_plane(const Outcome& outcome) {
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto rows = read_csv(folder / "map.csv");
    for (const Row& row : rows) {
      ASSERT_EQ(row.status, "ok");
      EXPECT_NEAR(row.distance,
                  std::hypot(row.position[0] - rows[0].position[0], row.position[1] - rows[0].position[1]), 1e-9);
    }
  }
};

TEST_F(Repair, MapsATornSheetAsThePlaneItIs) {
  const auto input = folder.write("torn.obj", torn_sheet(9));
  expect_plane(map(input, {"--weld", "0"}));
  expect_plane(map(input, {"--repair"}));
  EXPECT_EQ(read_json(folder / "map.json").at("trimesh").at("repair").at("welded"), 384 - 81);
}

TEST_F(Repair, CountsTheFacesOfTheFileAndSpeaksOfOneAndOfSeveral) {
  const auto input = folder.write("twice.obj", torn_sheet(5, "f 1 2 3\nv 7 7 7\n"));
  const Outcome outcome = map(input, {"--repair"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = read_json(folder / "map.json");
  EXPECT_EQ(json.at("input").at("faces"), 33);
  EXPECT_EQ(json.at("trimesh").at("faces"), 32);
  EXPECT_NE(outcome.err.find(" 1 duplicate face was dropped\n"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(" 1 vertex that no face uses was left out\n"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(" 71 vertices were joined "), std::string::npos) << outcome.err;
}

TEST_F(Repair, IsNamedWhereAMeshIsRefusedAndThenMapsIt) {
  for (const auto& [more, option] :
       {std::pair<std::string, std::string>{"f 1 1 2\n", "--drop-degenerate"}, {"f 1 2 3\n", "--drop-duplicates"}}) {
    const auto input = folder.write("bad.obj", torn_sheet(5, more));
    const auto refused = map(input, {});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find(option), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("--repair"), std::string::npos) << refused.err;
    EXPECT_EQ(map(input, {option}).status, 0);
    expect_plane(map(input, {"--repair"}));
  }
}

TEST_F(Repair, CountsFacesOfTheFileInSources) {
  // Face 32 is dropped, face 33 lies elsewhere.
  const auto spoilt = folder.write("spoilt.obj", torn_sheet(5, "f 1 1 2\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n"));
  const auto last = map(spoilt, {"--repair"}, "face:33:1,0,0");
  ASSERT_EQ(last.status, 0) << last.err;
  EXPECT_EQ(read_json(folder / "map.json").at("source").at("position")[0], 5.0);
  const auto dropped = map(spoilt, {"--repair"}, "face:32:1,0,0");
  EXPECT_EQ(dropped.status, 1);
  EXPECT_NE(dropped.err.find("face:32"), std::string::npos) << dropped.err;
}

TEST_F(Repair, CutsWhatIsNoManifold) {
  const auto pages =
      folder.write("pages.obj", "v 0 0 0\nv 0 0 1\nv 1 0 0\nv -1 1 0\nv -1 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
  EXPECT_NE(map(pages, {}).err.find("--repair"), std::string::npos);
  EXPECT_EQ(map(pages, {"--repair"}).status, 0);
}

TEST_F(Repair, IsForMeshes) {
  const auto cloud = folder.write("cloud.xyz", xyz(plane(5)));
  const auto refused = map(cloud, {"--repair"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("no faces"), std::string::npos) << refused.err;
  const auto sheet = folder.write("sheet.obj", torn_sheet(5));
  EXPECT_EQ(map(sheet, {"--repair", "--backend", "pointcloud"}).status, 1);
  EXPECT_EQ(map(sheet, {"--weld=-1"}).status, 2);
}

TEST_F(Repair, IsSuggestedByInfoWhereItHelps) {
  const auto suggestion_for = [&](const std::string& obj) {
    const auto input = folder.write("mesh.obj", obj);
    EXPECT_EQ(ahm::test::run({"info", input, "--json", folder / "info.json"}).status, 0);
    return read_json(folder / "info.json");
  };
  const auto torn = suggestion_for(torn_sheet(5));
  EXPECT_EQ(torn.at("repair").at("welded"), 96 - 25);
  EXPECT_EQ(torn.at("repair").at("parts"), 1);
  EXPECT_NE(torn.at("suggestion").get<std::string>().find(" --repair"), std::string::npos);
  const auto twice = suggestion_for(torn_sheet(5, "f 1 2 3\n"));
  EXPECT_EQ(twice.at("repair").at("duplicates"), 1);
  const auto sound = suggestion_for("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  EXPECT_EQ(sound.at("suggestion").get<std::string>().find(" --repair"), std::string::npos);
}

TEST_F(Repair, SentencesAboutOneAreAboutOne) {
  const auto one = map(folder.write("one.obj", torn_sheet(5, "f 1 1 2\n")), {});
  EXPECT_NE(one.err.find("1 face uses a vertex twice"), std::string::npos) << one.err;
  const auto two = map(folder.write("two.obj", torn_sheet(5, "f 1 1 2\nf 2 2 1\n")), {});
  EXPECT_NE(two.err.find("2 faces use a vertex twice"), std::string::npos) << two.err;
}

}  // namespace
}  // namespace ahm::test

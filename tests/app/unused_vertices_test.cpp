// The program maps meshes with vertices that are not finite, if no face uses them; and it reports what readers skipped.
#include <gtest/gtest.h>

#include <cmath>

#include "program.hpp"
#include "sheet.hpp"

namespace ahm::test {
namespace {

TEST(UnusedVertices, AreRemovedRowsAlsoWhereNotFinite) {
  Folder folder;
  const std::string input = folder.write("mesh.obj", sheet(8) + "v nan 0 0\nv inf -inf 0\n");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--repair"}, {"--method", "heat"}, {"--backend", "polymesh"}}) {
    std::vector<std::string> words{"logmap",           input,    "--source=3",      "-o",
                                   folder / "map.csv", "--view", folder / "map.png"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto rows = read_csv(folder / "map.csv");
    ASSERT_EQ(rows.size(), 66u);
    EXPECT_EQ(rows[63].status, "ok");
    for (const std::size_t i : {std::size_t{64}, std::size_t{65}}) {
      EXPECT_EQ(rows[i].status, "removed");
      EXPECT_TRUE(std::isnan(rows[i].u));
    }
  }
  EXPECT_EQ(run({"logmap", input, "--source=64", "-o", folder / "map.csv"}).status, 1);
}

TEST(SkippedLines, AreReportedOnce) {
  Folder folder;
  const std::string input = folder.write("mesh.obj", "$ by hand\n" + sheet(8) + "zebra 1\n");
  const Outcome outcome = run({"logmap", input, "--source=3", "-o", folder / "map.csv"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("2 lines are not understood and were skipped; the first is line 1: '$ by hand'"),
            std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace ahm::test

// Meshes with vertices that no face uses, and files with lines that readers skip.
#include <cmath>
#include <span>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

using UnusedVertices = InFolder;

TEST_F(UnusedVertices, AreRemovedRowsAlsoIfNotFinite) {
  write("mesh.obj", sheet(8) + "v nan 0 0\nv inf -inf 0\n");
  for (const std::string options : {"", "--repair", "--method heat", "--backend polymesh"}) {
    const auto rows = table("logmap mesh.obj --source 3 --view map.png " + options);
    EXPECT_EQ(count(rows, "removed"), 2U) << options;
    for (const Row& row : std::span(rows).last(2)) EXPECT_TRUE(row.status == "removed" && std::isnan(row["u"]));
    EXPECT_EQ(count(rows, "ok"), rows.size() - 2) << options;
  }
  expect_refused("logmap mesh.obj -o map.csv", {{"--source 64", 1, {"64"}}});
}

TEST_F(UnusedVertices, AreNotConfusedWithSkippedLines) {
  write("mesh.obj", "$ by hand\n" + sheet(8) + "zebra 1\n");
  EXPECT_TRUE(has(run_ok("logmap mesh.obj --source 3 -o map.csv").err, "2 lines", "line 1: '$ by hand'"));
}

}  // namespace
}  // namespace ahm::test

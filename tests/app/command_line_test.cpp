// Command lines: refusals of every subcommand, help, and version.
#include <cstdlib>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

class CommandLine : public InFolder {
 protected:
  CommandLine() {
    write("cloud.xyz", xyz(sphere(200)));
    write("plane.xyz", xyz(plane(10)));
    write("cube.off", cube_and_square);
  }
};

TEST_F(CommandLine, NumbersAreChecked) {
  const std::map<std::string, Words> values{{"--k", {"2", "-5", "3.5", "ten", "99999999999", "''"}},
                                            {"--t-coef", {"0", "-1", "nan", "inf", "1,5", "1e400", "1x", "0x1p3"}},
                                            {"--radius", {"0", "-2", "nan", "inf"}},
                                            {"--voxel", {"0", "-0.1", "nan"}},
                                            {"--threads", {"-1", "two"}},
                                            {"--u-axis", {"1,2", "0,0,0", "1,nan,0"}},
                                            {"--smooth", {"on"}}};
  for (const auto& [option, bad] : values)
    for (const std::string& value : bad)
      expect_refused("logmap cloud.xyz --source 0 -o map.csv", {{option + " " + value, 2, {option}}});
}

TEST_F(CommandLine, SourcesAreChecked) {
  for (const std::string source : {"", "abc", "-1", "1.5", "99999999999", "1,2", "1,2,3,4", "1,nan,3", "1,,3", "face:1",
                                   "face:x:1,0,0", "face:0:0.5,0.5,0.5", "face:0:-1,1,1", "face:0:1,0"})
    expect_refused("logmap cloud.xyz -o map.csv", {{"'--source=" + source + "'", 2, {"--source"}}});
}

TEST_F(CommandLine, OptionsOfMapsAreChecked) {
  expect_refused("logmap cloud.xyz -o map.csv",
                 {{"", 2, {"--source"}},
                  {"--source 200", 1, {"200"}},
                  {"--source face:0:1,0,0", 1, {"face:0"}},
                  {"--sources nowhere.txt", 2, {"--sources", "no file", "nowhere.txt"}}});
  expect_refused("logmap cloud.xyz --source 0 -o map.csv",
                 {{"--variant fast", 2, {"--variant", "fast"}},
                  {"--backend grid", 2, {"--backend", "grid"}},
                  {"--knn annoy", 2, {"--knn", "annoy"}},
                  {"--normals up", 2, {"--normals", "up"}},
                  {"--ordering metis", 2, {"--ordering", "metis"}},
                  {"--factor umfpack", 2, {"--factor", "umfpack"}},
                  {"--factor cholmod --ordering amd", 2, {"--ordering", "--factor cholmod"}},
                  {"--factor cholmod --strategy march", 2, {"--factor", "march"}},
                  {"--frobnicate", 2, {"--frobnicate"}},
                  {"--view map.jpg", 2, {"--view"}},
                  {"--local", 2, {"--local", "--radius"}},
                  {"--strategy global --accuracy 1e-3", 2, {"--accuracy"}},
                  {"--weld=-1", 2, {"--weld"}},
                  {"--backend trimesh", 1, {"trimesh"}},
                  {"--backend polymesh", 1, {"polymesh"}},
                  {"--no-flips", 1, {"--no-flips"}},
                  {"--non-manifold split", 1, {"--non-manifold"}},
                  {"--discretization polygons", 1, {"--discretization"}},
                  {"--repair", 1, {"--repair", "no faces"}},
                  {"--normals oriented", 1, {"--normals oriented"}},
                  {"--u-axis 0,0,1", 1, {"--u-axis"}},
                  {"--radius 1e-9 --local", 1, {"1 point", "1.5e-09", "source 0"}}});
}

TEST_F(CommandLine, OutputsAreCheckedBeforeTheWork) {
  expect_refused("logmap cloud.xyz --source 0", {{"", 2, {"--output"}},
                                                 {"-o map.stl", 1, {".stl"}},
                                                 {"-o map", 1, {"map"}},
                                                 {"-o map.obj", 1, {"--corners map.obj"}},
                                                 {"-o map.glb", 1, {"--corners map.glb"}},
                                                 {"-o nowhere/map.csv", 1, {"nowhere"}},
                                                 {"-o nowhere/maps/", 1, {"nowhere"}},
                                                 {"-o cloud.xyz", 1, {"cloud.xyz"}},
                                                 {"-o map.csv --json cloud.xyz", 1, {"--json"}},
                                                 {"-o map.csv --json ./map.csv", 1, {"same file"}},
                                                 {"-o map.csv --view nowhere/map.png", 1, {"nowhere"}}});
  // Links: to the input, and to an output that does not exist yet.
  std::filesystem::create_symlink("cloud.xyz", "input.csv");
  std::filesystem::create_symlink("map.csv", "output.csv");
  expect_refused("logmap cloud.xyz --source 0 -o",
                 {{"input.csv", 1, {"input"}}, {"map.csv --json output.csv", 1, {"the same file"}}});
}

TEST_F(CommandLine, SubcommandsAreChecked) {
  expect_refused("", {{"", 2, {"subcommand"}}, {"frobnicate", 2, {"frobnicate"}}});
  expect_refused("logmap", {{"--source 0 -o map.csv", 2, {"INPUT"}}});
  expect_refused("completion", {{"csh", 2, {"bash, zsh or fish"}}});
  expect_refused("manual", {{"nothing", 2, {"'nothing'"}}});
  write("cloud.dat", xyz(sphere(10)));
  expect_refused("info", {{"cloud.dat", 1, {"'.dat'", "--input-format"}}});
}

TEST_F(CommandLine, OfCellsIsChecked) {
  expect_refused("cells plane.xyz -o cells.csv", {{"", 2, {"--sources"}},
                                                  {"--sources 1 --count 2", 2, {"--count"}},
                                                  {"--sources 1 --start 2", 2, {"--count"}},
                                                  {"--count 0", 2, {"--count"}},
                                                  {"--count 101", 1, {"--count 101"}},
                                                  {"--sources '1 x'", 2, {"'x'"}},
                                                  {"--sources '1 100'", 1, {"--sources 100"}},
                                                  {"--sources '1 2 1'", 1, {"once"}},
                                                  {"--sources face:0:1,0,0", 1, {"--sources face"}}});
}

TEST_F(CommandLine, OfCentersIsChecked) {
  expect_refused("center plane.xyz", {{"", 2, {"--points"}},
                                      {"--points '1 -2'", 2, {"-2"}},
                                      {"--points '1 200'", 1, {"--points 200"}},
                                      {"--points '1 2' --weights 1", 1, {"--weights"}},
                                      {"--points '1 2' --weights '1 x'", 2, {"--weights"}},
                                      {"--points '1 2' --weights '1 -1'", 1, {"weight"}},
                                      {"--points face:0:1,0,0", 1, {"--points face"}},
                                      {"--points '1 2' --start 100", 1, {"--start 100"}},
                                      {"--points '1 2' --json nowhere/x.json", 1, {"nowhere"}}});
}

TEST_F(CommandLine, OfToolPathsAndInverseMapsIsChecked) {
  expect_refused("coverage plane.xyz", {{"-s 0 --radius 1 -o p.csv", 2, {"--spacing"}},
                                        {"-s 0 --radius 0 --spacing 1 -o p.csv", 2, {"--radius"}},
                                        {"-s 0 --radius 1 --spacing 1 --pattern x -o p.csv", 2, {"--pattern"}},
                                        {"-s 0 --radius 1 --spacing 1 -o path.pcd", 1, {"path.pcd"}},
                                        {"-s 100 --radius 1 --spacing 1 -o p.csv", 1, {"100"}},
                                        {"-s 0 --radius 1 --spacing 1e-9 -o p.csv", 1, {"2^30", "spacing"}}});
  expect_refused("inverse plane.xyz -s 0", {{"--at 1,2,3 -o o.csv", 2, {"1,2,3"}},
                                            {"--at '' -o o.csv", 2, {"--at"}},
                                            {"--at 1,nan -o o.csv", 2, {"nan"}},
                                            {"--at 0,0 -o o.obj", 1, {"o.obj"}},
                                            {"--at 0,0 --local -o o.csv", 1, {"--local", "radius is 0"}},
                                            {"--at 0,0 -o o.csv --method exact --t-coef 2", 2, {"--t-coef"}}});
}

TEST_F(CommandLine, OfStrokesIsChecked) {
  write("bad.txt", "0 0 0\n1 zero 0\n");
  write("empty.txt", "# nothing\n");
  expect_refused("stroke plane.xyz -o stroke.csv",
                 {{"", 2, {"--curve"}},
                  {"--curve '0,0,0 1,0'", 2, {"1,0"}},
                  {"--curve ' '", 2, {"empty"}},
                  {"--curve bad.txt", 1, {"line 2"}},
                  {"--curve empty.txt", 1, {"no entries"}},
                  {"--curve 5", 1, {"at least 2"}},
                  {"--curve '5 5 5'", 1, {"at least 2"}},
                  {"--curve '0.1,0.1,0 0.9,0.9,0' --closed", 1, {"turns back"}},
                  {"--curve '5 100'", 1, {"--curve 100"}},
                  {"--curve 'face:0:1,0,0 face:1:1,0,0'", 1, {"--curve face"}},
                  {"--curve '0.1,0.1,0 0.9,0.1,0 0.1,0.1,0'", 1, {"turns back"}},
                  {"--curve '0,0,0 1e9,0,0'", 1, {"units"}},
                  {"--curve '0,0,0 1,0,0' --view stroke.jpg", 2, {"--view"}},
                  {"--curve '0,0,0 1,0,0' -o nowhere/a.csv", 2, {"--output"}},
                  {"--curve '0,0.4,0 1,0.4,0' --positions '0,0 1,0 2,0'", 2, {"--positions"}},
                  {"--curve '0,0.4,0 1,0.4,0' --positions '0,0 1,0' --circle", 2, {"--circle"}},
                  {"--curve '0,0.4,0 1,0.4,0' --positions '1,1 1,1'", 1, {"does not advance"}}});
}

TEST_F(CommandLine, OfPathsAndLinesIsChecked) {
  write("pairs.txt", "0 7\n0 1 2\n");
  write("lines.txt", "3.25,.5,0 1,0,7\n");
  expect_refused("path cube.off -o path.csv", {{"", 2, {"--pairs"}},
                                               {"--pairs '1 2'", 2, {"--pairs", "no file", "'1 2'"}},
                                               {"--pairs pairs.txt", 1, {"line 2"}},
                                               {"--from 0 --to 9", 1, {"there is no path"}},
                                               {"--from 0 --to 12", 1, {"--to 12"}},
                                               {"--from 8 --to '9 10' --closed --tighten", 1, {"shrinks"}}});
  expect_refused("path plane.xyz --from 0 --to '5 90' --closed -o path.csv",
                 {{"--fast", 1, {"requires faces"}}, {"--tighten", 1, {"requires faces"}}});
  expect_refused("trace cube.off -o line.csv",
                 {{"--lines '0 1,0,0'", 2, {"--lines", "no file", "'0 1,0,0'"}},
                  {"--lines lines.txt", 2, {"--length"}},
                  {"--source 3.25,.5,0 --direction 0,0,1 --length 1", 1, {"--direction"}}});
}

TEST_F(CommandLine, OfLocalMapsIsChecked) {
  write("rows.csv", "5\n100\n");
  expect_refused("local-maps plane.xyz",
                 {{"-o maps.npz", 2, {"--radius"}},
                  {"--radius 0 -o maps.npz", 2, {"--radius"}},
                  {"--radius 1 --pad -o maps.npz", 2, {"--pad"}},
                  {"--radius 1 -o maps.csv", 1, {"maps.csv"}},
                  {"--radius 1 --sources none.txt -o maps.npz", 1, {"none.txt"}},
                  {"--radius 1 --sources rows.csv -o maps.npz", 1, {"line 2"}},
                  {"--k 4 --sources rows.csv -o maps.npz --json rows.csv", 1, {"--json rows.csv: would overwrite"}}});
}

TEST_F(CommandLine, HelpNamesOptions) {
  const std::map<std::string, Words> words{
      {"", {"logmap", "info", "Examples", "--version"}},
      {"logmap", {"--source",   "--output",   "--variant", "--backend", "--t-coef", "--voxel",   "--outliers",
                  "--k",        "--knn",      "--radius",  "--json",    "--view",   "--verbose", "--normals",
                  "--drop-nan", "--ordering", "--threads", "--u-axis",  "Examples", "face:"}},
      {"info", {"--json"}},
      {"cells", {"--sources", "--count", "--start", "--view", "label", "Examples"}},
      {"center", {"--points", "--weights", "--median", "--start", "--json", "Examples"}},
      {"stroke", {"--curve", "--closed", "--circle", "--view", "CURVE", "face:", "Examples"}}};
  for (const auto& [subcommand, parts] : words) EXPECT_TRUE(has_all(run_ok(subcommand + " --help").out, parts));
}

TEST_F(CommandLine, VersionNamesTheLibraries) {
  EXPECT_TRUE(has(run_ok("--version").out, "ahm ", "registers ", "Eigen "));
}

#ifdef AHM_WITH_PCL
TEST_F(CommandLine, ModulesAreFoundThroughPath) {
  const std::string header =
      "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 64\nHEIGHT 1\nPOINTS 64\nDATA ascii\n";
  write("cloud.pcd", header + xyz(plane(8)));
  const std::string programs = std::filesystem::path(AHM_PROGRAM).parent_path().string();
  const std::string command = "PATH='" + programs + "':\"$PATH\" ahm info cloud.pcd > out.txt 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << read_text("out.txt");
}
#endif

}  // namespace
}  // namespace ahm::test

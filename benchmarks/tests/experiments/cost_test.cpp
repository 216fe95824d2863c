// The experiments about cost, at toy size.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ahm/io/temporary_folder.hpp"
#include "experiments/experiment.hpp"
#include "shapes.hpp"

namespace ahm::bench {
namespace {

Table run(std::string_view name, const Settings& settings) {
  for (const Experiment& e : experiments())
    if (e.name == name) return e.run(settings);
  throw std::logic_error("no experiment " + std::string(name));
}

void write_off(const Mesh& mesh, const std::filesystem::path& path) {
  std::ofstream file(path);
  file << "OFF\n" << mesh.positions.size() << ' ' << mesh.faces.size() << " 0\n";
  for (const Vec3& p : mesh.positions) file << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& [a, b, c] : mesh.faces) file << "3 " << a << ' ' << b << ' ' << c << '\n';
}

TEST(RuntimeExperiment, TakesTheMeshesOfAFolderAndLeavesOutWhatIsNone) {
  const io::TemporaryFolder temporary("ahm_test_");
  const auto& folder = temporary.directory();
  std::filesystem::create_directories(folder / "below");
  write_off(torus(300), folder / "ring.off");
  write_off(split_icosphere(100), folder / "below" / "ball.off");
  std::ofstream(folder / "broken.off") << "OFF\n3 1 0\n0 0 0\n";
  std::ofstream(folder / "notes.txt") << "no mesh";
  const Table table = run("runtime", {.toy = true, .meshes = folder});
  EXPECT_EQ(table.where("mesh", "ring").rows().size(), 1u);
  EXPECT_EQ(table.where("mesh", "ball").mean("vertices"), 162);
  EXPECT_TRUE(table.where("mesh", "broken").rows().empty());
  EXPECT_TRUE(table.where("mesh", "notes").rows().empty());
  EXPECT_GT(table.smallest("additional AHM_a s"), 0);
}

}  // namespace
}  // namespace ahm::bench

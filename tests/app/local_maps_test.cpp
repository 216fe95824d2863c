// Neighbourhoods as NumPy archives.
#include <gtest/gtest.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "program.hpp"

namespace ahm::test {
namespace {

/// The numbers of one array of an archive, and its header.
template <class T>
std::vector<T> array(const std::string& archive, const std::string& name, std::string* header = nullptr) {
  const unzFile zip = unzOpen64(archive.c_str());
  EXPECT_NE(zip, nullptr);
  EXPECT_EQ(unzLocateFile(zip, (name + ".npy").c_str(), 1), UNZ_OK) << name;
  unzOpenCurrentFile(zip);
  std::string bytes;
  char buffer[4096];
  for (int count; (count = unzReadCurrentFile(zip, buffer, sizeof buffer)) > 0;) bytes.append(buffer, count);
  unzClose(zip);
  const std::size_t begin = bytes.find('\n') + 1;
  if (header != nullptr) *header = bytes.substr(10, begin - 10);
  std::vector<T> values((bytes.size() - begin) / sizeof(T));
  std::memcpy(values.data(), bytes.data() + begin, values.size() * sizeof(T));
  return values;
}

TEST(LocalMapsCommand, FindsTheNeighboursOnAPlane) {
  Folder folder;
  const auto points = plane(15);
  const std::string out = folder / "maps.npz";
  const Outcome outcome = run({"local-maps", folder.write("plane.xyz", xyz(points)), "--radius", "0.2", "-o", out});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto indptr = array<std::int64_t>(out, "indptr");
  const auto indices = array<std::int32_t>(out, "indices");
  const auto log = array<double>(out, "log"), distance = array<double>(out, "distance"),
             frames = array<double>(out, "frames");
  ASSERT_EQ(indptr.size(), points.size() + 1);
  for (std::size_t s = 0; s < points.size(); ++s) {
    ASSERT_EQ(indices[indptr[s]], s);
    std::size_t expected = 0;
    for (const Vec3& q : points) expected += std::hypot(q[0] - points[s][0], q[1] - points[s][1]) < 0.2;
    ASSERT_EQ(indptr[s + 1] - indptr[s], expected);
    for (auto e = indptr[s]; e < indptr[s + 1]; ++e) {
      const Vec3& q = points[indices[e]];
      for (int c : {0, 1})  // point = source + u x + v y
        ASSERT_NEAR(points[s][c] + log[2 * e] * frames[9 * s + c] + log[2 * e + 1] * frames[9 * s + 3 + c], q[c],
                    1e-10);
      ASSERT_NEAR(distance[e], std::hypot(q[0] - points[s][0], q[1] - points[s][1]), 1e-10);
    }
  }
}

TEST(LocalMapsCommand, SaysThatItsRadiusHoldsNothing) {
  Folder folder;
  const std::string input = folder.write("plane.xyz", xyz(plane(12))), out = folder / "maps.npz";
  const auto words = [&](const char* radius, const char* nearest) {
    const Outcome outcome = run({"local-maps", input, "--radius", radius, "--k", nearest, "-o", out});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(words("1e-3", "5").find("neighborhoods without neighbors: 144 of 144"), std::string::npos);
  EXPECT_EQ(words("1e-3", "1"), "");
  EXPECT_EQ(words("0.3", "5"), "");
}

TEST(LocalMapsCommand, PadsToAFixedCount) {
  Folder folder;
  const auto input = folder.write("plane.xyz", xyz(plane(12)));
  const auto list = folder.write("rows.txt", "# rows\n5\n77\n\n30\n");
  const std::string out = folder / "maps.npz";
  const Outcome outcome = run({"local-maps", input, "--radius", "0.15", "--k", "20", "--pad", "--float32", "--sources",
                               list, "-o", out, "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out).at("sources"), 3);
  EXPECT_EQ(array<std::int32_t>(out, "sources"), (std::vector<std::int32_t>{5, 77, 30}));
  std::string header;
  const auto mask = array<std::uint8_t>(out, "mask", &header);
  EXPECT_NE(header.find("'shape': (3, 20)"), std::string::npos) << header;
  array<float>(out, "log", &header);
  EXPECT_NE(header.find("'<f4'"), std::string::npos) << header;
  EXPECT_NE(header.find("'shape': (3, 20, 2)"), std::string::npos) << header;
  array<float>(out, "transport", &header);
  EXPECT_NE(header.find("'<c8'"), std::string::npos) << header;
  const auto distance = array<float>(out, "distance");
  for (std::size_t e = 0; e < mask.size(); ++e) {
    EXPECT_LE(distance[e], 0.15);
    EXPECT_TRUE(mask[e] || distance[e] == 0);
    EXPECT_TRUE(e % 20 == 0 || !mask[e] || mask[e - 1]);
  }
}

TEST(LocalMapsCommand, FindsTheNearestWithoutARadius) {
  Folder folder;
  const auto points = plane(12);
  const std::string out = folder / "maps.npz";
  const Outcome outcome = run({"local-maps", folder.write("plane.xyz", xyz(points)), "--k", "9", "--pad", "-o", out});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto mask = array<std::uint8_t>(out, "mask");
  const auto distance = array<double>(out, "distance");
  ASSERT_EQ(mask.size(), 9 * points.size());
  for (std::size_t s = 0; s < points.size(); ++s) {
    std::vector<double> away;
    for (const Vec3& q : points) away.push_back(std::hypot(q[0] - points[s][0], q[1] - points[s][1]));
    std::sort(away.begin(), away.end());
    for (std::size_t k = 0; k < 9; ++k) {
      ASSERT_TRUE(mask[9 * s + k]);
      ASSERT_NEAR(distance[9 * s + k], away[k], 1e-10);
    }
  }
}

TEST(LocalMapsCommand, FindsTheNearestRowsBetweenVirtualVertices) {
  Folder folder;
  std::string sheet = "OFF\n64 49 0\n";
  for (int i = 0; i < 64; ++i) sheet += std::to_string(i / 8) + " " + std::to_string(i % 8) + " 0\n";
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 7; ++j) {
      const int a = 8 * i + j;
      for (int word : {4, a, a + 8, a + 9, a + 1}) sheet += std::to_string(word) + " ";
      sheet += "\n";
    }
  const std::string out = folder / "maps.npz";
  const Outcome outcome = run({"local-maps", folder.write("quads.off", sheet), "--k", "13", "-o", out});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto indptr = array<std::int64_t>(out, "indptr");
  for (std::size_t s = 0; s < 64; ++s) ASSERT_EQ(indptr[s + 1] - indptr[s], 13);
}

TEST(LocalMapsCommand, FindsAllRowsWhereMoreAreAskedFor) {
  Folder folder;
  const std::string cube =
      "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
      "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
  const std::string out = folder / "maps.npz";
  const Outcome outcome = run({"local-maps", folder.write("cube.off", cube), "--k", "100", "-o", out});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(array<std::int64_t>(out, "indptr"), (std::vector<std::int64_t>{0, 8, 16, 24, 32, 40, 48, 56, 64}));
}

TEST(LocalMapsCommand, RefusesNonsense) {
  Folder folder;
  const auto input = folder.write("plane.xyz", xyz(plane(10)));
  const std::string out = folder / "maps.npz";
  EXPECT_EQ(run({"local-maps", input, "-o", out}).status, 2);
  EXPECT_EQ(run({"local-maps", input, "--radius", "0", "-o", out}).status, 2);
  EXPECT_EQ(run({"local-maps", input, "--radius", "1", "--pad", "-o", out}).status, 2);
  EXPECT_EQ(run({"local-maps", input, "--radius", "1", "-o", folder / "maps.csv"}).status, 1);
  EXPECT_EQ(run({"local-maps", input, "--radius", "1", "--sources", folder / "none", "-o", out}).status, 1);
  const Outcome beyond =
      run({"local-maps", input, "--radius", "1", "--sources", folder.write("rows", "5\n100\n"), "-o", out});
  EXPECT_EQ(beyond.status, 1);
  EXPECT_NE(beyond.err.find("line 2"), std::string::npos) << beyond.err;
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"plane.xyz", "rows"}));
}

}  // namespace
}  // namespace ahm::test

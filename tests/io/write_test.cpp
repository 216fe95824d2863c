#include "ahm/io/write.hpp"

#include <fcntl.h>

#include <charconv>
#include <clocale>
#include <cmath>
#include <cstring>
#include <locale>
#include <sstream>

#include "files.hpp"
#include "table.hpp"

namespace ahm::io::test {
namespace {

using Write = Files;

std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) rows.back().push_back(word);
  }
  return rows;
}

double number(const std::string& word) {
  double value = 0;
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

TEST_F(Write, CsvHoldsEveryVertexWithEveryBit) {
  const Result result;
  write(path("a.csv"), result.table());
  const std::string text = contents(path("a.csv"));
  EXPECT_EQ(text.substr(0, text.find('\n')), "index,x,y,z,u,v,distance,angle,status");
  const auto rows = rows_of(text);
  ASSERT_EQ(rows.size(), 5u);
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_EQ(rows[i + 1].size(), 9u);
    EXPECT_EQ(rows[i + 1][0], std::to_string(i));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(number(rows[i + 1][k + 1]), result.points[i][k]);
    EXPECT_EQ(rows[i + 1][8], to_string(result.status[i]));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(number(rows[i + 1][4]), result.u[i]);
    EXPECT_EQ(number(rows[i + 1][5]), result.v[i]);
    EXPECT_EQ(number(rows[i + 1][6]), result.distance[i]);
    EXPECT_EQ(number(rows[i + 1][7]), result.angle[i]);
  }
  for (std::size_t i = 2; i < 4; ++i) {
    for (std::size_t k = 4; k < 8; ++k) EXPECT_EQ(rows[i + 1][k], "nan");
  }
  EXPECT_EQ(read(path("a.csv")).points, result.points);
}

TEST_F(Write, FurtherColumnsComeLast) {
  const Result result;
  Table table = result.table();
  const std::vector<double> quality{0.25, 0.5, 0.75, 1};
  table.further = {{"quality", quality}};
  write(path("a.csv"), table);
  const auto rows = rows_of(contents(path("a.csv")));
  EXPECT_EQ(rows[0].back(), "quality");
  EXPECT_EQ(number(rows[1].back()), 0.25);
  EXPECT_EQ(rows[4].back(), "nan");  // not ok
  write(path("a.ply"), table);
  EXPECT_NE(contents(path("a.ply")).find("property uchar status\nproperty double quality\n"), std::string::npos);
  EXPECT_EQ(read(path("a.ply")).points, result.points);
}

TEST_F(Write, RefusesColumnsThatDoNotFit) {
  const Result result;
  Table table = result.table();
  const std::vector<double> numbers{1, 2, 3, 4};
  table.further = {{"short", std::span(numbers).first(3)}};
  EXPECT_THROW(write(path("a.csv"), table), InvalidArgument);
  for (const char* name : {"", "two words", "comma,", "line\n"}) {
    table.further = {{name, numbers}};
    EXPECT_THROW(write(path("a.csv"), table), InvalidArgument) << name;
  }
}

TEST_F(Write, CsvSpellsEveryNanAlike) {
  Result result;
  result.points[2] = {-Result::nan, Result::nan, std::copysign(Result::nan, -1.0)};
  write(path("a.csv"), result.table());
  EXPECT_EQ(rows_of(contents(path("a.csv")))[3][3], "nan");
  EXPECT_EQ(contents(path("a.csv")).find("-nan"), std::string::npos);
}

TEST_F(Write, CsvIsTheSameInALocaleWithCommas) {
  const Result result;
  write(path("a.csv"), result.table());
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  write(path("b.csv"), result.table());
  std::locale::global(before);
  EXPECT_EQ(contents(path("a.csv")), contents(path("b.csv")));
}

TEST_F(Write, ColumnsThatAreNotGivenAreLeftOut) {
  const Result result;
  Table table = result.table();
  table.u = table.v = table.angle = {};
  table.further.push_back({"label", result.u});
  write(path("a.csv"), table);
  const auto rows = rows_of(contents(path("a.csv")));
  EXPECT_EQ(rows[0], (std::vector<std::string>{"index", "x", "y", "z", "distance", "status", "label"}));
  for (const auto& row : rows) EXPECT_EQ(row.size(), 7u);
  EXPECT_EQ(number(rows[2][4]), result.distance[1]);
  EXPECT_EQ(rows[3][4], "nan");
  write(path("a.ply"), table);
  const std::string header = contents(path("a.ply"));
  EXPECT_NE(header.find("double nz\nproperty double distance\nproperty uchar status\nproperty double label\n"),
            std::string::npos);
  EXPECT_EQ(read(path("a.ply")).points, result.points);
}

TEST_F(Write, PlyReadsBackExactly) {
  const Result result;
  write(path("a.ply"), result.table());
  const Geometry g = read(path("a.ply"));
  EXPECT_EQ(g.points, result.points);
  ASSERT_EQ(g.normals.size(), 4u);
  EXPECT_EQ(g.normals[3], result.normals[3]);
  EXPECT_TRUE(std::isnan(g.normals[2][0]));
  EXPECT_EQ(g.face_begin, result.face_begin);
  EXPECT_EQ(g.face_vertices, result.face_vertices);
  EXPECT_EQ(g.format, "PLY binary little endian");
  EXPECT_TRUE(g.warnings.empty());
}

TEST_F(Write, PlyHoldsTheResultAndExplainsItsCodes) {
  const Result result;
  write(path("a.ply"), result.table());
  const std::string text = contents(path("a.ply"));
  EXPECT_NE(text.find("comment status 4 removed\n"), std::string::npos);
  const std::size_t body = text.find("end_header\n") + 11;
  const std::size_t row = 10 * sizeof(double) + 1;
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 4> values{};
    std::memcpy(values.data(), text.data() + body + i * row + 6 * sizeof(double), sizeof values);
    EXPECT_EQ(text[body + i * row + row - 1], static_cast<char>(result.status[i]));
    if (result.status[i] != Status::ok) {
      for (double value : values) EXPECT_TRUE(std::isnan(value));
    } else {
      EXPECT_EQ(values, (std::array<double, 4>{result.u[i], result.v[i], result.distance[i], result.angle[i]}));
    }
  }
}

TEST_F(Write, PlyHoldsCloudsAndPolygonsWithManyCorners) {
  Result result;
  Table cloud = result.table();
  cloud.normals = {};
  cloud.face_begin = {};
  cloud.face_vertices = {};
  write(path("cloud.ply"), cloud);
  EXPECT_EQ(read(path("cloud.ply")).face_count(), 0u);
  EXPECT_TRUE(read(path("cloud.ply")).normals.empty());

  result.face_vertices.assign(300, 2);
  result.face_begin = {0, 300};
  write(path("many.ply"), result.table());
  EXPECT_EQ(read(path("many.ply")).face_vertices, result.face_vertices);
}

TEST_F(Write, RefusesUnknownTypesBeforeAnyWork) {
  for (const char* name : {"a.txt", "a", "a.obj", "a.csv.gz"}) {
    EXPECT_THROW(write(path(name), Result().table()), IoError) << name;
    EXPECT_THROW(check_writable(path(name)), IoError) << name;
  }
  EXPECT_EQ(files_left(), 0u);
}

TEST_F(Write, RefusesTablesThatDoNotFitTogether) {
  const auto refused = [&](auto change) {
    Result result;
    change(result);
    EXPECT_THROW(write(path("a.csv"), result.table()), InvalidArgument);
  };
  refused([](Result& r) { r.u.pop_back(); });
  refused([](Result& r) { r.normals.pop_back(); });
  refused([](Result& r) { r.status.push_back(Status::ok); });
  refused([](Result& r) { r.face_vertices[6] = 4; });
  refused([](Result& r) { r.face_vertices[0] = -1; });
  refused([](Result& r) { r.face_begin = {0, 8}; });
  refused([](Result& r) { r.face_begin = {0, 5, 3, 7}; });
  refused([](Result& r) { r.face_begin.clear(); });
  EXPECT_EQ(files_left(), 0u);
}

TEST_F(Write, ReportsAFullDiskAndLeavesNothing) {
  for (const char* name : {"a.csv", "a.ply"}) {
    std::filesystem::create_symlink("/dev/full", path(name));
    EXPECT_THROW(write(path(name), Result().table()), IoError) << name;
  }
  EXPECT_THROW(write("/dev/full", Result().table()), IoError);
  EXPECT_EQ(files_left(), 2u) << "only the links";
}

TEST_F(Write, WritesCsvToTheProcessesOwnOutputWhereverItLeads) {
  const Result result;
  write(path("direct.csv"), result.table());
  make("redirected", "before\n");
  ::fflush(stdout);
  const int saved = ::dup(STDOUT_FILENO);
  const int file = ::open(path("redirected").c_str(), O_WRONLY | O_APPEND);
  ::dup2(file, STDOUT_FILENO);
  write("/dev/stdout", result.table());
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  ::close(file);
  EXPECT_EQ(contents(path("redirected")), "before\n" + contents(path("direct.csv")));
}

TEST_F(Write, CheckWritableForeseesFailures) {
  EXPECT_NO_THROW(check_writable(path("a.csv")));
  EXPECT_NO_THROW(check_writable(path("A.PLY")));
  EXPECT_NO_THROW(check_writable("relative.csv"));
  EXPECT_NO_THROW(check_writable("/dev/null"));
  EXPECT_EQ(files_left(), 0u) << "it must not create anything";
  EXPECT_THROW(check_writable(path("absent/a.csv")), IoError);
  std::filesystem::create_directory(path("dir.csv"));
  EXPECT_THROW(check_writable(path("dir.csv")), IoError);
  make("file", "x");
  EXPECT_THROW(check_writable(path("file/a.csv")), IoError);
  if (::geteuid() == 0) return;  // root may write everywhere
  std::filesystem::permissions(directory_, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THROW(check_writable(path("a.csv")), IoError);
  std::filesystem::permissions(directory_, std::filesystem::perms::owner_all);
}

}  // namespace
}  // namespace ahm::io::test

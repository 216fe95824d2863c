#include "ahm/io/write.hpp"

#include <fcntl.h>

#include <charconv>
#include <clocale>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "ahm/io/formats.hpp"
#include "comma_locale.hpp"
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

TEST_F(Write, JsonLinesAreTheRowsOfTheCsv) {
  const Result result;
  write(path("a.csv"), result.table());
  write(path("a.jsonl"), result.table());
  const auto rows = rows_of(contents(path("a.csv")));
  std::istringstream lines(contents(path("a.jsonl")));
  std::size_t row = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto object = nlohmann::ordered_json::parse(line);
    ASSERT_LT(++row, rows.size());
    ASSERT_EQ(object.size(), rows[0].size());
    std::size_t column = 0;
    for (const auto& [name, value] : object.items()) {
      EXPECT_EQ(name, rows[0][column]);
      const std::string& word = rows[row][column++];
      if (value.is_string())
        EXPECT_EQ(value, word);
      else if (value.is_null())
        EXPECT_EQ(word, "nan");
      else
        EXPECT_EQ(value.get<double>(), number(word)) << name;
    }
  }
  EXPECT_EQ(row + 1, rows.size());
}

TEST_F(Write, ColumnsComeInTheirOrder) {
  const Result result;
  Table table = result.rows();
  const std::vector<Index> piece{3, -1, 0, 7};
  table.add("piece", piece);
  table.add({"hx", "hy", "hz"}, result.normals);
  table.add("status", result.status);
  write(path("a.csv"), table);
  const auto rows = rows_of(contents(path("a.csv")));
  EXPECT_EQ(rows[0], (std::vector<std::string>{"index", "x", "y", "z", "piece", "hx", "hy", "hz", "status"}));
  EXPECT_EQ(rows[2][4], "-1");
  EXPECT_EQ(rows[1][7], "1");
  EXPECT_EQ(rows[3][7], "nan");
  for (const auto& row : rows) EXPECT_EQ(row.size(), 9u);
  write(path("a.ply"), table);
  EXPECT_NE(contents(path("a.ply")).find("double nz\nproperty int piece\nproperty double hx\n"), std::string::npos);
  EXPECT_EQ(read(path("a.ply")).points, result.points);
}

TEST_F(Write, SaysWhereColumnsForViewersGo) {
  const Result result;
  const Table all = result.table();
  Table others = all;
  std::erase_if(others.columns, [](const Column& column) { return column.for_viewers; });
  ASSERT_LT(others.columns.size(), all.columns.size());
  for (const std::string& extension : extensions(Use::write)) {
    write(path("all"), all, extension);
    write(path("others"), others, extension);
    EXPECT_EQ(contents(path("all")) != contents(path("others")), writes_for_viewers(path("all"), extension))
        << extension;
    EXPECT_EQ(writes_for_viewers(path("a" + extension)), writes_for_viewers(path("a.ply"), extension)) << extension;
  }
  EXPECT_FALSE(writes_for_viewers("a.CSV"));
  EXPECT_FALSE(writes_for_viewers("/dev/stdout"));
  EXPECT_TRUE(writes_for_viewers("a.glb"));
}

TEST_F(Write, RefusesColumnsThatDoNotFit) {
  const Result result;
  const std::vector<double> numbers{1, 2, 3, 4};
  const auto refused = [&](const std::string& name, std::span<const double> values) {
    Table table = result.table();
    table.add(name, values);
    EXPECT_THROW(write(path("a.csv"), table), InvalidArgument) << name;
  };
  refused("short", std::span(numbers).first(3));
  for (const char* name : {"", "two words", "comma,", "line\n"}) refused(name, numbers);
}

TEST_F(Write, RefusesWordsThatAreNotThere) {
  const std::vector<std::uint8_t> codes{0, 2, 1};
  Table table;
  table.columns.push_back({{"kind"}, CodedWords{codes, {"near", "far"}}});
  EXPECT_THROW(write(path("a.csv"), table), InvalidArgument);
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
  {
    const CommaLocale locale;
    write(path("b.csv"), result.table());
  }
  EXPECT_EQ(contents(path("a.csv")), contents(path("b.csv")));
}

TEST_F(Write, PlyReadsBackExactly) {
  const Result result;
  write(path("a.ply"), result.table());
  const Geometry g = read(path("a.ply"));
  ASSERT_NO_FATAL_FAILURE(expect_geometry_of(result, g));
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
    const std::array<double, 4> expected{result.u[i], result.v[i], result.distance[i], result.angle[i]};
    EXPECT_EQ(std::memcmp(&values, &expected, sizeof values), 0);
  }
}

TEST_F(Write, PlyHoldsCloudsAndPolygonsWithManyCorners) {
  Result result;
  Table cloud;
  cloud.add({"x", "y", "z"}, result.points);
  write(path("cloud.ply"), cloud);
  EXPECT_EQ(read(path("cloud.ply")).face_count(), 0u);
  EXPECT_TRUE(read(path("cloud.ply")).normals.empty());

  result.face_vertices.assign(300, 2);
  result.face_begin = {0, 300};
  write(path("many.ply"), result.table());
  EXPECT_EQ(read(path("many.ply")).face_vertices, result.face_vertices);
}

TEST_F(Write, PlyHoldsColors) {
  const Result result;
  const std::vector<std::array<std::uint8_t, 3>> colors{{0, 100, 255}, {1, 100, 254}, {2, 100, 253}, {3, 100, 252}};
  Table table = result.rows();
  table.add({"red", "green", "blue"}, colors);
  write(path("a.ply"), table);
  const Geometry back = read(path("a.ply"));
  EXPECT_EQ(back.points, result.points);
  EXPECT_EQ(back.colors, colors);
  EXPECT_EQ(back.face_vertices, result.face_vertices);
}

TEST_F(Write, PlyAsTextHoldsTheSameAndEdges) {
  const Result result;
  Table table = result.table();
  table.text = true;
  table.edges = {{0, 2}, {3, 1}};
  write(path("a.ply"), table);
  const std::string text = contents(path("a.ply"));
  EXPECT_NE(text.find("element edge 2\nproperty int vertex1\nproperty int vertex2\n"), std::string::npos);
  EXPECT_TRUE(text.ends_with("\n4 3 2 1 0\n0 2\n3 1\n"));
  const Geometry back = read(path("a.ply"));
  EXPECT_EQ(back.points, result.points);
  EXPECT_EQ(back.face_vertices, result.face_vertices);
  table.edges = {{0, 4}};
  EXPECT_THROW(write(path("a.ply"), table), InvalidArgument);
}

TEST_F(Write, ListsTheKnownTypes) {
  for (const std::string& extension : extensions(Use::write)) {
    if (extension == ".pcd") continue;  // may be missing from the build
    write(path("a" + extension), Result().table());
    if (const auto readable = extensions(Use::read); std::ranges::find(readable, extension) != readable.end()) {
      EXPECT_EQ(read(path("a" + extension)).points, Result().points);
    }
    try {
      write(path("a.unknown"), Result().table());
      ADD_FAILURE() << "was written";
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(extension), std::string::npos) << error.what();
    }
  }
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

TEST_F(Write, RefusesAPictureThatIsNotTheRows) {
  const Result result;
  Table table = result.table();
  for (const auto& [width, height] : {std::pair{3, 2}, {0, 0}, {5, 1}, {4, 0}}) {
    table.acquisition = {static_cast<std::size_t>(width), static_cast<std::size_t>(height)};
    EXPECT_THROW(write(path("a.csv"), table), InvalidArgument) << width << " x " << height;
  }
  table.acquisition = {1, 4};
  write(path("a.csv"), table);
}

TEST_F(Write, ObjHoldsCurvesAsLines) {
  const std::vector<Vec3> points = {{0.1, 0, 431234.567891}, {1, 0, 0}, {2, 0, 0}, {3, -1e-9, 0}, {4, 0, 0}};
  const std::vector<Index> begin = {0, 2, 2};  // the second has no points
  write_obj_lines(path("a.obj"), points, begin);
  EXPECT_EQ(read(path("a.obj")).points, points);
  const std::string text = contents(path("a.obj"));
  EXPECT_EQ(text.substr(text.find("\nl ")), "\nl 1 2\nl 3 4 5\n");
}

}  // namespace
}  // namespace ahm::io::test

// Writing tables. The readers are tested on files of their own, so a file that reads back is right.
#include "ahm/io/write.hpp"

#include <fcntl.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <regex>
#include <sstream>

#include "ahm/io/formats.hpp"
#include "cases.hpp"
#include "comma_locale.hpp"
#include "files.hpp"
#include "support/expect_error.hpp"

namespace ahm::io::test {
namespace {

/// Numbers that need all digits, a row without a result, and two polygons.
struct Result {
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> points = {{0.1, 1.0 / 3.0, 431234.567891}, {1e-310, -1e300, 0}, {1, 2, 3}, {4, 5, 6}};
  std::vector<Vec3> normals = {{0, 0, 1}, {0, 1, 0}, {nan, nan, nan}, {1, 0, 0}};
  std::vector<std::array<std::uint8_t, 3>> colors{{0, 100, 255}, {1, 100, 254}, {2, 100, 253}, {3, 100, 252}};
  std::vector<double> u = {0.1, 1.0 / 3.0, nan, nan}, v = {-0.0, 2e-17, nan, nan};
  std::vector<Index> piece{3, -1, 0, 7};
  std::vector<Status> status = {Status::ok, Status::ok, Status::removed, Status::disconnected};
  std::vector<Offset> face_begin = {0, 3, 7};
  std::vector<Index> face_vertices = {0, 1, 2, 3, 2, 1, 0};

  Table table() const {
    Table table{.title = "a result"};
    table.add({"x", "y", "z"}, points);
    table.add({"nx", "ny", "nz"}, normals).for_viewers = true;
    table.add("u", u), table.add("v", v), table.add("piece", piece), table.add("status", status);
    table.faces = {face_begin, face_vertices};
    return table;
  }
};

class Write : public Files {
 protected:
  /// The bytes of the file.
  std::string written(const std::string& name, const Table& table) const {
    write(path(name), table);
    return contents(path(name));
  }
  std::string read_back(const std::string& name, const Table& table) const {
    write(path(name), table);
    return contents_of(read(path(name)));
  }

  const std::string points = "0.1 0.3333333333333333 431234.567891, 1e-310 -1e+300 0, 1 2 3, 4 5 6";
  const std::string normals = "; normals 0 0 1, 0 1 0, nan nan nan, 1 0 0", faces = "; faces 0 1 2, 3 2 1 0";
  const std::string numbers = "; u 0.1 0.3333333333333333 nan nan; v -0 2e-17 nan nan; piece 3 -1 0 7";
  const std::string codes = "; status 0 0 4 1";
};

TEST_F(Write, ReadsBackBitForBit) {
  const Result result;
  Table table = result.table();
  EXPECT_EQ(read_back("a.csv", table), points + "; index 0 1 2 3" + numbers + "; column_ignored status");
  EXPECT_EQ(read_back("a.ply", table), points + faces + normals + numbers + codes);
  table.text = true;
  EXPECT_EQ(read_back("text.ply", table), points + faces + normals + numbers + codes);
  EXPECT_EQ(read(path("a.ply")).format, "PLY binary little endian");
  EXPECT_EQ(read(path("text.ply")).format, "PLY text");
#ifdef AHM_WITH_PUGIXML
  EXPECT_EQ(read_back("a.vtp", table), points + faces + normals + numbers + codes);
#endif
#ifdef AHM_WITH_PCL
  EXPECT_EQ(read_back("a.pcd", table), points + normals + numbers + codes);
  EXPECT_EQ(read(path("a.pcd")).format, "PCD binary");
#endif
}

TEST_F(Write, ColorsReadBack) {
  const Result result;
  Table table;
  table.add({"x", "y", "z"}, result.points), table.add({"red", "green", "blue"}, result.colors);
  for (const std::string extension : {".ply",
#ifdef AHM_WITH_PUGIXML
                                      ".vtp",
#endif
#ifdef AHM_WITH_PCL
                                      ".pcd",
#endif
                                      ".csv"})
    EXPECT_EQ(read_back("a" + extension, table), points + "; colors 0 100 255, 1 100 254, 2 100 253, 3 100 252" +
                                                     (extension == ".csv" ? "; index 0 1 2 3" : ""));
}

TEST_F(Write, ReadersOfStreamsReadTheSame) {
  const Result result;
  std::istringstream stream(written("a.ply", result.table()));
  EXPECT_EQ(contents_of(read(stream)), points + faces + normals + numbers + codes);
}

TEST_F(Write, CsvHasARowPerVertex) {
  EXPECT_EQ(written("a.csv", Result().table()),
            "index,x,y,z,u,v,piece,status\n"
            "0,0.1,0.3333333333333333,431234.567891,0.1,-0,3,ok\n"
            "1,1e-310,-1e+300,0,0.3333333333333333,2e-17,-1,ok\n"
            "2,1,2,3,nan,nan,0,removed\n"
            "3,4,5,6,nan,nan,7,disconnected\n");
}

TEST_F(Write, JsonLinesHaveAnObjectPerVertex) {
  const char* lines[] = {
      R"({"index":0,"x":0.1,"y":0.3333333333333333,"z":431234.567891,"u":0.1,"v":-0,"piece":3,"status":"ok"})",
      R"({"index":1,"x":1e-310,"y":-1e+300,"z":0,"u":0.3333333333333333,"v":2e-17,"piece":-1,"status":"ok"})",
      R"({"index":2,"x":1,"y":2,"z":3,"u":null,"v":null,"piece":0,"status":"removed"})",
      R"({"index":3,"x":4,"y":5,"z":6,"u":null,"v":null,"piece":7,"status":"disconnected"})"};
  std::string text;
  for (const char* line : lines) text += std::string(line) + "\n";
  EXPECT_EQ(written("a.jsonl", Result().table()), text);
}

TEST_F(Write, CsvSpellsEveryNanAlike) {
  Result result;
  result.points[2] = {-Result::nan, Result::nan, std::copysign(Result::nan, -1.0)};
  const std::string text = written("a.csv", result.table());
  EXPECT_NE(text.find("\n2,nan,nan,nan,"), std::string::npos) << text;
}

TEST_F(Write, ColumnsKeepTheirOrder) {
  const Result result;
  Table table = result.table();
  table.add({"hx", "hy", "hz"}, result.normals);
  table.add("last", result.v);
  EXPECT_TRUE(written("a.csv", table).starts_with("index,x,y,z,u,v,piece,status,hx,hy,hz,last\n"));
  EXPECT_NE(written("a.ply", table).find("double v\nproperty int piece\nproperty uchar status\nproperty double hx\n"),
            std::string::npos);
}

TEST_F(Write, DoesNotDependOnTheLocale) {
  const Result result;
  for (const std::string& extension : extensions(Use::write)) {
    const std::string expected = written("a" + extension, result.table());
    const CommaLocale locale;
    EXPECT_EQ(written("a" + extension, result.table()), expected) << extension;
  }
}

TEST_F(Write, OmitsColumnsForViewersWhereItSays) {
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

TEST_F(Write, PlyExplainsCodesInComments) {
  EXPECT_NE(written("a.ply", Result().table()).find("comment status 4 removed\n"), std::string::npos);
}

TEST_F(Write, PlyHasPolygonsWithManyCorners) {
  Result result;
  result.face_vertices.assign(300, 2);
  result.face_begin = {0, 300};
  write(path("a.ply"), result.table());
  EXPECT_EQ(read(path("a.ply")).face_vertices, result.face_vertices);
}

TEST_F(Write, PlyHasEdges) {
  const Result result;
  Table table = result.table();
  table.text = true;
  table.edges = {{0, 2}, {3, 1}};
  const std::string text = written("a.ply", table);
  EXPECT_NE(text.find("element edge 2\nproperty int vertex1\nproperty int vertex2\n"), std::string::npos);
  EXPECT_TRUE(text.ends_with("\n4 3 2 1 0\n0 2\n3 1\n"));
  EXPECT_EQ(contents_of(read(path("a.ply"))), points + faces + normals + numbers + codes + "; element_ignored edge");
}

TEST_F(Write, PcdHasFloatsWhereTheyLoseNothing) {
  Result result;
  EXPECT_NE(written("a.pcd", result.table())
                .find("FIELDS x y z normal_x normal_y normal_z u v piece status\nSIZE 8 8 8 4 4 4 8 8 4 1\n"),
            std::string::npos);
  result.points[0] = {0.5, 1, 2};
  result.points[1] = {Result::nan, Result::nan, Result::nan};
  EXPECT_NE(written("f.pcd", result.table()).find("\nSIZE 4 4 4 4 4 4 8 8 4 1\n"), std::string::npos);
  const std::vector<double> intensity = {0.5, 1, 2, 3};
  Table table = result.table();
  table.add({"red", "green", "blue"}, result.colors), table.add("intensity", intensity);
  EXPECT_NE(written("c.pcd", table).find("status rgb intensity\nSIZE 4 4 4 4 4 4 8 8 4 1 4 4\n"), std::string::npos);
#ifdef AHM_WITH_PCL
  EXPECT_EQ(read(path("c.pcd")).colors, result.colors);
  EXPECT_EQ(read(path("c.pcd")).properties.back().values, intensity);
#endif
}

#ifdef AHM_WITH_PCL
TEST_F(Write, PcdHasImageAndViewpoint) {
  const Result result;
  Table table = result.table();
  table.acquisition = {2, 2, {431234.567891, -2, 0.1}, {0.5, 0.5, -0.5, 0.5}};
  EXPECT_TRUE(read_back("a.pcd", table).ends_with("; image 2 x 2 from 431234.567891 -2 0.1 along 0.5 0.5 -0.5 0.5"));
}
#endif

/// An array of a .vtp file, found by its element and name.
template <class T>
std::vector<T> vtp_array(const std::string& text, const std::string& element, const std::string& name) {
  const std::string part = text.substr(text.find("<" + element + ">"));
  std::smatch found;
  EXPECT_TRUE(std::regex_search(part, found, std::regex("Name=\"" + name + "\"[^>]*offset=\"([0-9]+)\""))) << name;
  const std::size_t at = text.find("encoding=\"raw\">\n_") + 17 + std::stoull(found[1]);
  std::uint64_t length = 0;
  std::memcpy(&length, text.data() + at, sizeof length);
  std::vector<T> values(length / sizeof(T));
  std::memcpy(values.data(), text.data() + at + sizeof length, length);
  return values;
}

TEST_F(Write, VtpHasFacesOrEdgesOrElsePoints) {
  const Result result;
  Table table = result.table();
  std::string text = written("a.vtp", table);
  EXPECT_NE(text.find("<!-- status: 0 ok, 1 disconnected"), std::string::npos);
  EXPECT_NE(text.find("NumberOfPoints=\"4\" NumberOfVerts=\"0\""), std::string::npos) << text.substr(0, 400);
  EXPECT_EQ(vtp_array<std::int32_t>(text, "Polys", "connectivity"), result.face_vertices);
  EXPECT_EQ(vtp_array<std::int64_t>(text, "Polys", "offsets"), (std::vector<std::int64_t>{3, 7}));
  table.faces = {};
  table.edges = {{0, 1}, {1, 3}};
  text = written("a.vtp", table);
  EXPECT_EQ(vtp_array<std::int32_t>(text, "Lines", "connectivity"), (std::vector<std::int32_t>{0, 1, 1, 3}));
  EXPECT_EQ(vtp_array<std::int64_t>(text, "Lines", "offsets"), (std::vector<std::int64_t>{2, 4}));
  table.edges.clear();
  text = written("a.vtp", table);
  EXPECT_EQ(vtp_array<std::int32_t>(text, "Verts", "connectivity"), (std::vector<std::int32_t>{0, 1, 2, 3}));
  EXPECT_NE(text.find("NumberOfPolys=\"0\""), std::string::npos);
}

TEST_F(Write, ObjHasCurvesAsLines) {
  const std::vector<Vec3> curve = {{0.1, 0, 431234.567891}, {1, 0, 0}, {2, 0, 0}, {3, -1e-9, 0}, {4, 0, 0}};
  const std::vector<Index> begin = {0, 2, 2};  // the second curve has no points
  write_obj_lines(path("a.obj"), curve, begin);
  EXPECT_EQ(read(path("a.obj")).points, curve);
  const std::string text = contents(path("a.obj"));
  EXPECT_EQ(text.substr(text.find("\nl ")), "\nl 1 2\nl 3 4 5\n");
}

TEST_F(Write, RefusesTablesThatDoNotFitTogether) {
  const std::vector<double> four{1, 2, 3, 4};
  const std::vector<std::uint8_t> third_word{0, 2, 1, 0};
  const std::pair<const char*, std::function<void(Result&)>> results[] = {
      {"u is too short", [](Result& r) { r.u.pop_back(); }},
      {"normals are too short", [](Result& r) { r.normals.pop_back(); }},
      {"status is too long", [](Result& r) { r.status.push_back(Status::ok); }},
      {"vertex 4 of 4", [](Result& r) { r.face_vertices[6] = 4; }},
      {"vertex -1", [](Result& r) { r.face_vertices[0] = -1; }},
      {"8 of 7 corners",
       [](Result& r) {
         r.face_begin = {0, 8};
       }},
      {"descending faces",
       [](Result& r) {
         r.face_begin = {0, 5, 3, 7};
       }},
      {"no faces, but corners", [](Result& r) { r.face_begin.clear(); }}};
  const std::pair<const char*, std::function<void(Table&)>> tables[] = {
      {"no name", [&](Table& t) { t.add("", four); }},
      {"two words", [&](Table& t) { t.add("two words", four); }},
      {"comma", [&](Table& t) { t.add("comma,", four); }},
      {"line end", [&](Table& t) { t.add("line\n", four); }},
      {"two words, code 2",
       [&](Table& t) {
         t.columns.push_back({{"kind"}, CodedWords{third_word, {"near", "far"}}});
       }},
      {"image 3 x 2",
       [](Table& t) {
         t.acquisition = {3, 2};
       }},
      {"image 0 x 0",
       [](Table& t) {
         t.acquisition = {0, 0};
       }},
      {"image 5 x 1",
       [](Table& t) {
         t.acquisition = {5, 1};
       }},
      {"image 4 x 0", [](Table& t) {
         t.acquisition = {4, 0};
       }}};
  for (const auto& [name, change] : results) {
    Result result;
    change(result);
    EXPECT_THROW(write(path("a.csv"), result.table()), InvalidArgument) << name;
  }
  const Result result;
  for (const auto& [name, change] : tables) {
    Table table = result.table();
    change(table);
    EXPECT_THROW(write(path("a.csv"), table), InvalidArgument) << name;
  }
  Table table = result.table();
  table.edges = {{0, 4}};
  EXPECT_THROW(write(path("a.ply"), table), InvalidArgument);
  table = {};
  table.add("u", result.u);
  EXPECT_THROW(write(path("a.vtp"), table), InvalidArgument) << "no positions";
  EXPECT_EQ(files_left(), 0u);
  table.acquisition = {1, 4};
  write(path("a.csv"), table);
}

TEST_F(Write, RefusesUnknownTypesAndListsTheKnown) {
  for (const char* name : {"a.txt", "a", "a.obj", "a.csv.gz"}) {
    EXPECT_THROW(check_writable(path(name)), IoError) << name;
    for (const std::string& extension : extensions(Use::write))
      ahm::test::expect_error<IoError>([&] { write(path(name), Result().table()); }, extension);
  }
  EXPECT_EQ(files_left(), 0u);
}

TEST_F(Write, TakesTheFormatFromTheExtensionOrByName) {
  const Result result;
  write(path("map.dat"), result.table(), ".csv");
  EXPECT_EQ(contents(path("map.dat")), written("map.csv", result.table()));
}

TEST_F(Write, ReportsAFullDiskAndLeavesNothing) {
  for (const char* name : {"a.csv", "a.ply", "a.pcd"}) {
    std::filesystem::create_symlink("/dev/full", path(name));
    EXPECT_THROW(write(path(name), Result().table()), IoError) << name;
  }
  EXPECT_THROW(write("/dev/full", Result().table()), IoError);
  EXPECT_EQ(files_left(), 3u) << "only the links";
}

TEST_F(Write, AppendsCsvToStandardOutput) {
  const Result result;
  make("redirected", "before\n");
  ::fflush(stdout);
  const int saved = ::dup(STDOUT_FILENO);
  const int file = ::open(path("redirected").c_str(), O_WRONLY | O_APPEND);
  ::dup2(file, STDOUT_FILENO);
  write("/dev/stdout", result.table());
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  ::close(file);
  EXPECT_EQ(contents(path("redirected")), "before\n" + written("direct.csv", result.table()));
}

TEST_F(Write, CheckWritableForeseesFailures) {
  for (const std::string& name :
       {path("a.csv").string(), path("A.PLY").string(), std::string("relative.csv"), std::string("/dev/null")})
    EXPECT_NO_THROW(check_writable(name)) << name;
  EXPECT_EQ(files_left(), 0u);
  std::filesystem::create_directory(path("dir.csv"));
  make("file", "x");
  for (const char* name : {"absent/a.csv", "dir.csv", "file/a.csv"})
    EXPECT_THROW(check_writable(path(name)), IoError) << name;
  if (::geteuid() == 0) return;  // root may write everywhere
  std::filesystem::permissions(directory_, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THROW(check_writable(path("a.csv")), IoError);
  std::filesystem::permissions(directory_, std::filesystem::perms::owner_all);
}

}  // namespace
}  // namespace ahm::io::test

// Laws of all readers, on the files of cases.hpp.
#include <random>
#include <sstream>

#include "ahm/io/formats.hpp"
#include "cases.hpp"
#include "comma_locale.hpp"
#include "files.hpp"
#include "streamed.hpp"

namespace ahm::io::test {
namespace {

class Damaged : public Files {
 protected:
  /// A file is read, with contents that fit together, or an error names it (or another file to which it refers).
  /// @return whether it is read
  bool read_or_refuse(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path file = make(name, bytes);
    try {
      const Geometry g = read(file);
      EXPECT_TRUE(g.normals.empty() || g.normals.size() == g.points.size());
      EXPECT_TRUE(g.colors.empty() || g.colors.size() == g.points.size());
      for (const Property& property : g.properties) EXPECT_EQ(property.values.size(), g.points.size());
      for (const Index vertex : g.face_vertices) EXPECT_LT(static_cast<std::size_t>(vertex), g.points.size());
      return true;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(directory_.string() + "/"), std::string::npos) << error.what();
      return false;
    }
  }

  std::mt19937 random_{42};
};

class Readers : public Damaged, public ::testing::WithParamInterface<std::string> {
 protected:
  const Cases& cases() const { return all_cases().at(GetParam()); }

  /// Calls `check` with the files cut to up to 500 lengths each.
  template <class File, class Check>
  static void cut_anywhere(const File& file, const Check& check) {
    for (std::size_t size = 1; size < file.bytes.size(); size += 1 + file.bytes.size() / 500)
      check(file.bytes.substr(0, size));
  }
};

TEST_P(Readers, ReturnTheContents) {
  for (const GoodFile& file : cases().good_files) {
    EXPECT_EQ(contents_of(read_bytes(file.name, file.bytes)), file.contents) << file.name;
    std::istringstream stream(file.bytes);
    EXPECT_EQ(contents_of(read(stream, lower_extension(file.name))), file.contents) << file.name;
  }
}

TEST_P(Readers, RefuseBadFiles) {
  for (const BadFile& file : cases().bad_files) expect_refused(file.name, file.bytes, file.parts);
}

TEST_P(Readers, DoNotDependOnTheLocale) {
  const CommaLocale locale;
  for (const GoodFile& file : cases().good_files)
    EXPECT_EQ(contents_of(read_bytes(file.name, file.bytes)), file.contents) << file.name;
  for (const BadFile& file : cases().bad_files) expect_refused(file.name, file.bytes, file.parts);
}

TEST_P(Readers, ReadOrRefuseFilesCutAnywhere) {
  for (const GoodFile& file : cases().good_files)
    cut_anywhere(file, [&](const std::string& bytes) {
      const bool is_read = read_or_refuse(file.name, bytes);
      EXPECT_FALSE(is_read && file.from <= bytes.size() && bytes.size() < file.required)
          << file.name << " " << bytes.size();
    });
}

TEST_P(Readers, ReadOrRefuseFilesWithBytesChanged) {
  for (const GoodFile& file : cases().good_files)
    for (int round = 0; round < 200; ++round) {
      std::string changed = file.bytes;
      for (std::size_t k = 0; k <= random_() % 3; ++k)
        changed[random_() % changed.size()] = static_cast<char>(round % 2 == 0 ? random_() : ' ' + random_() % 64);
      read_or_refuse(file.name, changed);
    }
}

std::vector<std::string> all_formats() {
  std::vector<std::string> names;
  for (const auto& [name, cases] : all_cases()) names.push_back(name);
  return names;
}

std::vector<std::string> streamed_formats() {
  std::vector<std::string> names = all_formats();
  std::erase_if(names,
                [](const auto& name) { return name != "columns" && name != "las" && name != "pcd" && name != "ply"; });
  return names;
}

constexpr auto name_of = [](const ::testing::TestParamInfo<std::string>& info) { return info.param; };
INSTANTIATE_TEST_SUITE_P(Of, Readers, ::testing::ValuesIn(all_formats()), name_of);

class Streams : public Readers {};

TEST_P(Streams, ReadWhatTheWholeFileContains) {
  const auto check = [&](const std::string& name, const std::string& bytes) {
    const auto file = make(name, bytes);
    const std::string error = find_streamed(file).error;
    if (error.find("it has faces") == error.npos && error.find("LZF") == error.npos)
      return expect_streamed_as_read(file);
    const bool has_faces = bytes.find("element face") != bytes.npos || bytes.find("element tristrips") != bytes.npos;
    EXPECT_TRUE(has_faces || !find_whole(file).error.empty()) << error;
    return false;
  };
  const auto check_all = [&](const auto& file) {
    cut_anywhere(file, [&](const std::string& bytes) { check(file.name, bytes); });
    return check(file.name, file.bytes);
  };
  for (const GoodFile& file : cases().good_files)
    EXPECT_EQ(check_all(file), file.contents.find("; faces") == file.contents.npos) << file.name;
  for (const BadFile& file : cases().bad_files) check_all(file);
}

INSTANTIATE_TEST_SUITE_P(Of, Streams, ::testing::ValuesIn(streamed_formats()), name_of);

TEST_F(Damaged, RandomBytesAreReadOrRefused) {
  const std::string beginnings[] = {
      "",
      "ply\nformat binary_little_endian 1.0\n",
      "solid",
      "OFF\n",
      "LASF",
      "//X Y Z\n",
      "v ",
      "\x1f\x8b\x08",
      "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 4 float\n",
      "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"4\"><Points><DataArray type=\"Float32\" "
      "NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece></PolyData>"
      "<AppendedData encoding=\"raw\">_"};
  for (const std::string& extension : extensions(Use::read))
    for (const std::string& beginning : beginnings)
      for (int round = 0; round < 20; ++round) {
        std::string bytes = beginning;
        for (int k = 0; k < 400; ++k) bytes += static_cast<char>(random_());
        read_or_refuse("random" + extension, bytes);
      }
}

TEST_F(Damaged, WordsInAnyOrderAreReadOrRefused) {
  const std::vector<std::string> words = {"OFF",     "off", "v",        "f",     "1",     "2",     "3",
                                          "-1",      "0.5", "1,5",      ",",     ";",     "\n",    "\n",
                                          "\t",      "//",  "x y z",    "r g b", "facet", "SOLID", "vertex",
                                          "element", "ply", "property", "nan",   "1e400", "65535", "\\\n"};
  for (const std::string& extension : extensions(Use::read))
    for (int round = 0; round < 200; ++round) {
      std::string text;
      for (int k = 0; k < 40; ++k) text += words[random_() % words.size()] + " ";
      read_or_refuse("words" + extension, text);
    }
}

}  // namespace
}  // namespace ahm::io::test

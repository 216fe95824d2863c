/// \file
/// Files that every reader is tested with. Each format adds a table; readers_test.cpp contains the laws that hold for all of them.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "ahm/io/geometry.hpp"

namespace ahm::io::test {

struct GoodFile {
  std::string name;
  std::string bytes;
  std::string contents;        ///< as printed by `contents_of`
  std::size_t from, required;  ///< the file is refused if it is cut to a number of bytes in [from, required)
};

struct BadFile {
  std::string name;
  std::string bytes;
  std::vector<std::string> parts;  ///< parts of the message, in addition to the name of the file
};

/// The files of one format. Their extensions select the reader.
struct Cases {
  static constexpr std::size_t all = std::string::npos;

  std::vector<GoodFile> good_files;
  std::vector<BadFile> bad_files;

  void good(std::string name, std::string bytes, std::string contents, std::size_t required = 0, std::size_t from = 0) {
    required = std::min(required, bytes.size());
    good_files.push_back({std::move(name), std::move(bytes), std::move(contents), from, required});
  }
  void bad(std::string name, std::string bytes, std::vector<std::string> parts = {}) {
    bad_files.push_back({std::move(name), std::move(bytes), std::move(parts)});
  }
};

/// All that a reader returns, in one line: points; faces; normals; colors; properties; image; warnings.
std::string contents_of(const Geometry& g);

/// The files of all formats that this build reads, by the name of the format.
const std::map<std::string, Cases>& all_cases();

Cases column_cases();
Cases gltf_cases();
Cases las_cases();
Cases obj_cases();
Cases off_cases();
Cases pcd_cases();
Cases ply_cases();
Cases stl_cases();
Cases vtk_cases();

}  // namespace ahm::io::test

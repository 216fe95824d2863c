/// \file
/// Reads, writes and damages files of the tests of tiles.
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::test {

using std::filesystem::path;

inline std::string read_file(const path& name) {
  std::ifstream file(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_file(const path& name, std::string_view bytes) { std::ofstream(name, std::ios::binary) << bytes; }

inline void flip_bit(const path& name, std::uintmax_t at) {
  std::string bytes = read_file(name);
  bytes.at(at) ^= 4;
  write_file(name, bytes);
}

inline void copy_over(const path& from, const path& to) {
  std::filesystem::copy(from, to, std::filesystem::copy_options::overwrite_existing);
}

/// Names and bytes of all files of a folder.
inline std::map<std::string, std::string> contents(const path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files[entry.path().filename().string()] = read_file(entry.path());
  return files;
}

/// A named pipe in the place of a file. Its readers wait forever. The file returns with the end of the object.
class BlockedFile {
 public:
  explicit BlockedFile(path name) : name_(std::move(name)), kept_(name_.string() + ".kept") {
    std::filesystem::rename(name_, kept_);
    EXPECT_EQ(::mkfifo(name_.c_str(), 0600), 0);
  }
  ~BlockedFile() { std::filesystem::rename(kept_, name_); }
  BlockedFile(const BlockedFile&) = delete;
  BlockedFile& operator=(const BlockedFile&) = delete;

 private:
  path name_, kept_;
};

/// Numbers of rows in a CSV file, and the rest of their lines from the first comma. Each row occurs once, in any order.
inline std::map<int, std::string> csv_rows(const path& csv, const std::string& header) {
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, header);
  std::map<int, std::string> rows;
  while (std::getline(file, line)) {
    const auto comma = line.find(',');
    EXPECT_TRUE(rows.emplace(std::stoi(line.substr(0, comma)), line.substr(comma)).second) << line;
  }
  return rows;
}

/// u, v, distance and spread of a line of `csv_rows`. NaN: an empty field.
inline std::vector<double> numbers_of(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream text(line.substr(1));
  for (std::string word; numbers.size() < 4 && std::getline(text, word, ',');)
    numbers.push_back(word.empty() ? NAN : std::stod(word));
  return numbers;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline void write_npy(const path& name, const std::string& type, const std::string& shape, std::string_view bytes) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 11, ' ');
  header += '\n';
  const auto size = static_cast<std::uint16_t>(header.size());
  std::ofstream file(name, std::ios::binary);
  file.write("\x93NUMPY\x01\x00", 8).write(reinterpret_cast<const char*>(&size), 2) << header << bytes;
}

inline void write_column(const path& name, const std::vector<double>& values) {
  write_npy(name, "<f8", "(" + std::to_string(values.size()) + ",)", bytes_of(values));
}

inline void write_points(const path& name, const std::vector<Vec3>& points) {
  write_file(name, "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size()) +
                       "\nproperty double x\nproperty double y\nproperty double z\nend_header\n" + bytes_of(points));
}

}  // namespace ahm::test

/// \file
/// A folder of files for one test, and helpers that write and read them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/read.hpp"
#include "support/temporary_folder.hpp"

namespace ahm::io::test {

class Files : public ::testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return directory_ / name; }

  std::filesystem::path make(const std::string& name, std::string_view bytes) const {
    std::ofstream(path(name), std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path(name);
  }

  Geometry read_bytes(const std::string& name, std::string_view bytes) const { return read(make(name, bytes)); }

  /// Expects an error whose message names the file and contains all `parts`.
  void expect_refused(const std::string& name, std::string_view bytes, const std::vector<std::string>& parts) const {
    expect_refused(make(name, bytes), parts);
  }

  static void expect_refused(const std::filesystem::path& path, const std::vector<std::string>& parts) {
    try {
      read(path);
      ADD_FAILURE() << path << " was read; expected: " << ::testing::PrintToString(parts);
    } catch (const IoError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(path.string()), std::string::npos) << message;
      for (const std::string& part : parts)
        EXPECT_NE(message.find(part), std::string::npos) << part << " not in: " << message;
    }
  }

  static std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::size_t files_left() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(directory_), {}));
  }

  const ahm::test::TemporaryFolder folder_;
  const std::filesystem::path& directory_ = folder_.directory();
};

/// The bytes of a value in the given order.
template <class T>
std::string bytes_of(T value, std::endian order = std::endian::little) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return {raw.data(), raw.size()};
}

}  // namespace ahm::io::test

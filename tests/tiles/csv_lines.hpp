/// \file
/// What stands in a CSV file behind the number of each row.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace ahm::test {

/// From the first comma on; each row once, in any order.
inline std::map<int, std::string> csv_lines(const std::filesystem::path& csv, const std::string& header) {
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

}  // namespace ahm::test

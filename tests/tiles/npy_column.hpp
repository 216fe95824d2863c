/// \file
/// Columns as files of NumPy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace ahm::test {

inline void write_npy(const std::filesystem::path& name, const std::string& type, const std::string& shape,
                      std::string_view bytes) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 11, ' ');
  header += '\n';
  const auto size = static_cast<std::uint16_t>(header.size());
  std::ofstream file(name, std::ios::binary);
  file.write("\x93NUMPY\x01\x00", 8).write(reinterpret_cast<const char*>(&size), 2) << header << bytes;
}

inline std::string bytes_of(const std::vector<double>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}

inline void write_column(const std::filesystem::path& name, const std::vector<double>& values) {
  write_npy(name, "<f8", "(" + std::to_string(values.size()) + ",)", bytes_of(values));
}

}  // namespace ahm::test

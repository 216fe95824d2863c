/// \file
/// Writes named arrays to a NumPy .npz file.
///
/// \code
/// ahm::io::NpzFile file("maps.npz");
/// file.add("indptr", {maps.indptr.size()}, std::span<const ahm::Offset>(maps.indptr));
/// file.add("log", {maps.indices.size(), 2}, std::span<const double>(maps.logs), ahm::io::NpyType::float32);
/// file.commit();                            // python: numpy.load("maps.npz")["log"]
/// \endcode
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/types.hpp"

namespace ahm::io {

/// Storage type of doubles. A complex element consists of two values: real part, imaginary part.
enum class NpyType { float64, float32, complex128, complex64 };

/// Whether this build can write .npz files (AHM_WITH_MINIZIP).
bool has_npz() noexcept;

/// A .npz file: an uncompressed zip archive of little-endian .npy arrays in C order, of any size. The file appears on
/// `commit`, or not at all.
class NpzFile {
 public:
  /// @throws IoError when the file cannot be created or is a pipe, or this build has no minizip
  explicit NpzFile(const std::filesystem::path& path);
  ~NpzFile();
  NpzFile(const NpzFile&) = delete;
  NpzFile& operator=(const NpzFile&) = delete;

  /// Adds an array.
  /// @param shape  extents, slowest index first. Their product is the length of `values`, or half of it for complex types
  /// @throws InvalidArgument if shape and length do not match; IoError
  void add(const std::string& name, const std::vector<std::size_t>& shape, std::span<const double> values,
           NpyType type = NpyType::float64);
  void add(const std::string& name, const std::vector<std::size_t>& shape, std::span<const std::int32_t> values);
  void add(const std::string& name, const std::vector<std::size_t>& shape, std::span<const std::int64_t> values);
  /// Adds an array of booleans, stored as 0 or 1.
  void add(const std::string& name, const std::vector<std::size_t>& shape, std::span<const std::uint8_t> values);

  /// Writes the directory of the archive and renames the file to its target. @throws IoError
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm::io

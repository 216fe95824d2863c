/// \file
/// A number per row of the input, from a file that need not fit into memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace ahm::distributed {

/// A one-dimensional .npy file of float64, memory-mapped.
class RowValues {
 public:
  /// @throws IoError where it cannot be read, is no such file, or is cut short
  explicit RowValues(const std::filesystem::path& path);
  ~RowValues();
  RowValues(RowValues&& other) noexcept;
  RowValues& operator=(RowValues&&) = delete;

  std::size_t size() const noexcept { return size_; }
  double operator[](std::size_t row) const;

 private:
  void* data_ = nullptr;
  std::size_t bytes_ = 0, begin_ = 0, size_ = 0;  ///< of the file; where values begin; how many
};

}  // namespace ahm::distributed

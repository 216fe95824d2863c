/// \file
/// A small temporary array, on the stack for up to 9 numbers (d x d for d <= 3).
#pragma once

#include <array>
#include <span>
#include <vector>

namespace ahm {

class Scratch {
 public:
  explicit Scratch(std::size_t size) : size_(size) {
    if (size > small_.size()) large_.resize(size);
  }
  double* data() { return large_.empty() ? small_.data() : large_.data(); }
  std::span<double> span() { return {data(), size_}; }

 private:
  std::size_t size_;
  std::array<double, 9> small_;
  std::vector<double> large_;
};

}  // namespace ahm

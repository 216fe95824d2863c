/// \file
/// Numbers and points from the bytes of a fuzzer.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/types.hpp"

namespace ahm::fuzz {

/// Reads bytes in their order; zeros after their end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  template <class Number>
  Number take() {
    Number number{};
    const std::size_t size = left_ < sizeof number ? left_ : sizeof number;
    std::memcpy(&number, data_, size);
    data_ += size, left_ -= size;
    return number;
  }
  std::uint8_t byte() { return take<std::uint8_t>(); }
  /// A number in [0, largest].
  Index number(Index largest) {
    return static_cast<Index>(take<std::uint16_t>() % (static_cast<unsigned>(largest) + 1));
  }
  /// Any double, or (`coarse`) a multiple of 1/4, so that some points are equal or collinear.
  double coordinate(bool coarse) { return coarse ? take<std::int8_t>() / 4.0 : take<double>(); }
  Vec3 point(bool coarse) { return {coordinate(coarse), coordinate(coarse), coordinate(coarse)}; }
  std::vector<Vec3> points(std::size_t count, bool coarse) {
    std::vector<Vec3> all(count);
    for (Vec3& one : all) one = point(coarse);
    return all;
  }
  /// Corners in [0, largest].
  std::vector<Triangle> triangles(std::size_t count, Index largest) {
    std::vector<Triangle> all(count);
    for (Triangle& face : all) face = {number(largest), number(largest), number(largest)};
    return all;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/// Reports a finding if a law does not hold.
inline void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", law);
  std::abort();
}

/// Calls the function and catches documented exceptions (`ahm::Error` with a message). Any other end is a finding.
template <class Work>
int allow_refusals(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    require(*error.what() != '\0', "errors have messages");
    require(std::strncmp(error.what(), "PCD files are read by", 21) != 0, "the module that reads PCD exists");
  } catch (const std::bad_alloc&) {
  }
  return 0;
}

}  // namespace ahm::fuzz

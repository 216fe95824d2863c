/// \file
/// What a fuzzer's bytes stand for.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "ahm/error.hpp"
#include "ahm/types.hpp"

namespace ahm::fuzz {

/// Bytes taken one after the other; zeros behind their end.
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
  /// In [0, most].
  Index number(Index most) { return static_cast<Index>(take<std::uint16_t>() % (static_cast<unsigned>(most) + 1)); }
  bool is_empty() const { return left_ == 0; }

  /// A coordinate: any double whatever, or (`coarse`) one of a few, so that points meet and fall in line.
  double coordinate(bool coarse) { return coarse ? take<std::int8_t>() / 4.0 : take<double>(); }
  Vec3 point(bool coarse) { return {coordinate(coarse), coordinate(coarse), coordinate(coarse)}; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/// A law that does not hold: a finding.
inline void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", law);
  std::abort();
}

/// Runs the work; refusals that are documented (ahm::Error, with words) are none of our business, everything else ends the
/// fuzzer.
template <class Work>
int allow_refusals(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    require(*error.what() != '\0', "errors have words");
    require(std::strncmp(error.what(), "PCD files are read by", 21) != 0, "the module that reads PCD is there");
  } catch (const std::bad_alloc&) {
  }
  return 0;
}

}  // namespace ahm::fuzz

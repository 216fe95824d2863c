/// \file
/// Disables subnormal numbers, which are slow on some processors.
#pragma once

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace ahm {

/// While an object of this class exists, its thread replaces subnormal numbers (below 2e-308) by zero, on x86.
/// Entries of a factor decay like the heat between their vertices. In the fronts of large graphs these are up to a thousand edges
/// apart. Products of such entries are negligible, but some processors take a hundred times as long to compute them.
class FlushSubnormals {
 public:
#ifdef __SSE2__
  FlushSubnormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | results | operands); }
  ~FlushSubnormals() { _mm_setcsr(before_); }
#else
  FlushSubnormals() {}
  ~FlushSubnormals() {}
#endif
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;

 private:
#ifdef __SSE2__
  static constexpr unsigned results = 0x8000, operands = 0x40;  // bits FTZ and DAZ of the register MXCSR
  unsigned before_;
#endif
};

}  // namespace ahm

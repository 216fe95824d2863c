/// \file
/// Numbers too small to matter, and too slow to keep.
#pragma once

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace ahm {

/// While an object of this class lives, what its thread computes is zero where it is smaller than all normal numbers (2e-308), if the
/// processor can (x86). Entries of a factor decay by the heat between their vertices, which are up to a thousand edges apart in the
/// fronts of large graphs; products of such entries are nothing beside the others, and some processors take a hundred times as long
/// for them.
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
  static constexpr unsigned results = 0x8000, operands = 0x40;  // of the register MXCSR
  unsigned before_;
#endif
};

}  // namespace ahm

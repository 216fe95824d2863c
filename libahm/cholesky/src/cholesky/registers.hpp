/// \file
/// Vectors of doubles, and loops compiled for the widest registers of the processor.
#pragma once

#include <type_traits>

namespace ahm {

/// A vector of N doubles at any address. Pass vectors by pointer only: compilers assume that references are aligned, and that the
/// processor has registers for parameters passed by value. Write pointers to them with the name of the type: `auto` drops the alignment.
template <int N>
struct Lanes {
  using Type [[gnu::vector_size(N * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] = double;
};

/// Four real or two complex numbers.
using Four = Lanes<4>::Type;

[[gnu::always_inline]] inline const Four* four(const double* numbers) { return reinterpret_cast<const Four*>(numbers); }
[[gnu::always_inline]] inline Four* four(double* numbers) { return reinterpret_cast<Four*>(numbers); }

/// Register sets that loops are compiled for.
enum class Registers {
  plain,  ///< no AVX: any processor
  avx2,
  avx512
};

/// The widest registers of this processor.
inline Registers widest_registers() {
#ifdef __x86_64__
  static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  static const Registers widest = !avx2                               ? Registers::plain
                                  : __builtin_cpu_supports("avx512f") ? Registers::avx512
                                                                      : Registers::avx2;
  return widest;
#else
  return Registers::plain;
#endif
}

namespace detail {

#ifdef __x86_64__
template <class Body>
[[gnu::target("avx512f,fma"), gnu::flatten]] auto with_avx512(const Body& body) {
  return body(std::integral_constant<int, 8>());
}
template <class Body>
[[gnu::target("avx2,fma"), gnu::flatten]] auto with_avx2(const Body& body) {
  return body(std::integral_constant<int, 4>());
}
#endif

}  // namespace detail

/// Calls body(N): compiled for AVX-512 (N = 8) or AVX2 (N = 4) if the processor has it, otherwise for any processor (N = 4). N is a
/// `std::integral_constant`. GCC also compiles all that `body` calls for these registers, clang what is `always_inline`. Results differ
/// between processors by rounding.
template <class Body>
auto in_widest_registers(const Body& body) {
#ifdef __x86_64__
  if (widest_registers() == Registers::avx512) return detail::with_avx512(body);
  if (widest_registers() == Registers::avx2) return detail::with_avx2(body);
#endif
  return body(std::integral_constant<int, 4>());
}

}  // namespace ahm

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

/// Calls body(N), N = 8 or 4: compiled for AVX-512 (N = 8) or AVX2 if the processor has it, otherwise for any processor. N is a
/// `std::integral_constant`. All that `body` calls is compiled with it. Results differ between processors by rounding.
template <class Body>
auto in_widest_registers(const Body& body) {
#ifdef __x86_64__
  static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  static const bool avx512 = avx2 && __builtin_cpu_supports("avx512f");
  if (avx512) return detail::with_avx512(body);
  if (avx2) return detail::with_avx2(body);
#endif
  return body(std::integral_constant<int, 4>());
}

}  // namespace ahm

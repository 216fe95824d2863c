/// \file
/// Four numbers at once.
#pragma once

namespace ahm {

/// Four real numbers or two complex ones, anywhere in memory. By pointers only: compilers take it of references that they are
/// aligned, and of values in parameters that the processor has registers for them.
using Four [[gnu::vector_size(4 * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] = double;

[[gnu::always_inline]] inline const Four* four(const double* numbers) { return reinterpret_cast<const Four*>(numbers); }
[[gnu::always_inline]] inline Four* four(double* numbers) { return reinterpret_cast<Four*>(numbers); }

}  // namespace ahm

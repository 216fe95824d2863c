/// \file
/// Converts out-of-memory errors to `ResourceExhausted`. Not part of the public interface.
#pragma once

#include <cstddef>
#include <new>
#include <stdexcept>
#include <string>

#include "ahm/error.hpp"

namespace ahm::detail {

/// Returns work(). @throws ResourceExhausted ("out of memory while `doing`")
template <class Work>
auto with_memory_check(const std::string& doing, const Work& work) try {
  return work();
} catch (const std::bad_alloc&) {
  throw ResourceExhausted("out of memory while " + doing);
} catch (const std::length_error&) {
  throw ResourceExhausted("out of memory while " + doing);
}

/// Allocates and frees memory, to test that it is available. Call it before code that crashes when an allocation fails.
/// @throws std::bad_alloc
inline void require_memory(std::size_t bytes) { ::operator delete(::operator new(bytes)); }

}  // namespace ahm::detail

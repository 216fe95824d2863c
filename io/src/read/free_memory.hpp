/// \file
/// How much memory there is to take.
#pragma once

#include <cstdint>

namespace ahm::io {

/// Bytes this process can still fill: what the machine has, its control group allows and the limit of its address space
/// leaves, whichever is least.
std::uint64_t free_memory();

}  // namespace ahm::io

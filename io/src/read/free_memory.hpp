/// \file
/// How much memory there is to take.
#pragma once

#include <cstdint>

namespace ahm::io {

/// Bytes this process can still fill: what the machine has, its control group allows and the limit of its address space
/// leaves, whichever is least.
std::uint64_t free_memory();
/// How much of that one input whose size is not known before may fill; see `fail_too_large`.
inline std::uint64_t room_for_input() { return free_memory() / 3; }

}  // namespace ahm::io

/// \file
/// How much memory this process may take.
#pragma once

#include <filesystem>

namespace ahm {

/// The least memory limit among a process's control groups, of version 1 and 2, and the groups around them, in bytes;
/// infinity where there is none.
/// @param groups  what /proc/self/cgroup says: lines "number:controllers:path"
/// @param mounts  where the hierarchies are mounted: /sys/fs/cgroup
double control_group_limit(const std::filesystem::path& groups, const std::filesystem::path& mounts);

/// The lesser of the process's limits of address space and of data (RLIMIT_AS, RLIMIT_DATA); infinity without.
double resource_limit();

/// What of that limit the process has not mapped yet; infinity where there is none.
double address_space_left();

/// Address space that each thread of a solve takes beside its numbers: a stack, an arena of the allocator, a buffer of BLAS.
inline constexpr double bytes_per_thread = 208e6;

/// Whether the system may refuse address space before memory is used up: by a `resource_limit`, or since it never promises
/// more memory than it has (vm.overcommit_memory = 2).
bool address_space_is_limited();

}  // namespace ahm

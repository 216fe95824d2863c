/// \file
/// Memory of the machine and limits of this process. Systems other than POSIX have no limits (no_memory_limits.cpp).
#pragma once

#include <string>

namespace ahm {

/// The smallest memory limit of a process's control groups (versions 1 and 2) and their ancestors, in bytes; infinity if there is none.
/// @param groups  the file /proc/self/cgroup, with lines "number:controllers:path"
/// @param mounts  folder where the hierarchies are mounted: /sys/fs/cgroup
double control_group_limit(const std::string& groups, const std::string& mounts);

/// Memory of the machine, in bytes; infinity if it is unknown.
double physical_memory();

/// The smaller of the process's limits RLIMIT_AS (address space) and RLIMIT_DATA, in bytes; infinity if there is none.
double resource_limit();

/// The part of `resource_limit` that the process has not mapped yet, in bytes; infinity if there is no limit.
double address_space_left();

/// Address space of each thread of a solve, without its arrays: a stack and an arena of the allocator. Bytes.
inline constexpr double bytes_per_thread = 80e6;

}  // namespace ahm

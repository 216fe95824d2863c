#include "cholesky/memory_limits.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace ahm {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Reads a number from a file. Returns infinity if there is no such file, or if it contains a word ("max").
double number_in(const std::filesystem::path& file) {
  double value = infinity;
  return std::ifstream(file) >> value ? value : infinity;
}

/// The smallest limit of a control group and its ancestors in a mounted hierarchy. In a container, the process's own group may be
/// mounted as the root, under any name.
double smallest_limit(const std::filesystem::path& mount, const std::filesystem::path& group, const char* file) {
  double least = number_in(mount / file);
  std::filesystem::path here = mount;
  for (const auto& name : group.relative_path()) least = std::min(least, number_in((here /= name) / file));
  return least;
}

}  // namespace

double control_group_limit(const std::string& groups, const std::string& mounts) {
  const std::filesystem::path folder(mounts);
  double least = infinity;
  std::ifstream lines(groups);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string group = line.substr(second + 1);
    std::string controllers(1, ',');
    controllers.append(line, first + 1, second - first - 1).push_back(',');
    if (controllers == ",,")
      for (const char* mount : {"", "unified"})
        least = std::min(least, smallest_limit(folder / mount, group, "memory.max"));
    else if (controllers.find(",memory,") != std::string::npos)
      least = std::min(least, smallest_limit(folder / "memory", group, "memory.limit_in_bytes"));
  }
  return least;
}

double physical_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && size > 0 ? static_cast<double>(pages) * static_cast<double>(size) : infinity;
}

double resource_limit() {
  double least = infinity;
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA})
    if (rlimit limit{}; getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      least = std::min(least, static_cast<double>(limit.rlim_cur));
  return least;
}

double address_space_left() {
  const double limit = resource_limit();
  if (std::isinf(limit)) return limit;
  const double pages = number_in("/proc/self/statm");
  return std::isinf(pages) ? limit : limit - pages * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace ahm

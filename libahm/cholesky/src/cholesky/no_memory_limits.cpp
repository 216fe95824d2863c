// Systems other than POSIX: WebAssembly has a memory of at most 4 GiB, which grows as needed.
#include <limits>

#include "cholesky/memory_limits.hpp"

namespace ahm {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

double control_group_limit(const std::string&, const std::string&) { return infinity; }
double physical_memory() { return sizeof(void*) == 4 ? 0x1p32 : infinity; }
double resource_limit() { return infinity; }
double address_space_left() { return infinity; }

}  // namespace ahm

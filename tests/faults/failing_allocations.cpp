#include "failing_allocations.hpp"

#include <link.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace {

constexpr long never = std::numeric_limits<long>::max();
std::atomic<long> until_failure{never};
std::atomic<bool> goes_on{false};
std::atomic<long> live{0}, made{0}, live_bytes{0}, peak_bytes{0};

/// minizip writes to what it did not get: whoever calls it tries beforehand whether there is memory.
constexpr std::array fatal_libraries{"/libminizip"};

struct Range {
  std::uintptr_t begin = 0, end = 0;
};

std::array<Range, fatal_libraries.size()> ranges() {
  std::array<Range, fatal_libraries.size()> found;
  const auto visit = [](dl_phdr_info* library, std::size_t, void* to) {
    for (std::size_t k = 0; k < fatal_libraries.size(); ++k) {
      if (std::strstr(library->dlpi_name, fatal_libraries[k]) == nullptr) continue;
      Range& range = static_cast<Range*>(to)[k];
      range.begin = library->dlpi_addr;
      for (int s = 0; s < library->dlpi_phnum; ++s)
        range.end = std::max<std::uintptr_t>(
            range.end, range.begin + library->dlpi_phdr[s].p_vaddr + library->dlpi_phdr[s].p_memsz);
    }
    return 0;
  };
  ::dl_iterate_phdr(visit, found.data());
  return found;
}

bool is_fatal(const void* caller) {
  static const auto known = ranges();
  const auto address = reinterpret_cast<std::uintptr_t>(caller);
  return std::any_of(known.begin(), known.end(),
                     [&](const Range& range) { return range.begin <= address && address < range.end; });
}

bool fails(const void* caller) {
  if (until_failure.load(std::memory_order_relaxed) == never || is_fatal(caller)) return false;
  const long left = until_failure.fetch_sub(1);
  return left == 1 || (left < 1 && goes_on.load());
}

void add_bytes(long bytes) {
  const long now = live_bytes += bytes;
  for (long peak = peak_bytes; now > peak && !peak_bytes.compare_exchange_weak(peak, now);) {
  }
}

long bytes_of(void* block) { return static_cast<long>(malloc_usable_size(block)); }

void* counted(void* block) {
  if (block != nullptr) {
    ++live;
    ++made;
    add_bytes(bytes_of(block));
  } else {
    errno = ENOMEM;
  }
  return block;
}

}  // namespace

// What glibc's own allocator is called besides.
extern "C" {
void* __libc_malloc(std::size_t);                 // NOLINT
void* __libc_calloc(std::size_t, std::size_t);    // NOLINT
void* __libc_realloc(void*, std::size_t);         // NOLINT
void* __libc_memalign(std::size_t, std::size_t);  // NOLINT
void __libc_free(void*);                          // NOLINT

void* malloc(std::size_t size) { return counted(fails(__builtin_return_address(0)) ? nullptr : __libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) {
  return counted(fails(__builtin_return_address(0)) ? nullptr : __libc_calloc(count, size));
}
void* memalign(std::size_t alignment, std::size_t size) {
  return counted(fails(__builtin_return_address(0)) ? nullptr : __libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  void* const got = memalign(alignment, size);
  if (got == nullptr) return ENOMEM;
  *block = got;
  return 0;
}
void* realloc(void* block, std::size_t size) {
  if (block == nullptr) return malloc(size);
  if (size == 0) {
    free(block);
    return nullptr;
  }
  if (fails(__builtin_return_address(0))) {
    errno = ENOMEM;
    return nullptr;
  }
  const long before = bytes_of(block);
  void* const moved = __libc_realloc(block, size);
  if (moved == nullptr) return nullptr;
  ++made;
  add_bytes(bytes_of(moved) - before);
  return moved;
}
void free(void* block) {
  if (block != nullptr) {
    --live;
    add_bytes(-bytes_of(block));
  }
  __libc_free(block);
}
}

namespace ahm::test {

FailingAllocation::FailingAllocation(long k, bool ever_after) {
  goes_on = ever_after;
  until_failure = k;
}
FailingAllocation::~FailingAllocation() { until_failure = never; }
bool FailingAllocation::happened() const { return until_failure.load() < 1; }

long live_blocks() { return live; }
long allocations() { return made; }

PeakBytes::PeakBytes() : before_(live_bytes) { peak_bytes = before_; }
long PeakBytes::operator()() const { return peak_bytes - before_; }

}  // namespace ahm::test

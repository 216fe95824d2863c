#include "failing_allocations.hpp"

#include <link.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace {

constexpr long never = std::numeric_limits<long>::max();
std::atomic<long> until_failure{never};
std::atomic<bool> fails_ever_after{false};
std::atomic<long> live{0}, made{0}, live_bytes{0}, peak_bytes{0};

/// The addresses of minizip's code. minizip writes to memory that it did not get, so its allocations never fail. Its callers check
/// beforehand that there is memory.
struct Minizip {
  std::uintptr_t begin = 0, end = 0;

  Minizip() {
    const auto visit = [](dl_phdr_info* library, std::size_t, void* self) {
      if (std::strstr(library->dlpi_name, "/libminizip") == nullptr) return 0;
      auto& range = *static_cast<Minizip*>(self);
      range.begin = library->dlpi_addr;
      for (const auto& part : std::span(library->dlpi_phdr, library->dlpi_phnum))
        range.end = std::max<std::uintptr_t>(range.end, range.begin + part.p_vaddr + part.p_memsz);
      return 1;
    };
    ::dl_iterate_phdr(visit, this);
  }
};

bool is_minizip(const void* caller) {
  static const Minizip code;
  const auto address = reinterpret_cast<std::uintptr_t>(caller);
  return code.begin <= address && address < code.end;
}

bool fails(const void* caller) {
  if (until_failure.load(std::memory_order_relaxed) == never || is_minizip(caller)) return false;
  const long left = until_failure.fetch_sub(1);
  return left == 1 || (left < 1 && fails_ever_after.load());
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

// Other names of glibc's allocator.
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
  fails_ever_after = ever_after;
  until_failure = k;
}
FailingAllocation::~FailingAllocation() { until_failure = never; }
bool FailingAllocation::happened() const { return until_failure.load() < 1; }

long live_blocks() { return live; }
long allocations() { return made; }

PeakBytes::PeakBytes() : before_(live_bytes) { peak_bytes = before_; }
long PeakBytes::operator()() const { return peak_bytes - before_; }

}  // namespace ahm::test

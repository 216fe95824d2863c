/// \file
/// The program ahm: parses the command line, runs the command, turns exceptions into messages and exit statuses.

#include <sys/resource.h>
#include <unistd.h>
#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>

#include "ahm/error.hpp"
#include "cli/command_line.hpp"
#include "cli/console.hpp"
#include "cli/interrupt.hpp"
#include "output/wording.hpp"

namespace {

using namespace ahm::app;

constexpr int failed = 1;
constexpr int usage = 2;
constexpr const char* out_of_memory =
    "out of memory; thin the input (--voxel), lower --k, or use a machine with more memory";

/// Prints an error in pieces, because there may be no memory to join them.
int report(std::string_view message, int status) {
  for (const std::string_view part : {std::string_view("ahm: error: "), message, std::string_view("\n")})
    print_to_stderr(part);
  return status;
}

/// Makes all threads share one arena if address space is limited: the allocator reserves 64 MB of it for each arena.
void share_one_arena_within_limits() {
#ifdef M_ARENA_MAX
  if (rlimit limit{}; getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) mallopt(M_ARENA_MAX, 1);
#endif
}

int run(int argc, char** argv) try {
  share_one_arena_within_limits();
  install_interrupt_handling("ahm");
  parse_command_line(argc, argv)();
  return 0;
} catch (const UsageError& e) {
  return report(e.message, usage);
} catch (const BrokenPipe&) {
  return failed;
} catch (const std::bad_alloc&) {
  return report(out_of_memory, failed);
} catch (const std::length_error&) {  // an array too long for any memory
  return report(out_of_memory, failed);
} catch (const ahm::Error& e) {
  if (e.fault() == "pipe_closed") return failed;  // not reported, as for BrokenPipe
  return report(worded(e), failed);
} catch (const std::exception& e) {
  return report(e.what(), failed);
} catch (...) {
  return report("unknown failure", failed);
}

}  // namespace

// All output is written when `run` returns. Exits without running the destructors of libraries: OpenBLAS, which CHOLMOD links, would wait for
// its threads, which never end if address space is too small for their buffers.
int main(int argc, char** argv) { _exit(run(argc, argv)); }

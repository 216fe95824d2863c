#include "cli/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <string>

#include "ahm/io/atomic_file.hpp"

namespace ahm::app {
namespace {

// Messages, set before the handlers are installed.
std::string interrupted, out_of_memory, unknown_failure;

void write_message(const std::string& message) {
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, message.data(), message.size());
}

// Makes only calls that are allowed in a signal handler.
extern "C" void on_signal(int number) {
  io::remove_unfinished_files();
  write_message(interrupted);
  _exit(128 + number);
}

[[noreturn]] void on_terminate() {
  io::remove_unfinished_files();
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
    write_message(unknown_failure);
  } catch (const std::bad_alloc&) {
    write_message(out_of_memory);
  } catch (...) {
    write_message(unknown_failure);
  }
  _exit(1);
}

}  // namespace

void install_interrupt_handling(const std::string& program) {
  interrupted = "\n" + program + ": interrupted\n";
  out_of_memory = program + ": error: out of memory\n";
  unknown_failure = program + ": error: unknown failure\n";
  std::set_terminate(on_terminate);
  signal(SIGPIPE, SIG_IGN);  // writing reports EPIPE
  signal(SIGXFSZ, SIG_IGN);  // writing reports EFBIG
  constexpr int ending[] = {SIGINT, SIGTERM, SIGHUP};
  struct sigaction action {};
  struct sigaction before {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (const int number : ending) sigaddset(&action.sa_mask, number);
  for (const int number : ending)
    if (number != SIGHUP || sigaction(number, nullptr, &before) != 0 ||
        before.sa_handler != SIG_IGN)  // ignored under nohup
      sigaction(number, &action, nullptr);
}

}  // namespace ahm::app

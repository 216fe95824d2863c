#include "cli/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <string>

#include "ahm/io/atomic_file.hpp"

namespace ahm::app {
namespace {

std::string message;  // set before any handler is

// Only calls that are allowed in a handler.
extern "C" void on_signal(int number) {
  io::remove_unfinished_files();
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, message.data(), message.size());
  _exit(128 + number);
}

}  // namespace

void install_interrupt_handling(const std::string& program) {
  message = "\n" + program + ": interrupted\n";
  signal(SIGPIPE, SIG_IGN);  // writing reports EPIPE
  signal(SIGXFSZ, SIG_IGN);  // writing reports EFBIG
  constexpr int ending[] = {SIGINT, SIGTERM, SIGHUP};
  struct sigaction action {};
  struct sigaction before {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (const int number : ending) sigaddset(&action.sa_mask, number);
  for (const int number : ending)
    if (number != SIGHUP || sigaction(number, nullptr, &before) != 0 || before.sa_handler != SIG_IGN)  // nohup
      sigaction(number, &action, nullptr);
}

}  // namespace ahm::app

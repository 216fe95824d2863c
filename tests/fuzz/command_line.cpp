// The command line, one word per line. It is parsed only: no file is read or written.
#include "cli/command_line.hpp"

#include <sstream>
#include <vector>

#include "bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> words{"ahm"};
  for (std::string word; words.size() < 40 && std::getline(lines, word, '\n');)
    words.push_back(word.substr(0, word.find('\0')));  // words end at '\0'
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  return fuzz::allow_refusals([&] {
    try {
      (void)app::parse_command_line(static_cast<int>(argv.size()), argv.data());
    } catch (const app::UsageError& error) {
      fuzz::require(!error.message.empty(), "usage errors have messages");
    }
  });
}

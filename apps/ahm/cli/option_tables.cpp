#include "cli/option_tables.hpp"

namespace ahm::app {

std::vector<CLI::App*> subcommands_of(CLI::App& program) {
  return program.get_subcommands([](CLI::App*) { return true; });
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> result;
  for (const std::string& name : option.get_snames()) result.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) result.push_back("--" + name);
  return result;
}

std::string first_line(const std::string& description) { return description.substr(0, description.find('\n')); }

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

}  // namespace ahm::app

#include "cli/option_tables.hpp"

#include <map>

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

namespace {

std::map<const CLI::Option*, std::vector<std::string>>& all_choices() {
  static std::map<const CLI::Option*, std::vector<std::string>> choices;
  return choices;
}

}  // namespace

const std::vector<std::string>& choices_of(const CLI::Option& option) { return all_choices()[&option]; }

void set_choices(const CLI::Option& option, const std::vector<std::string>& words) { all_choices()[&option] = words; }

}  // namespace ahm::app

#include "cli/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "ahm/util/shell.hpp"

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

namespace {

/// The options with a name. Positional arguments, which are files, are left out.
std::vector<CLI::Option*> options_of(CLI::App& app) {
  return app.get_options([](CLI::Option* option) { return !option->get_lnames().empty(); });
}

std::string bash(CLI::App& program) {
  std::vector<std::string> names;
  std::string cases, choices;
  for (CLI::App* app : subcommands_of(program)) {
    names.push_back(app->get_name());
    std::vector<std::string> all;
    for (const CLI::Option* option : options_of(*app))
      for (std::string& word : names_of(*option)) {
        if (const auto& words = choices_of(*option); !words.empty())
          choices += fmt::format("    {}) choices={} ;;\n", detail::in_quotes(app->get_name() + " " + word),
                                 detail::in_quotes(fmt::format("{}", fmt::join(words, " "))));
        all.push_back(std::move(word));
      }
    cases += fmt::format("    {}) options={} ;;\n", app->get_name(),
                         detail::in_quotes(fmt::format("{}", fmt::join(all, " "))));
  }
  return fmt::format(
      "# Completion of ahm for bash.\n"
      "_ahm() {{\n"
      "  local word=\"${{COMP_WORDS[COMP_CWORD]}}\" before=\"${{COMP_WORDS[COMP_CWORD-1]}}\" options='' choices=''\n"
      "  [ \"$before\" = = ] && before=\"${{COMP_WORDS[COMP_CWORD-2]}}\"\n"
      "  [ \"$word\" = = ] && word=''\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '{} --help --version' -- \"$word\")\n"
      "    return\n"
      "  fi\n"
      "  case \"${{COMP_WORDS[1]}}\" in\n{}  esac\n"
      "  case \"${{COMP_WORDS[1]}} $before\" in\n{}  esac\n"
      "  if [ -n \"$choices\" ]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$choices\" -- \"$word\")\n"
      "    return\n"
      "  fi\n"
      "  case \"$word\" in\n"
      "    -*) mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\") ;;\n"
      "    *) mapfile -t COMPREPLY < <(compgen -f -- \"$word\") ;;\n"
      "  esac\n"
      "}}\n"
      "complete -o filenames -F _ahm ahm\n",
      fmt::join(names, " "), cases, choices);
}

/// Escapes brackets and colons, which `_arguments` would interpret.
std::string for_zsh(const std::string& text) {
  std::string result;
  for (char c : text) result += (c == '[' || c == ']' || c == ':' ? "\\" : "") + std::string(1, c);
  return result;
}

std::string value_for_zsh(const CLI::Option& option) {
  if (!takes_value(option)) return "";
  const auto& words = choices_of(option);
  return ":" + for_zsh(option.get_type_name()) +
         (words.empty() ? ":_files" : fmt::format(":({})", fmt::join(words, " ")));
}

std::string value_for_fish(const CLI::Option& option) {
  if (!takes_value(option)) return "";
  const auto& words = choices_of(option);
  return words.empty() ? " -r" : " -x -a " + detail::in_quotes(fmt::format("{}", fmt::join(words, " ")));
}

std::string zsh(CLI::App& program) {
  std::string names, cases;
  for (CLI::App* app : subcommands_of(program)) {
    names += "    " + detail::in_quotes(app->get_name() + ":" + first_line(app->get_description())) + "\n";
    cases += fmt::format("    {}) _arguments", app->get_name());
    for (const CLI::Option* option : options_of(*app))
      for (const std::string& word : names_of(*option))
        cases += " \\\n      " + detail::in_quotes(word + "[" + for_zsh(first_line(option->get_description())) + "]" +
                                                   value_for_zsh(*option));
    cases += " \\\n      '*:file:_files' ;;\n";
  }
  return "#compdef ahm\n_ahm() {\n  local -a names=(\n" + names +
         "  )\n  if (( CURRENT == 2 )); then\n    _describe subcommand names\n    return\n  fi\n"
         "  local name=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $name in\n" +
         cases + "  esac\n}\n_ahm \"$@\"\n";
}

std::string fish(CLI::App& program) {
  std::string result =
      "# Completion of ahm for fish.\ncomplete -c ahm -n __fish_use_subcommand -f -l help -d 'Print help'\n"
      "complete -c ahm -n __fish_use_subcommand -f -l version -d 'Print versions'\n";
  for (CLI::App* app : subcommands_of(program)) {
    result += fmt::format("complete -c ahm -n __fish_use_subcommand -f -a {} -d {}\n", app->get_name(),
                          detail::in_quotes(first_line(app->get_description())));
    for (const CLI::Option* option : options_of(*app)) {
      result += fmt::format("complete -c ahm -n '__fish_seen_subcommand_from {}'", app->get_name());
      for (const std::string& name : option->get_snames()) result += " -s " + name;
      for (const std::string& name : option->get_lnames()) result += " -l " + name;
      result +=
          fmt::format("{} -d {}\n", value_for_fish(*option), detail::in_quotes(first_line(option->get_description())));
    }
  }
  return result;
}

}  // namespace

std::optional<std::string> completion(CLI::App& program, std::string_view shell) {
  if (shell == "bash") return bash(program);
  if (shell == "zsh") return zsh(program);
  if (shell == "fish") return fish(program);
  return std::nullopt;
}

namespace {

/// Text that roff prints unchanged: escapes and requests are quoted, and hyphens can be copied.
std::string plain(const std::string& text) {
  std::string result;
  bool line_begins = true;
  for (char c : text) {
    if (line_begins && (c == '.' || c == '\'')) result += "\\&";
    line_begins = c == '\n';
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result;
}

/// A block in which roff does not fill lines.
std::string verbatim(const std::string& text) { return ".nf\n" + plain(text) + "\n.fi\n"; }

std::string entry(const CLI::Option& option) {
  std::string names = fmt::format("{}", fmt::join(names_of(option), ", "));
  if (names.empty()) names = option.get_name(true);
  std::string result = ".TP\n\\fB" + plain(names) + "\\fR";
  if (takes_value(option) && !option.get_type_name().empty())
    result += " \\fI" + plain(option.get_type_name()) + "\\fR";
  return result + "\n" + plain(option.get_description()) + "\n";
}

std::string options(CLI::App& app) {
  std::string result;
  for (const std::string& group : app.get_groups()) {
    const auto members = app.get_options([&](CLI::Option* option) { return option->get_group() == group; });
    if (members.empty()) continue;
    result += ".SS " + plain(group) + "\n";
    for (const CLI::Option* option : members) result += entry(*option);
  }
  return result;
}

std::string head(const std::string& name, const std::string& purpose, const std::string& version) {
  return fmt::format(".TH {} 1 \"\" \"ahm {}\" \"User commands\"\n.SH NAME\n{} \\- {}\n", name, version, plain(name),
                     plain(first_line(purpose)));
}

std::string page(CLI::App& app, const std::string& version) {
  return head("ahm-" + app.get_name(), app.get_description(), version) + ".SH SYNOPSIS\n\\fBahm " +
         plain(app.get_name()) + "\\fR [\\fIOPTIONS\\fR] \\fIINPUT\\fR\n.SH OPTIONS\n" + options(app) +
         ".SH DETAILS\n" + verbatim(app.get_footer()) + ".SH SEE ALSO\n\\fBahm\\fR(1)\n";
}

std::string overview(CLI::App& program, const std::string& version) {
  std::string result =
      head("ahm", program.get_description(), version) +
      ".SH SYNOPSIS\n\\fBahm\\fR \\fISUBCOMMAND\\fR [\\fIOPTIONS\\fR] \\fIINPUT\\fR\n.SH SUBCOMMANDS\n";
  for (const CLI::App* app : subcommands_of(program))
    result +=
        ".TP\n\\fBahm\\-" + plain(app->get_name()) + "\\fR(1)\n" + plain(first_line(app->get_description())) + "\n";
  return result + ".SH OPTIONS\n" + options(program) + ".SH DETAILS\n" + verbatim(program.get_footer());
}

}  // namespace

std::optional<std::string> manual(CLI::App& program, std::string_view subcommand, const std::string& version) {
  if (subcommand.empty()) return overview(program, version);
  const auto named = program.get_subcommands([&](CLI::App* app) { return app->get_name() == subcommand; });
  return named.empty() ? std::nullopt : std::optional(page(*named.front(), version));
}

}  // namespace ahm::app

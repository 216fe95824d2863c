#include "cli/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/option_tables.hpp"

namespace ahm::app {
namespace {

/// Text that roff prints as it is: no escapes, no requests, hyphens that can be copied.
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

/// Lines that stay as they are.
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

#include <nlohmann/json.hpp>

#include "cli/console.hpp"
#include "cli/option_adders.hpp"
#include "commands/subcommand.hpp"
#include "input/open.hpp"
#include "output/output_paths.hpp"
#include "output/summary.hpp"
#include "output/survey_report.hpp"

namespace ahm::app {
namespace {

struct InfoOptions {
  InputOptions input;
  OutputOptions output;
};

void run(const InfoOptions& options) {
  const std::string &path = options.input.path, &json = options.output.json;
  check_outputs({path}, {{"--json", json}}, false);
  Survey result;
  {
    ProgressDisplay display;
    display.update("read", 0);
    const io::Geometry input = read_input(options.input);
    result = survey(input, options.input, display.progress());
  }
  write_json(json, as_json(result, path));
  if (json != "-") print(as_text(result, path));
}

void offer(CLI::App& app, InfoOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "--json", o.output.json, non_empty, "FILE|-",
             "Write the report as JSON to FILE, or to standard output (-)");
  add_parsed(app, "--k", o.input.k, integer_parser(3), "N",
             "Neighbors per point in the search for components (default 30)");
  add_threads(app, o.input);
}

}  // namespace

Subcommand add_info(CLI::App& program) {
  return subcommand<InfoOptions>(program, "info", "Contents and problems of a file, and the command to run next",
                                 "Example:\n  ahm info scan.pcd", offer, run);
}

}  // namespace ahm::app

// ahm-bench list | run NAME...|all -o DIR [--toy] [--meshes FOLDER] [--vertices N...] | report -o DIR | kernels [...]
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>

#include "ahm/error.hpp"
#include "experiments/report.hpp"
#include "experiments/run_record.hpp"
#include "kernels/kernels.hpp"

namespace {

using namespace ahm::bench;

void list() {
  for (const Experiment& e : experiments()) fmt::print("{:<14} {:<12} {}\n", e.name, e.figure, e.title);
}

std::vector<const Experiment*> find_experiments(const std::vector<std::string>& names) {
  std::vector<const Experiment*> result;
  for (const std::string& name : names) {
    const auto before = result.size();
    for (const Experiment& e : experiments())
      if (name == "all" || name == e.name) result.push_back(&e);
    if (result.size() == before)
      throw ahm::InvalidArgument(fmt::format("run: no experiment '{}'; `ahm-bench list` lists them", name));
  }
  return result;
}

/// Runs experiments. One that fails does not stop the others.
int run(const std::vector<std::string>& names, const std::string& folder, const Settings& settings) {
  RunRecord record(folder);
  int failed = 0;
  for (const Experiment* e : find_experiments(names)) try {
      fmt::print("{:<14} ", e->name);
      std::fflush(stdout);
      record.run(*e, settings);
      const auto& entry = *record.find(e->name);
      fmt::print("{:7.1f} s {:6.0f} MB   {}\n", entry["seconds"].get<double>(), entry["peak_megabytes"].get<double>(),
                 entry["seen"].get<std::string>());
    } catch (const std::exception& error) {
      fmt::print("failed: {}\n", error.what());
      ++failed;
    }
  return failed > 0;
}

/// CHOLMOD, which other methods use, calls OpenMP. GNU's OpenMP hangs in processes that are forked after its threads have started, as for
/// measurements of memory. It reads its limit before `main`, so the program starts again with one thread.
void limit_openmp(char** argv) {
  if (std::getenv("OMP_THREAD_LIMIT") != nullptr) return;
  setenv("OMP_THREAD_LIMIT", "1", 1);
  execv("/proc/self/exe", argv);  // returns only if there is no /proc
}

}  // namespace

int main(int argc, char** argv) try {
  limit_openmp(argv);
  CLI::App app("The experiments of Soliman & Sharp 2025, \"The Affine Heat Method\", repeated; scaling; kernels");
  app.require_subcommand(1);
  std::vector<std::string> names;
  std::string folder;
  Settings settings;
  auto* list_command = app.add_subcommand("list", "lists the experiments");
  auto* run_command = app.add_subcommand("run", "runs experiments and writes DIR/NAME.csv and DIR/run.json");
  run_command->add_option("names", names, "names, or all")->required();
  run_command->add_option("-o,--output", folder, "folder of the tables")->required();
  run_command->add_flag("--toy", settings.toy, "small sizes that take seconds");
  run_command->add_option("--meshes", settings.meshes, "folder of additional triangle meshes")
      ->check(CLI::ExistingDirectory);
  run_command->add_option("--vertices", settings.vertices, "sizes for the scaling experiments");
  run_command->add_option("--threads", settings.threads, "number of threads; 0: one per core");
  auto* report_command = app.add_subcommand("report", "draws the results in DIR: DIR/NAME.svg and DIR/index.html");
  report_command->add_option("-o,--output", folder, "folder of the tables")->required();
  auto* kernels_command = app.add_subcommand("kernels", "measures the kernels; takes the options of Google Benchmark");
  kernels_command->prefix_command();
  CLI11_PARSE(app, argc, argv);
  if (*list_command) list();
  if (*run_command) return run(names, folder, settings);
  if (*kernels_command) return run_kernels(kernels_command->remaining());
  if (*report_command) {
    const Report report = write_report(folder);
    fmt::print("wrote {}\n", report.page.string());
    if (!report.problem.empty()) throw ahm::IoError(report.problem);
  }
  return 0;
} catch (const std::exception& e) {
  fmt::print(stderr, "ahm-bench: error: {}\n", e.what());
  return 1;
}

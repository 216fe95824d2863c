#include "experiments/run_record.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <Eigen/Core>
#include <fstream>
#include <thread>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/error.hpp"
#include "measure.hpp"

namespace ahm::bench {
namespace {

/// The text after the colon on the first line of a /proc file that begins with `key`; empty where there is none.
std::string proc_entry(const char* file, std::string_view key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key) && line.find(':') != std::string::npos) {
      const std::size_t begin = line.find_first_not_of(" \t", line.find(':') + 1);
      return begin == std::string::npos ? "" : line.substr(begin);
    }
  return "";
}

/// Returns freed memory to the system and resets the peak memory on Linux. Elsewhere the peak is that of the whole process.
void reset_peak() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  std::ofstream("/proc/self/clear_refs") << 5;
}

/// Peak memory since `reset_peak`, MB.
double peak_since_megabytes() {
  const std::string peak = proc_entry("/proc/self/status", "VmHWM");
  return peak.empty() ? peak_megabytes() : std::stod(peak) * 1.024e-3;
}

nlohmann::ordered_json machine() {
  return {{"cpu", proc_entry("/proc/cpuinfo", "model name")},
          {"cores", std::thread::hardware_concurrency()},
          {"memory", proc_entry("/proc/meminfo", "MemTotal")},
          {"compiler", __VERSION__},
          {"ahm", AHM_VERSION},
          {"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"registers", register_set()}};
}

}  // namespace

RunRecord::RunRecord(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw IoError(folder_.string() + ": " + error.message() + "; choose a folder that can be created (-o)");
  read();
}

void RunRecord::read() {
  const auto path = folder_ / "run.json";
  if (!std::filesystem::exists(path)) return;
  std::ifstream file(path);
  json_ = nlohmann::ordered_json::parse(file, nullptr, false);
  if (json_.is_discarded()) throw IoError(path.string() + ": is not JSON; delete it and run the experiments again");
}

void RunRecord::run(const Experiment& experiment, const Settings& settings) {
  reset_peak();
  Table table({});
  const double time = seconds([&] { table = experiment.run(settings); });
  nlohmann::ordered_json entry{{"figure", experiment.figure},
                               {"title", experiment.title},
                               {"paper", experiment.paper},
                               {"seen", table.seen},
                               {"seconds", time},
                               {"peak_megabytes", peak_since_megabytes()},
                               {"toy", settings.toy},
                               {"meshes", settings.meshes.string()},
                               {"finished", fmt::format("{:%F %T}", fmt::gmtime(std::time(nullptr)))},
                               {"machine", machine()}};
  table.write(folder_ / (std::string(experiment.name) + ".csv"));
  read();  // another process may have written to it in the meantime
  json_[std::string(experiment.name)] = std::move(entry);
  std::ofstream file(folder_ / "run.json");
  file << json_.dump(2) << '\n';
  if (!file.flush()) throw IoError((folder_ / "run.json").string() + ": cannot be written");
}

const nlohmann::ordered_json* RunRecord::find(std::string_view name) const {
  const auto found = json_.find(std::string(name));
  return found == json_.end() ? nullptr : &*found;
}

}  // namespace ahm::bench

#include "cli/system_info.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "ahm/cholesky/cholesky.hpp"

namespace ahm::app {

std::int64_t peak_rss_bytes() {
  // Not from getrusage: its value includes the peak of the program that started this one.
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (std::int64_t kibibytes = 0; word == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;  // in kibibytes on Linux
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * time.tv_usec; };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

nlohmann::ordered_json versions() {
  nlohmann::ordered_json result;
  result["ahm"] = AHM_VERSION;
  result["registers"] = register_set();
  result["eigen"] = fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
#ifdef AHM_WITH_PCL
  result["pcl"] = AHM_PCL_VERSION;  // compiled in; the library is loaded when needed
#endif
  result["cli11"] = CLI11_VERSION;
  result["fmt"] = fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100);
  result["nlohmann_json"] =
      fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
  return result;
}

std::string versions_as_text() {
  const nlohmann::ordered_json v = versions();
  const auto text = [&](const char* key) { return v.at(key).get<std::string>(); };
  std::string result = fmt::format("ahm {}\nregisters {}\nEigen {}\n", text("ahm"), text("registers"), text("eigen"));
  if (v.contains("pcl")) result += fmt::format("PCL {}\n", text("pcl"));
  return result;
}

}  // namespace ahm::app

#include "map_summary.hpp"

#include <fstream>

#include "ahm/distributed/array_file.hpp"
#include "ahm/io/atomic_file.hpp"

namespace ahm::distributed {
namespace {

std::filesystem::path summary_file(const std::filesystem::path& folder) { return folder / "map.json"; }

}  // namespace

nlohmann::json read_finished(const std::filesystem::path& folder) {
  std::ifstream file(summary_file(folder));
  return nlohmann::json::parse(file, nullptr, false);
}

bool is_finished(const std::filesystem::path& folder, std::uint64_t identity) {
  const nlohmann::json whole = read_finished(folder);
  return whole.is_object() && whole.value("version", 0u) == format_version &&
         whole.value("identity", std::uint64_t{0}) == identity;
}

void write_finished(const std::filesystem::path& folder, const nlohmann::json& summary) {
  nlohmann::json whole{{"version", format_version}};
  whole.update(summary);
  io::AtomicFile file(summary_file(folder));
  file.write(whole.dump(1) + "\n");
  file.commit();
}

}  // namespace ahm::distributed

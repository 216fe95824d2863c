#include "exported.hpp"

#include <fstream>
#include <iterator>

#include "ahm/error.hpp"
#include "ahm/io/temporary_folder.hpp"

namespace ahm::viewer {

std::string exported(const std::string& format, const std::function<void(const std::filesystem::path&)>& write) {
  const io::TemporaryFolder folder("ahm-view-");
  const std::filesystem::path file = folder.directory() / ("map." + format);
  write(file);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream || bytes.empty()) throw IoError("cannot read the export again");
  return bytes;
}

}  // namespace ahm::viewer

#include "exported.hpp"

#include <stdlib.h>

#include <fstream>
#include <iterator>

#include "ahm/error.hpp"

namespace ahm::viewer {
namespace {

/// A directory that only this user can read, gone at the end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "ahm-view-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw IoError("cannot make a directory for the export in " + name);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

std::string exported(const std::string& format, const std::function<void(const std::filesystem::path&)>& write) {
  const Folder folder;
  const std::filesystem::path file = folder.path() / ("map." + format);
  write(file);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream || bytes.empty()) throw IoError("cannot read the export again");
  return bytes;
}

}  // namespace ahm::viewer

/// \file
/// A directory of its own, for as long as an object lives.
#pragma once

#include <stdlib.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include "ahm/error.hpp"

namespace ahm::io {

/// Made with a name nobody has, for this user alone; removed with all it holds.
class TemporaryFolder {
 public:
  /// @param prefix  of the name. @throws IoError
  explicit TemporaryFolder(const std::string& prefix) {
    const std::filesystem::path place = std::filesystem::temp_directory_path();
    std::string name = (place / (prefix + "XXXXXX")).string();
    if (::mkdtemp(name.data()) == nullptr)
      throw IoError("cannot make a folder in '" + place.string() + "': " + std::generic_category().message(errno));
    directory_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& directory() const { return directory_; }

 private:
  std::filesystem::path directory_;
};

}  // namespace ahm::io

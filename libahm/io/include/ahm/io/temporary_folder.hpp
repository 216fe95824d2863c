/// \file
/// A temporary directory that is removed with its object.
#pragma once

#include <stdlib.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include "ahm/error.hpp"

namespace ahm::io {

/// Creates a directory with a unique name that only this user can access. The destructor removes it with its contents.
class TemporaryFolder {
 public:
  /// @param prefix  prefix of the directory's name
  /// @throws IoError
  explicit TemporaryFolder(const std::string& prefix) {
    const std::filesystem::path place = std::filesystem::temp_directory_path();
    std::string name = (place / (prefix + "XXXXXX")).string();
    if (::mkdtemp(name.data()) == nullptr)
      throw IoError("cannot create a folder in '" + place.string() + "': " + std::generic_category().message(errno));
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

/// \file
/// The supported file extensions, for help texts and file dialogs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ahm::io {

/// An operation on a file.
enum class Use {
  read,            ///< `read`
  write,           ///< `write`: rows
  write_textured,  ///< `write_textured`: meshes with textures
};

/// Extensions in lower case, with the dot, in the order in which they are shown to users.
std::vector<std::string> extensions(Use use);
/// The extension of a file name in lower case, with the dot; empty if there is none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace ahm::io

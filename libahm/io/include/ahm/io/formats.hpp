/// \file
/// Which kinds of files there are, for help texts and file dialogs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ahm::io {

/// What one does with a file.
enum class Use {
  read,            ///< `read`
  write,           ///< `write`: rows
  write_textured,  ///< `write_textured`: meshes with textures
};

/// Extensions in lower case, with their dot, in the order in which people should see them.
std::vector<std::string> extensions(Use use);
/// The extension of a name in lower case with its dot, as they have it; empty: none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace ahm::io

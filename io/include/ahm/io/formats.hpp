/// \file
/// Which kinds of files there are, for help texts and file dialogs.
#pragma once

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

}  // namespace ahm::io

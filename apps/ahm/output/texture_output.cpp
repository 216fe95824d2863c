#include "output/texture_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "output/output_paths.hpp"

namespace ahm::app {

void check_texture_output(const RunOptions& options, const std::vector<std::string>& extensions,
                          const std::vector<std::string>& parts, const std::string& image) {
  const std::string extension = extension_of(options.output);
  if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
    throw InvalidArgument(
        fmt::format("--output {}: the name must end in {}", options.output, fmt::join(extensions, ", ")));
  if (!options.view.empty() && extension_of(options.view) != ".png")
    throw InvalidArgument(fmt::format("--view {}: pictures of textures are .png files", options.view));
  if (!io::has_images())
    throw InvalidArgument("this build of ahm has no textures; build it with stb (Debian: libstb-dev)");
  std::vector<OutputPath> outputs{{"--output", options.output}, {"--json", options.json}, {"--view", options.view}};
  if (extension == ".obj") {
    std::filesystem::path stem = options.output;
    stem.replace_extension();
    outputs.push_back({"--output", stem.string() + ".mtl"});
    for (const std::string& part : parts) outputs.push_back({"--output", stem.string() + "_" + part + ".png"});
  }
  check_outputs(options.input, outputs);
  if (!image.empty()) check_outputs(image, outputs);
}

}  // namespace ahm::app

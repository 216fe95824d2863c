#include "output/texture_output.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "ahm/io/formats.hpp"
#include "output/output_paths.hpp"

namespace ahm::app {

void check_texture_output(const std::string& input, const OutputOptions& output,
                          const std::vector<std::string>& extensions, const std::vector<std::string>& parts,
                          const std::string& image) {
  check_ending({"--output", output.output}, extensions);
  if (!output.view.empty() && io::lower_extension(output.view) != ".png")
    throw InvalidArgument(fmt::format("--view {}: pictures of textures are .png files", output.view));
  if (!io::has_images())
    throw InvalidArgument("this build of ahm has no textures; build it with stb (Debian: libstb-dev)");
  std::vector<OutputPath> outputs{{"--output", output.output}, {"--json", output.json}, {"--view", output.view}};
  if (io::lower_extension(output.output) == ".obj") {
    std::filesystem::path stem = output.output;
    stem.replace_extension();
    outputs.push_back({"--output", stem.string() + ".mtl"});
    for (const std::string& part : parts) outputs.push_back({"--output", stem.string() + "_" + part + ".png"});
  }
  check_outputs({input, image}, outputs, output.keep_existing);
}

}  // namespace ahm::app

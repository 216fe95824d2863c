#include "output/tool_paths.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/io/write.hpp"

namespace ahm::app {
namespace {

const std::vector<std::string> motions{"pass", "link", "approach", "retreat", "missing"};

void write_text(const std::string& path, const std::string& text) {
  io::AtomicFile file(path);
  file.write(text);
  file.commit();
}

/// One row per pose, and an edge between consecutive poses, except where a link is missing.
void write_table(const std::string& file, const std::string& format, const PathFileOptions& options,
                 const ToolPathOptions& path_options, const ToolPath& path) {
  std::vector<Index> pass;
  std::vector<std::uint8_t> kind;
  std::vector<Vec3> position, contact, normal, heading;
  std::vector<double> q[4], arclength, time;
  io::Table table{.title = "tool path by libahm", .text = true};
  for (const ToolPose& pose : path.poses) {
    const auto row = static_cast<Index>(pass.size());
    if (row > 0 && pose.kind != ToolMotion::missing) table.edges.push_back({row - 1, row});
    pass.push_back(pose.pass), kind.push_back(static_cast<std::uint8_t>(pose.kind));
    position.push_back(pose.position), normal.push_back(pose.axis), heading.push_back(pose.travel);
    contact.push_back(pose.contact);
    for (std::size_t c = 0; c < 4; ++c) q[c].push_back(pose.quaternion[c]);
    arclength.push_back(pose.arclength);
    if (options.feed > 0) time.push_back(60 * pose.arclength / options.feed);
  }
  table.add("pass", pass);
  table.columns.push_back({{"kind"}, io::CodedWords{kind, motions}});
  table.add({"x", "y", "z"}, position);
  table.add({"nx", "ny", "nz"}, normal);
  table.add({"hx", "hy", "hz"}, heading);
  for (std::size_t c = 0; c < 4; ++c) table.add(std::string("q") + "wxyz"[c], q[c]);
  table.add("arclength", arclength);
  if (path_options.offset > 0) table.add({"cx", "cy", "cz"}, contact);
  if (!time.empty()) table.add("time", time);
  io::write(file, table, format);
}

/// One line per pass and per link, in groups by the kind of motion.
void write_lines(const std::string& file, const ToolPath& path) {
  std::vector<Vec3> points;
  std::vector<Index> begin;
  std::vector<std::string> groups;
  for (const ToolRun& run : tool_runs(path)) {
    if (run.end - run.from < 2) continue;
    begin.push_back(static_cast<Index>(points.size()));
    groups.push_back(motions[static_cast<std::size_t>(run.kind)]);
    for (std::size_t k = run.from; k < run.end; ++k) points.push_back(path.poses[k].position);
  }
  io::write_obj_lines(file, points, begin, groups);
}

/// One object per run of motions of one kind.
void write_json(const std::string& file, const PathFileOptions& options, const ToolPath& path) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  for (const ToolRun& run : tool_runs(path)) {
    nlohmann::ordered_json j{
        {"pass", run.pass}, {"kind", motions[static_cast<std::size_t>(run.kind)]}, {"lifted", run.lifted}};
    for (std::size_t k = run.from; k < run.end; ++k) {
      const ToolPose& pose = path.poses[k];
      j["position"].push_back(pose.position);
      j["axis"].push_back(pose.axis);
      j["travel"].push_back(pose.travel);
      j["quaternion"].push_back(pose.quaternion);
      j["matrix"].push_back(pose_matrix(pose));
      j["arclength"].push_back(pose.arclength);
      if (options.feed > 0) j["time"].push_back(60 * pose.arclength / options.feed);
    }
    runs.push_back(std::move(j));
  }
  write_text(file, nlohmann::ordered_json{{"spacing", path.spacing}, {"runs", std::move(runs)}}.dump() + "\n");
}

}  // namespace

std::vector<std::string> path_endings() { return {".csv", ".jsonl", ".ply", ".vtp", ".obj", ".json", ".ngc", ".yaml"}; }

void write_tool_path(const std::string& file, const std::string& format, const PathFileOptions& options,
                     const ToolPathOptions& path_options, const ToolPath& path) {
  const std::string extension = format.empty() ? io::lower_extension(file) : format;
  if (extension == ".obj") return write_lines(file, path);
  if (extension == ".json") return write_json(file, options, path);
  if (extension == ".ngc") {
    GcodeOptions gcode_options = options.gcode;
    gcode_options.feed = options.feed;
    return write_text(file, gcode(path, gcode_options));
  }
  if (extension == ".yaml") {
    RosOptions ros = options.ros;
    ros.feed = options.feed;
    return write_text(file, ros_yaml(path, ros));
  }
  write_table(file, format, options, path_options, path);
}

}  // namespace ahm::app

#include "output/warning_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

namespace ahm::app {
namespace {

/// The text of a warning. {0}, {1} and {2} are its numbers, {3} the list of its rows, {4} its name. [one|several] becomes the first
/// form if the number before it is 1.
struct Sentence {
  std::string_view id, format;
};

constexpr Sentence sentences[] = {
    // files
    {"data_after_faces", "the file continues after the last face; the rest is ignored"},
    {"data_after_elements", "the file continues after the last element; the rest is ignored"},
    {"element_ignored", "element '{4}' is ignored"},
    {"list_ignored", "list '{4}' of the vertices is ignored"},
    {"bytes_ignored", "{0:.0f} [byte|bytes] per point without a description [is|are] ignored"},
    {"lines_skipped",
     "{0:.0f} [line is|lines are] not understood and [was|were] skipped; the first is line {1:.0f}: {4}"},
    {"no_end", "the file ends without '{4}'; it may be cut short"},
    {"colors_unknown", "colors are ignored: they are neither numbers from 0 to 1 nor whole numbers from 0 to 255"},
    {"colors_not_packed", "colors are ignored: they are not packed into four bytes"},
    {"normals_not_by_vertex", "normals are ignored: their indices differ from those of the vertices"},
    {"vertex_extras", "numbers after x, y, z of a vertex are ignored"},
    {"columns_as_colors", "columns {0:.0f} to {1:.0f} contain whole numbers from 0 to 255 and are read as colors"},
    {"lines_ignored", "{0:.0f} [set|sets] of lines [is|are] ignored"},
    {"column_ignored", "column '{4}' is ignored: it contains text that is not a number"},
    {"columns_unnamed",
     "columns without names, from {0:.0f} to {1:.0f}: those of numbers are kept as column_{0:.0f} to column_{1:.0f}"},
    // meshes
    {"welded", "{0:.0f} [vertex was|vertices were] joined to another vertex within the distance of --weld"},
    {"repeated_corners", "repeated corners were removed from {0:.0f} [face|faces]"},
    {"degenerate_dropped",
     "{0:.0f} [face|faces] with fewer than three vertices or a repeated vertex [was|were] dropped"},
    {"not_finite_dropped", "{0:.0f} [face|faces] with a vertex that is not finite [was|were] dropped"},
    {"duplicates_dropped", "{0:.0f} duplicate [face was|faces were] dropped"},
    {"faces_reversed", "{0:.0f} [face was|faces were] reversed so that neighbors agree and closed parts face outward"},
    {"unreferenced", "{0:.0f} [vertex|vertices] that no face uses [was|were] left out"},
    {"reoriented", "{0:.0f} [face was|faces were] reversed to orient the mesh consistently"},
    {"non_manifold_edges", "{0:.0f} [edge|edges] with more than two faces [was|were] cut"},
    {"non_manifold_vertices",
     "{0:.0f} [vertex|vertices] with several fans of faces [was|were] split, which added {1:.0f} [vertex|vertices]"},
    {"not_orientable", "the mesh is not orientable; it is solved with reflections"},
    {"components", "the mesh has {0:.0f} components; a map covers only the component of its source"},
    {"flips_stopped", "edge flips stopped before all edges were Delaunay"},
    {"merged",
     "{0:.0f} [vertex coincides with a neighbor and was|vertices coincide with a neighbor and were] merged with it; "
     "{1:.0f} [face|faces] without area [was|were] left out"},
    {"mollified", "{0:.0f} degenerate [face|faces]: all edges were lengthened by {1:.6g}"},
    {"edge_lengths", "edge lengths range from {0:.6g} to {1:.6g}; a single diffusion time does not suit all of them"},
    {"collinear_faces",
     "{0:.0f} [face is|faces are] collinear: all [its|their] corners lie on one line; the first is face {1:.0f}"},
    {"negative_weights",
     "{0:.0f} [edge has a negative weight|edges have negative weights]; far from the source heat may become negative"},
    {"twisted_faces",
     "{0:.0f} [face is|faces are] twisted (the first is face {1:.0f}), so the polygons are not refined"},
    // clouds
    {"faces_ignored", "{0:.0f} [face is|faces are] ignored: the vertices are mapped as a point cloud"},
    {"non_finite_dropped", "{0:.0f} [point|points] with NaN or infinite coordinates [was|were] dropped"},
    {"normals_estimated", "{0:.0f} input [normal is|normals are] zero or not finite and [was|were] estimated instead"},
    {"cover_not_delaunay",
     "the intrinsic Delaunay flips did not finish: some edges of degenerate triangles were left out"},
    {"degenerate",
     "{0:.0f} [point has a collinear or isolated neighborhood and was|points have collinear or isolated "
     "neighborhoods and were] removed: {3}"},
    {"normals_contradicted",
     "{0:.0f} input [normal disagrees|normals disagree] with the points; planes were estimated from the points, and "
     "the "
     "normals were used only for their sides"},
    {"normals_flipped", "{0:.0f} input [normal was|normals were] flipped to agree with the majority of normals around"},
    {"k_reduced", "k = {0:.0f} was reduced to {1:.0f}: the cloud has only {2:.0f} distinct [point|points]"},
    {"smoothed",
     "{0:.0f} [point was|points were] smoothed before the map (noise across the largest part of the surface: {1:.4g}); "
     "--smooth off prevents this"},
    {"near_duplicates",
     "{0:.0f} [point was|points were] merged with another point that is much closer than the spacing"},
    {"coarse_coordinates",
     "the coordinates have single precision: so far from the origin the resolution of {4} is {0:.3g}, and the mean "
     "edge length is {1:.3g}; export them in double precision, or shift them to the origin first"},
    {"layers",
     "the points lie in layers {0:.3g} apart, which is less than the spacing, and are mapped as one surface; this is "
     "correct for several scans of the same side; the two sides of a thin wall require oriented normals in the input"},
    {"no_surface",
     "points in a thick layer: {0:.0f} of {1:.0f}; the points do not form a surface there, and distances are not "
     "reliable"},
    {"non_finite", "{0:.0f} [point|points] with NaN or infinite coordinates [was|were] removed"},
    {"duplicates", "{0:.0f} duplicate [point was|points were] merged"},
    {"thin_walls",
     "{0:.0f} [pair|pairs] of neighbors [was|were] not joined because their normals disagree (thin walls)"},
    {"lines",
     "{0:.0f} [point lies|points lie] on scan lines that are too far apart to be joined: the points do not form a "
     "surface "
     "there, and distances cross holes in a straight line; thin the points along the lines with --voxel"},
    {"reflections",
     "{0:.0f} [edge joins|edges join] points with opposite normals and [is a reflection|are reflections]; sheets less "
     "than six spacings apart may be connected there"},
    {"cloud_components", "the cloud has {0:.0f} components; a map covers only the component of its source"},
};

/// A sentence in which [one|several] is replaced by the form for the number.
std::string numbered(std::string_view sentence, const std::array<double, 3>& numbers) {
  std::string text;
  bool is_one = false;
  for (std::size_t at = 0; at < sentence.size();) {
    if (sentence[at] != '[') {
      if (sentence[at] == '{' && sentence[at + 1] < '3') is_one = numbers[sentence[at + 1] - '0'] == 1;
      text += sentence[at++];
      continue;
    }
    const std::size_t bar = sentence.find('|', at), end = sentence.find(']', bar);
    text += is_one ? sentence.substr(at + 1, bar - at - 1) : sentence.substr(bar + 1, end - bar - 1);
    at = end + 1;
  }
  return text;
}

/// A number formatted as by printf, with a decimal point in any locale. @param format  `.0f` or `.6g`
std::string decimals(double value, std::string_view format) {
  char text[400];  // enough for 1e308
  const auto how = format.back() == 'f' ? std::chars_format::fixed : std::chars_format::general;
  const auto [end, error] = std::to_chars(text, text + sizeof text, value, how, format[1] - '0');
  return error == std::errc{} ? std::string(text, end) : std::string();
}

std::string list(const Warning& warning) {
  std::string text;
  for (Row row : warning.rows) text += (text.empty() ? "" : ", ") + std::to_string(row.index);
  const auto all = static_cast<std::size_t>(warning.numbers.empty() ? 0 : warning.numbers[0]);
  return all > warning.rows.size() ? text + " and " + std::to_string(all - warning.rows.size()) + " more" : text;
}

/// A sentence in which braces are replaced by the values of the warning.
std::string with_values(std::string_view sentence, const Warning& warning, const std::array<double, 3>& numbers) {
  std::string text;
  for (std::size_t at = 0; at < sentence.size();) {
    if (sentence[at] != '{') {
      text += sentence[at++];
      continue;
    }
    const std::size_t end = sentence.find('}', at);
    const std::string_view place = sentence.substr(at + 1, end - at - 1);
    text += place == "3"   ? list(warning)
            : place == "4" ? warning.name
                           : decimals(numbers[place[0] - '0'], place.substr(2));
    at = end + 1;
  }
  return text;
}

}  // namespace

std::string worded(const Warning& warning) {
  std::array<double, 3> numbers{};
  std::copy_n(warning.numbers.begin(), std::min<std::size_t>(warning.numbers.size(), 3), numbers.begin());
  for (const auto& [id, format] : sentences)
    if (warning.id == id) return with_values(numbered(format, numbers), warning, numbers);
  std::string text(warning.id);
  for (double x : warning.numbers) text += " " + decimals(x, ".6g");
  return text;
}

}  // namespace ahm::app

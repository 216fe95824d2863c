#include "output/warning_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

namespace ahm::app {
namespace {

/// {0}, {1}, {2} are the warning's numbers, {3} is the list of its rows, {4} its name. Of [one|several] the first stands where the
/// number before it is 1.
struct Sentence {
  std::string_view id, format;
};

constexpr Sentence sentences[] = {
    // files
    {"goes_on_after_faces", "the file goes on behind the last face; the rest is ignored"},
    {"goes_on_after_elements", "the file goes on behind the last element; the rest is ignored"},
    {"element_ignored", "element '{4}' is ignored"},
    {"header_lines_ignored",
     "{0:.0f} [line|lines] of the header [says|say] nothing a PLY file knows and [is|are] ignored"},
    {"statements_ignored", "{0:.0f} [statement|statements] of no known kind [is|are] ignored: {4}"},
    {"colors_unknown", "colors are ignored: they are neither fractions of 1 nor whole numbers up to 255"},
    {"colors_not_packed", "colors are ignored: they are not packed into four bytes"},
    {"normals_not_by_vertex", "normals are ignored: they are not numbered like the vertices"},
    {"vertex_extras", "numbers behind x, y, z of a vertex are ignored"},
    {"columns_as_colors", "columns {0:.0f} to {1:.0f} are taken as colors: whole numbers from 0 to 255"},
    {"lines_ignored", "{0:.0f} [set|sets] of lines [is|are] ignored"},
    {"column_ignored", "column '{4}' is ignored: it holds what is no number"},
    {"columns_ignored", "columns 4 to {0:.0f} are ignored"},
    // meshes
    {"welded", "{0:.0f} [vertex was|vertices were] joined to another one, at the same place or as near as --weld says"},
    {"faces_shortened", "{0:.0f} [face|faces] lost corners at the same vertex"},
    {"degenerate_dropped",
     "{0:.0f} [face was|faces were] dropped that had fewer than three vertices or one of them twice"},
    {"not_finite_dropped", "{0:.0f} [face was|faces were] dropped that had a vertex which is not finite"},
    {"duplicates_dropped", "{0:.0f} [face was|faces were] dropped that [was|were] given before"},
    {"faces_turned",
     "{0:.0f} [face was|faces were] turned over, so that neighbours agree and closed parts look outwards"},
    {"unreferenced", "{0:.0f} [vertex|vertices] that no face uses [was|were] left out"},
    {"reoriented", "{0:.0f} [face was|faces were] turned over to orient the mesh consistently"},
    {"non_manifold_edges", "{0:.0f} [edge|edges] with more than two faces [was|were] cut"},
    {"non_manifold_vertices",
     "{0:.0f} [vertex|vertices] where several fans of faces met [was|were] split: {1:.0f} [vertex|vertices] more"},
    {"not_orientable", "the mesh is not orientable; it is solved with reflections"},
    {"components", "the mesh falls into {0:.0f} components; a map covers those that hold its source"},
    {"flips_stopped", "edge flips were stopped before all edges were Delaunay"},
    {"merged",
     "{0:.0f} [vertex coincides with a neighbour and was|vertices coincide with a neighbour and were] merged with it; "
     "{1:.0f} [face|faces] without area [was|were] left out"},
    {"mollified", "{0:.0f} degenerate [face|faces]: every edge was made longer by {1:.6g}"},
    {"edge_lengths", "edge lengths range from {0:.6g} to {1:.6g}; one diffusion time cannot suit them all"},
    {"collinear_faces",
     "{0:.0f} [face is|faces are] collinear: all [its|their] corners lie on one line; the first is face {1:.0f}"},
    {"negative_weights",
     "{0:.0f} [edge has a negative weight|edges have negative weights]; far from the source heat may lose its sign"},
    {"twisted_faces",
     "{0:.0f} [face is|faces are] twisted, the first is face {1:.0f}, so the polygons are not refined"},
    // clouds
    {"faces_ignored", "the {0:.0f} faces are ignored: the vertices are mapped as a point cloud"},
    {"non_finite_dropped", "{0:.0f} [point|points] with nan or infinite coordinates [was|were] dropped"},
    {"normals_estimated", "{0:.0f} given [normal is|normals are] zero or not finite and [was|were] estimated"},
    {"cover_not_delaunay",
     "the intrinsic Delaunay flips did not come to an end: some edges of degenerate triangles were left out"},
    {"degenerate",
     "{0:.0f} [point has a collinear or isolated neighbourhood and was|points have collinear or isolated "
     "neighbourhoods and were] removed: {3}"},
    {"normals_contradicted",
     "{0:.0f} given [normal disagrees|normals disagree] with the points; planes were taken from the points, only sides "
     "from the normals"},
    {"normals_turned",
     "{0:.0f} given [normal points|normals point] to the other side than the majority around and [was|were] turned"},
    {"k_reduced", "k = {0:.0f} was reduced to {1:.0f}: the cloud has only {2:.0f} distinct [point|points]"},
    {"smoothed",
     "noise of {1:.4g} across the surface: {0:.0f} [point was|points were] smoothed for the map (--smooth off: as "
     "given)"},
    {"near_duplicates", "{0:.0f} [point was|points were] merged with one much nearer than the spacing"},
    {"coarse_coordinates",
     "the coordinates have single precision, whose steps are {0:.3g} this far from the origin, where the mean edge "
     "length "
     "is {1:.3g}: export them in double precision, or shift the origin before"},
    {"layers",
     "the points lie in layers {0:.3g} apart, nearer than neighbours, and are mapped as one surface: right for scans "
     "of the "
     "same side, wrong for the two sides of a thin wall, which only given normals tell apart"},
    {"no_surface",
     "{0:.0f} of {1:.0f} points lie in a thick layer: the points do not form a surface there, and distances are not "
     "reliable"},
    {"non_finite", "{0:.0f} [point|points] with NaN or infinite coordinates [was|were] removed"},
    {"duplicates", "{0:.0f} duplicate [point was|points were] merged"},
    {"thin_walls",
     "{0:.0f} [pair|pairs] of neighbours [was|were] not joined because their normals disagree (thin walls)"},
    {"lines",
     "{0:.0f} points lie along lines, as of a scanner, that are too far apart to be joined: no surface, and distances "
     "go straight across what a line surrounds; thin them along the lines (--voxel)"},
    {"reflections",
     "{0:.0f} [edge joins|edges join] oppositely oriented normals and [is treated as a reflection|are treated as "
     "reflections]; sheets less than six spacings apart may be connected there"},
    {"cloud_components", "the cloud falls into {0:.0f} components; a map covers those that hold its source"},
};

/// A sentence with its words chosen.
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

/// As printf's, with a point whatever the locale. @param format  ".0f", ".6g"
std::string decimals(double value, std::string_view format) {
  char text[400];  // of 1e308, too
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

/// A sentence with what stands in braces.
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

// The functions of std::filesystem that Debian's libc++ for WebAssembly lacks. Paths are relative names of files in memory.
#include <filesystem>

#include "ahm/io/memory_files.hpp"

_LIBCPP_BEGIN_NAMESPACE_FILESYSTEM

using View = std::string_view;

namespace {

View name_of(View path) { return path.substr(path.rfind('/') + 1); }  // npos + 1: the whole path

/// The position of the extension's point in a file name; npos: no extension.
std::size_t point_of(View name) {
  const std::size_t at = name.rfind('.');
  return at == 0 || name == ".." ? View::npos : at;
}

}  // namespace

path::__string_view path::__root_name() const { return {}; }
path::__string_view path::__root_directory() const { return View(__pn_).substr(0, __pn_.starts_with('/') ? 1 : 0); }
path::__string_view path::__filename() const { return name_of(__pn_); }
path::__string_view path::__stem() const { return __filename().substr(0, point_of(__filename())); }
path::__string_view path::__extension() const {
  const std::size_t at = point_of(__filename());
  return at == View::npos ? View() : __filename().substr(at);
}
path::__string_view path::__parent_path() const {
  const std::size_t at = __pn_.rfind('/');
  return View(__pn_).substr(0, at == View::npos ? 0 : std::max<std::size_t>(at, 1));
}
int path::__compare(__string_view other) const { return View(__pn_).compare(other); }
path& path::replace_extension(const path& replacement) {
  __pn_.resize(__pn_.size() - __extension().size());
  return *this += replacement;
}

file_status __status(const path& p, error_code* error) {
  if (error) error->clear();
  return file_status(ahm::io::memory_files().contains(p.string()) ? file_type::regular : file_type::not_found);
}

_LIBCPP_END_NAMESPACE_FILESYSTEM

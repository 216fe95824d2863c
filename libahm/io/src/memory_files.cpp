// Files in memory, for systems without files: replaces regular_file.cpp and atomic_file.cpp with AHM_WITH_FILES=OFF. All paths are names
// of one folder.
#include "ahm/io/memory_files.hpp"

#include <limits>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "read/bytes.hpp"

namespace ahm::io {

std::map<std::string, std::string>& memory_files() {
  static std::map<std::string, std::string> files;
  return files;
}

// The limit is the address space. Allocations that fail throw std::bad_alloc, which the readers report.
std::uint64_t free_memory() { return std::numeric_limits<std::uintptr_t>::max(); }

namespace {

const std::string& contents_of(const std::filesystem::path& path) {
  const auto found = memory_files().find(path.string());
  if (found == memory_files().end()) throw IoError("cannot read " + quoted_path(path) + ": there is no such file");
  return found->second;
}

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& path) : path_(path), size_(contents_of(path).size()) {
  if (size_ == 0) throw IoError("cannot read " + quoted_path(path) + ": the file is empty (0 bytes)");
}

RegularFile RegularFile::without_name(const std::filesystem::path&) {
  throw IoError("this build of libahm has no temporary files");
}

RegularFile::~RegularFile() = default;
RegularFile::RegularFile(RegularFile&& other) noexcept = default;

std::size_t RegularFile::read(std::uint64_t position, std::span<char> room) const {
  const std::string& bytes = contents_of(path_);
  return position < bytes.size() ? bytes.copy(room.data(), room.size(), static_cast<std::size_t>(position)) : 0;
}

void RegularFile::append(std::span<const char> bytes) {
  memory_files()[path_.string()].append(bytes.data(), bytes.size());
  size_ += bytes.size();
}

std::filesystem::path without_links(std::filesystem::path path) { return path; }
bool is_stream(const std::filesystem::path&) { return false; }

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), target_(path) {}
AtomicFile::~AtomicFile() = default;
AtomicFile::AtomicFile(AtomicFile&& other) noexcept = default;

void AtomicFile::write(std::string_view bytes) { buffer_.append(bytes); }
void AtomicFile::finish() {}
void AtomicFile::commit() {
  if (FileSet::innermost != nullptr)
    FileSet::innermost->files_.push_back(std::move(*this));
  else
    name();
}
void AtomicFile::name() { memory_files()[target_.string()] = std::move(buffer_); }

std::string written_bytes(const std::string& name, const std::function<void(const std::filesystem::path&)>& write) {
  write(name);
  auto file = memory_files().extract(name);
  if (file.empty()) throw IoError("cannot write '" + name + "'");
  return std::move(file.mapped());
}

void remove_unfinished_files() noexcept {}

}  // namespace ahm::io

// Replaces npz.cpp in builds without minizip.
#include "ahm/io/npz.hpp"

namespace ahm::io {

struct NpzFile::Impl {};

bool has_npz() noexcept { return false; }
NpzFile::NpzFile(const std::filesystem::path& path) {
  throw IoError(path.string() + ": this build has no minizip, which writes .npz files");
}
NpzFile::~NpzFile() = default;
void NpzFile::add(const std::string&, const std::vector<std::size_t>&, std::span<const double>, NpyType) {}
void NpzFile::add(const std::string&, const std::vector<std::size_t>&, std::span<const std::int32_t>) {}
void NpzFile::add(const std::string&, const std::vector<std::size_t>&, std::span<const std::int64_t>) {}
void NpzFile::add(const std::string&, const std::vector<std::size_t>&, std::span<const std::uint8_t>) {}
void NpzFile::commit() {}

}  // namespace ahm::io

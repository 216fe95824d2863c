#include "ahm/io/npz.hpp"

#include <minizip/zip.h>

#include <algorithm>
#include <bit>
#include <type_traits>
#include <utility>

#include "ahm/io/atomic_file.hpp"
#include "ahm/util/memory.hpp"

namespace ahm::io {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written in the byte order of the memory");

/// Header of the .npy format 1.0: magic, length of the text, and the text, padded to a multiple of 64 bytes.
std::string npy_header(const std::string& type, const std::vector<std::size_t>& shape) {
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (";
  for (std::size_t k = 0; k < shape.size(); ++k) text += (k > 0 ? ", " : "") + std::to_string(shape[k]);
  text += shape.size() == 1 ? ",), }" : "), }";
  constexpr std::size_t before = 10;
  text.append(63 - (before + text.size()) % 64, ' ');
  text += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(text.size() % 256);
  header += static_cast<char>(text.size() / 256);
  return header + text;
}

}  // namespace

bool has_npz() noexcept { return true; }

struct NpzFile::Impl {
  std::filesystem::path path;
  AtomicFile file;
  zipFile zip = nullptr;

  explicit Impl(const std::filesystem::path& target) : path(target), file(target) {
    if (file.temporary().empty())
      throw IoError(path.string() + ": not a regular file; a .npz file cannot be written to a pipe or device");
    // minizip opens the file by name because it seeks back to fill in lengths.
    zip = zipOpen64(file.temporary().c_str(), APPEND_STATUS_CREATE);
    if (zip == nullptr) throw IoError(path.string() + ": cannot be written");
  }
  ~Impl() {
    if (zip != nullptr) zipClose(zip, nullptr);
  }
  void require(int status) const {
    if (status != ZIP_OK)
      throw IoError(path.string() + ": writing failed; is the disk full? (zip status " + std::to_string(status) + ")");
  }
  void write(const void* bytes, std::size_t count) const {
    constexpr std::size_t most = std::size_t{1} << 24;  // minizip takes lengths as unsigned int
    for (std::size_t done = 0; done < count; done += most)
      require(zipWriteInFileInZip(zip, static_cast<const char*>(bytes) + done,
                                  static_cast<unsigned>(std::min(most, count - done))));
  }

  /// @param per_element  values that make up one element
  template <class Stored, class Value>
  void add(const std::string& name, const std::string& type, const std::vector<std::size_t>& shape,
           std::span<const Value> values, std::size_t per_element = 1) const {
    std::size_t expected = per_element;
    for (std::size_t extent : shape) expected *= extent;
    if (expected != values.size())
      throw InvalidArgument("array " + name + " has length " + std::to_string(values.size()) +
                            ", but its shape requires " + std::to_string(expected));
    // minizip does not check its allocations, so check beforehand that there is memory.
    detail::require_memory(std::size_t{1} << 20);
    // January 1, 1980, the earliest date of a zip archive: a fixed date makes files of equal arrays identical.
    zip_fileinfo info{};
    info.tmz_date.tm_mday = 1;
    info.tmz_date.tm_year = 1980;
    require(zipOpenNewFileInZip64(zip, (name + ".npy").c_str(), &info, nullptr, 0, nullptr, 0, nullptr, 0, 0, 1));
    const std::string header = npy_header(type, shape);
    write(header.data(), header.size());
    if constexpr (std::is_same_v<Stored, Value>) {
      write(values.data(), values.size_bytes());
    } else {
      std::vector<Stored> chunk;
      for (std::size_t begin = 0; begin < values.size(); begin += 65536) {
        const auto part = values.subspan(begin, std::min<std::size_t>(65536, values.size() - begin));
        chunk.assign(part.begin(), part.end());
        write(chunk.data(), chunk.size() * sizeof(Stored));
      }
    }
    require(zipCloseFileInZip(zip));
  }
};

NpzFile::NpzFile(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}
NpzFile::~NpzFile() = default;

void NpzFile::add(const std::string& name, const std::vector<std::size_t>& shape, std::span<const double> values,
                  NpyType type) {
  switch (type) {
    case NpyType::float64:
      return impl_->add<double>(name, "<f8", shape, values);
    case NpyType::float32:
      return impl_->add<float>(name, "<f4", shape, values);
    case NpyType::complex128:
      return impl_->add<double>(name, "<c16", shape, values, 2);
    case NpyType::complex64:
      return impl_->add<float>(name, "<c8", shape, values, 2);
  }
}

void NpzFile::add(const std::string& name, const std::vector<std::size_t>& shape,
                  std::span<const std::int32_t> values) {
  impl_->add<std::int32_t>(name, "<i4", shape, values);
}

void NpzFile::add(const std::string& name, const std::vector<std::size_t>& shape,
                  std::span<const std::int64_t> values) {
  impl_->add<std::int64_t>(name, "<i8", shape, values);
}

void NpzFile::add(const std::string& name, const std::vector<std::size_t>& shape,
                  std::span<const std::uint8_t> values) {
  impl_->add<std::uint8_t>(name, "|b1", shape, values);
}

void NpzFile::commit() {
  impl_->require(zipClose(std::exchange(impl_->zip, nullptr), nullptr));
  impl_->file.commit();
}

}  // namespace ahm::io

#include <utility>

#include "ahm/io/atomic_file.hpp"

namespace ahm::io {

thread_local FileSet* FileSet::innermost = nullptr;

FileSet::FileSet() noexcept : outer_(std::exchange(innermost, this)) {}

FileSet::~FileSet() { innermost = outer_; }

void FileSet::commit() {
  if (innermost == nullptr) return;
  for (AtomicFile& file : innermost->files_) file.name();
  innermost->files_.clear();
}

}  // namespace ahm::io

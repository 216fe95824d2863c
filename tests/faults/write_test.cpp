// Every write fails in turn, in every format: an error names the file, and the old file or none is left.
#include "ahm/io/write.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <functional>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/io/npz.hpp"
#include "ahm/io/textured_mesh.hpp"
#include "folder.hpp"
#include "support/child_process.hpp"

namespace ahm::test {
namespace {

/// A file name, and a function that writes such a file.
struct Writer {
  std::string name;
  std::function<void(const std::filesystem::path&)> write;
};

std::vector<Writer> all_writers() {
  static const Mesh mesh = icosphere(8);
  static std::vector<Offset> begin;
  static std::vector<Index> corners;
  static std::vector<double> numbers;
  if (begin.empty()) {
    begin.push_back(0);
    for (const Triangle& face : mesh.faces) {
      corners.insert(corners.end(), face.begin(), face.end());
      begin.push_back(static_cast<Offset>(corners.size()));
    }
    for (const Vec3& p : mesh.positions) numbers.push_back(p[0]);
  }
  const auto table = [](const std::filesystem::path& path) {
    io::Table rows{"points"};
    rows.add({"x", "y", "z"}, mesh.positions);
    rows.add("number", numbers);
    io::write(path, rows);
  };
  const auto textured = [](const std::filesystem::path& path) {
    const io::MeshPart part{.name = "ball", .points = mesh.positions, .faces = {begin, corners}};
    io::write_textured(path, std::span(&part, 1));
  };
  const auto npz = [](const std::filesystem::path& path) {
    io::NpzFile file(path);
    file.add("numbers", {numbers.size()}, numbers);
    file.commit();
  };
  std::vector<Writer> all{{"a.csv", table}, {"a.ply", table}, {"a.obj", textured}, {"a.glb", textured}};
  if (io::has_npz()) all.push_back({"a.npz", npz});
  return all;
}

constexpr int refused = 0, written = 3, unnamed = 4;

/// Writes the file. @return refused if the error names the file, or the file of its materials
int outcome_of(const Writer& writer, const std::filesystem::path& path) try {
  writer.write(path);
  return written;
} catch (const IoError& error) {
  return std::string(error.what()).find("/" + path.stem().string() + ".") != std::string::npos ? refused : unnamed;
}

TEST(WritesFail, WhereFilesMayNotGrow) {
  for (const Writer& writer : all_writers()) {
    const Folder folder{};
    const auto path = folder.path(writer.name);
    writer.write(path);
    const auto size = std::filesystem::file_size(path);
    ASSERT_GT(size, 4000U) << writer.name;
    folder.write(writer.name, "precious");
    const std::size_t files = folder.files();
    for (const std::uintmax_t most : {std::uintmax_t{0}, std::uintmax_t{1}, std::uintmax_t{100}, size / 2, size - 1}) {
      SCOPED_TRACE(writer.name + " of at most " + std::to_string(most) + " bytes");
      EXPECT_EQ(status_of_child([&] {
                  const rlimit limit{most, most};
                  ::setrlimit(RLIMIT_FSIZE, &limit);
                  ::signal(SIGXFSZ, SIG_IGN);
                  return outcome_of(writer, path);
                }),
                refused);
      EXPECT_EQ(folder.read(writer.name), "precious");
      EXPECT_EQ(folder.files(), files);
    }
  }
}

TEST(WritesFail, WhereTheFolderIsMissingOrTheNameIsAFolder) {
  const Folder folder{};
  for (const Writer& writer : all_writers()) {
    EXPECT_EQ(outcome_of(writer, folder.path("absent") / writer.name), refused) << writer.name;
    std::filesystem::create_directory(folder.path(writer.name));
    EXPECT_EQ(outcome_of(writer, folder.path(writer.name)), refused) << writer.name;
  }
  EXPECT_EQ(folder.files(), all_writers().size());
}

TEST(WritesFail, WhereTheFolderIsReadOnly) {
  const Folder folder{};
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const bool is_root = ::access(folder.path().c_str(), W_OK) == 0;  // root may write everywhere
  for (const Writer& writer : all_writers())
    EXPECT_EQ(outcome_of(writer, (is_root ? std::filesystem::path("/proc") : folder.path()) / writer.name), refused)
        << writer.name;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(WritesFail, WhereTheDiskIsFull) {
  for (const Writer& writer : all_writers()) {
    if (writer.name == "a.npz" || writer.name == "a.obj") continue;  // no devices; several files
    const Folder folder{};
    std::filesystem::create_symlink("/dev/full", folder.path(writer.name));
    EXPECT_EQ(outcome_of(writer, folder.path(writer.name)), refused) << writer.name;
    EXPECT_EQ(folder.files(), 1U);
  }
}

}  // namespace
}  // namespace ahm::test

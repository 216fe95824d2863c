// Every write fails in turn, of every format that is written: a named error, and the old file or none is left.
#include "ahm/io/write.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/io/npz.hpp"
#include "ahm/io/textured_mesh.hpp"
#include "folder.hpp"

namespace ahm::test {
namespace {

using Writer = std::function<void(const std::filesystem::path&)>;

struct Written {
  std::string name;
  Writer write;
};

std::vector<Written> all_writers() {
  static const Mesh mesh = icosphere(8);
  static std::vector<Offset> begin{0};
  static std::vector<Index> corners;
  static std::vector<double> numbers;
  if (corners.empty())
    for (const Triangle& face : mesh.faces) {
      corners.insert(corners.end(), face.begin(), face.end());
      begin.push_back(static_cast<Offset>(corners.size()));
    }
  if (numbers.empty())
    for (const Vec3& p : mesh.positions) numbers.push_back(p[0]);
  const Writer table = [](const std::filesystem::path& path) {
    io::Table rows{"points"};
    rows.add({"x", "y", "z"}, mesh.positions);
    rows.add("number", numbers);
    io::write(path, rows);
  };
  const Writer textured = [](const std::filesystem::path& path) {
    const io::MeshPart part{.name = "ball", .points = mesh.positions, .faces = {begin, corners}};
    io::write_textured(path, std::span(&part, 1));
  };
  std::vector<Written> all{{"a.csv", table}, {"a.ply", table}, {"a.obj", textured}, {"a.glb", textured}};
  if (io::has_npz())
    all.push_back({"a.npz", [](const std::filesystem::path& path) {
                     io::NpzFile file(path);
                     file.add("numbers", {numbers.size()}, numbers);
                     file.commit();
                   }});
  return all;
}

/// The exit status of work in a process of its own.
int status_of(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

constexpr int refused = 0, written = 3, unnamed = 4;

/// Writes; whether it was refused with words that name the file, or that of its materials.
int outcome_of(const Written& file, const std::filesystem::path& path) {
  try {
    file.write(path);
    return written;
  } catch (const IoError& error) {
    return std::string(error.what()).find("/" + path.stem().string() + ".") != std::string::npos ? refused : unnamed;
  }
}

TEST(WritesFail, WhereAFileMayGrowNoFurther) {
  for (const Written& file : all_writers()) {
    const Folder folder;
    file.write(folder.path(file.name));
    const auto size = std::filesystem::file_size(folder.path(file.name));
    ASSERT_GT(size, 4000U) << file.name;
    folder.write(file.name, "precious");
    const std::size_t files = folder.files();
    // Any number of bytes from none to all but one.
    for (const std::uintmax_t most : {std::uintmax_t{0}, std::uintmax_t{1}, std::uintmax_t{100}, size / 2, size - 1}) {
      EXPECT_EQ(status_of([&] {
                  const rlimit limit{most, most};
                  ::setrlimit(RLIMIT_FSIZE, &limit);
                  ::signal(SIGXFSZ, SIG_IGN);
                  return outcome_of(file, folder.path(file.name));
                }),
                refused)
          << file.name << " of at most " << most << " bytes";
      EXPECT_EQ(folder.read(file.name), "precious") << file.name;
      EXPECT_EQ(folder.files(), files) << file.name;
    }
  }
}

TEST(WritesFail, WhereTheFolderIsGone) {
  const Folder folder;
  for (const Written& file : all_writers())
    EXPECT_EQ(outcome_of(file, folder.path("absent") / file.name), refused) << file.name;
}

TEST(WritesFail, WhereTheNameIsTakenByAFolder) {
  const Folder folder;
  for (const Written& file : all_writers()) {
    std::filesystem::create_directory(folder.path(file.name));
    EXPECT_EQ(outcome_of(file, folder.path(file.name)), refused) << file.name;
  }
  EXPECT_EQ(folder.files(), all_writers().size());
}

TEST(WritesFail, WhereTheFolderIsReadOnly) {
  const Folder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  if (::access(folder.path().c_str(), W_OK) == 0) {  // root may write everywhere
    for (const Written& file : all_writers()) EXPECT_EQ(outcome_of(file, "/proc/" + file.name), refused) << file.name;
  } else {
    for (const Written& file : all_writers()) EXPECT_EQ(outcome_of(file, folder.path(file.name)), refused) << file.name;
  }
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(WritesFail, WhereTheDiskIsFull) {
  for (const Written& file : all_writers()) {
    if (file.name == "a.npz" || file.name == "a.obj") continue;  // no devices; several files
    const Folder folder;
    std::filesystem::create_symlink("/dev/full", folder.path(file.name));
    EXPECT_EQ(outcome_of(file, folder.path(file.name)), refused) << file.name;
    EXPECT_EQ(folder.files(), 1U);
  }
}

}  // namespace
}  // namespace ahm::test

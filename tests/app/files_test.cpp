// What a run does to files that are there: those it reads, and those it is to replace.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "program.hpp"
#include "sheet.hpp"

namespace ahm::test {
namespace {

TEST(Outputs, AreAllWrittenOrNone) {
  Folder folder;
  const auto input = folder.write("mesh.obj", sheet(8));
  const auto outcome = run({"logmap", input, "-s", "0", "-o", folder / "map.csv", "--json", "/dev/full"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(folder.files(), std::vector<std::string>{"mesh.obj"});
}

TEST(Outputs, ThatWereThereStayWhereALaterOneFails) {
  Folder folder;
  const auto input = folder.write("mesh.obj", sheet(8));
  for (const char* command : {"logmap", "cells"}) {
    const auto table = folder.write("map.csv", "old");
    EXPECT_EQ(run({command, input, command == std::string("logmap") ? "-s" : "--count", "2", "-o", table, "--json",
                   "/dev/full"})
                  .status,
              1);
    EXPECT_EQ(read_text(table), "old");
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"map.csv", "mesh.obj"}));
  }
}

// An hour's work must not depend on somebody who reads that it is done.
TEST(Outputs, AreThereThoughNobodyReadsTheSummary) {
  Folder folder;
  const auto input = folder.write("mesh.obj", sheet(8));
  Running running = start({"logmap", input, "-s", "0", "-o", folder / "map.csv"});
  ::close(running.out);
  running.out = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  finish(running);
  EXPECT_EQ(read_numbers(folder / "map.csv").size(), 64u);
}

TEST(StandardInput, ThatCannotBeReadIsNotTakenForItsEnd) {
  Folder folder;
  const Outcome outcome = finish(start({"info", "-", "--input-format", "xyz"}, false, folder.directory().string()));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("Is a directory"), std::string::npos) << outcome.err;
}

TEST(LocalMaps, KeepTheListTheyRead) {
  Folder folder;
  const auto input = folder.write("mesh.obj", sheet(8)), list = folder.write("rows.txt", "0\n5\n");
  const Outcome outcome =
      run({"local-maps", input, "--k", "4", "--sources", list, "-o", folder / "maps.npz", "--json", list});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(read_text(list), "0\n5\n");
}

TEST(OldOutput, SurvivesAFailure) {
  Folder folder;
  const auto output = folder.write("map.csv", "precious\n");
  EXPECT_EQ(run({"logmap", folder.write("bad.xyz", "0 0 0\n1 zero 0\n"), "--source", "0", "-o", output}).status, 1);
  EXPECT_EQ(read_text(output), "precious\n");
}

}  // namespace
}  // namespace ahm::test

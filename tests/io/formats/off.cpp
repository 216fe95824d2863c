#include "io/cases.hpp"

namespace ahm::io::test {

Cases off_cases() {
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n", points = "0 0 0, 1 0 0, 0 1 0, 1 1 0";
  Cases c;
  c.good("comments.off",
         "# made by hand\r\nOFF # keyword\r\n4 2 0\r\n0 0 0\r\n1 0 0\r\n\r\n0 1 0 # third\r\n1 1 0.5\r\n"
         "4 0 1\r\n3 2\r\n3 0 1 2 255 0 0\r\n",
         "0 0 0, 1 0 0, 0 1 0, 1 1 0.5; faces 0 1 3 2, 0 1 2");
  c.good("two.off", "OFF\n4 2 0\n" + corners + "3 0 1 2\n3 1 3 2", points + "; faces 0 1 2, 1 3 2", Cases::all);
  c.good("counts.off", "OFF 4 1\n" + corners + "3 0 1 2\n", points + "; faces 0 1 2");
  for (const char* keyword : {"OFF", "off", "Off", "STOFF", ""})
    c.good("keyword.off", std::string(keyword) + "\n4 1 0\n" + corners + "3 0 1 2\n", points + "; faces 0 1 2");
  for (const char* keyword : {"NOFF", "noff", "STNOFF"})
    c.good("normals.off", std::string(keyword) + "\n1 0 0\n1 2 3 0 0 1\n", "1 2 3; normals 0 0 1");
  c.good("nan.off", "OFF\n1 0 0\n1 nan 3\n", "1 nan 3");

  c.good("levels.off", "COFF\n1 0 0\n1 2 3 255 7 0 255\n", "1 2 3; colors 255 7 0");
  c.good("fractions.off", "coff\n2 0 0\n1 2 3 1.0 0.5 0 1\n1 2 3 0 0 1 0.25\n",
         "1 2 3, 1 2 3; colors 255 128 0, 0 0 255");
  c.good("both.off", "CNOFF\n1 0 0\n1 2 3 0 0 1 9 8 7\n", "1 2 3; normals 0 0 1; colors 9 8 7");
  for (const char* color : {"", " 4", " 300 0 0"})
    c.good("unknown.off", std::string("COFF\n1 0 0\n1 2 3") + color + "\n", "1 2 3; colors_unknown");
  c.good("unknown.off", "COFF\n2 0 0\n1 2 3\n1 2 3 4 5 6\n", "1 2 3, 1 2 3; colors_unknown");
  c.bad("color.off", "COFF\n1 0 0\n1 2 3 0,5 0 0\n", {"line 3", "0,5"});

  for (const std::string count : {"4294967295", "9223372036854775807", "99999999999999999999", "-1"}) {
    c.bad("vertices.off", "OFF\n" + count + " 1 0\n" + corners + "3 0 1 2\n", {"line 2", count});
    c.bad("faces.off", "OFF\n4 " + count + " 0\n" + corners + "3 0 1 2\n", {"line 2", count});
    c.bad("corners.off", "OFF\n4 1 0\n" + corners + count + " 0 1 2\n", {"line 7"});
  }
  c.bad("five.off", "OFF\n5 1 0\n" + corners + "3 0 1 2\n");
  c.bad("many.off", "OFF\n400000000 1 0\n" + corners, {"line 2", "400000000"});
  c.bad("cut.off", "OFF\n4 2 0\n" + corners + "3 0 1 2\n3 1 3 ", {"line 8"});
  c.bad("short.off", "NOFF\n1 0 0\n1 2 3 0 0\n", {"line 3", "6 numbers", "found 5"});
  for (const char* index : {"4", "-1", "4294967296", "1.5"})
    c.bad("index.off", "OFF\n4 1 0\n" + corners + "3 0 1 " + index + "\n", {"line 7", index});
  for (const char* word : {"1,5", "1e400", "1.#IND", "1.#INF"})
    c.bad("number.off", std::string("OFF\n1 0 0\n0 0 ") + word + "\n", {"line 3", word});
  c.bad("four.off", "4OFF\n1 0 0\n1 2 3 4\n", {"4OFF"});
  c.bad("any.off", "nOFF\n3\n1 0 0\n1 2 3\n", {"nOFF"});
  c.bad("binary.off", "OFF BINARY\n1234", {"binary"});
  c.bad("ply.off", "ply\n", {"ply"});
  return c;
}

}  // namespace ahm::io::test

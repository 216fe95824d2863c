#include "io/cases.hpp"

namespace ahm::io::test {

Cases obj_cases() {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n", points = "0 0 0, 1 0 0, 1 1 0, 0 1 0";
  Cases c;
  c.good("statements.obj",
         "# c\r\nmtllib a.mtl\r\no thing\r\nv 0 0 0\r\nv\t1 0 0\r\nvt 0 0\r\nv 1 1 0\r\nv 0 1 0\r\ng x\r\nusemtl m\r\n"
         "s off\r\nvp 1\r\np 1\r\nl 1 2 3\r\nf 1/1 2/1\t3/1 4/1\r\nf 1// 2 \\\r\n 3\r\n",
         points + "; faces 0 1 2 3, 0 1 2");
  c.good("relative.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 5\nf -1 -3 -2\n",
         "0 0 0, 1 0 0, 1 1 0, 5 5 5; faces 0 1 2, 3 1 2");
  c.good("faces_first.obj", "f 1 2 3\n" + corners, points + "; faces 0 1 2");
  c.good("cloud.obj", corners, points);
  c.good("digits.obj", "v nan 431234.567891 0.3\n", "nan 431234.567891 0.3");
  const std::string normals = "vn 0 0 1\nvn 0 0 2\nvn 0 0 3\nvn 0 0 4\n";
  c.good("normals.obj", corners + normals + "f 1//1 2//2 3//3 4//4\n",
         points + "; faces 0 1 2 3; normals 0 0 1, 0 0 2, 0 0 3, 0 0 4");
  c.good("corners.obj", corners + normals + "f 1//1 2//2 3//3 4//1\n",
         points + "; faces 0 1 2 3; normals_not_by_vertex");
  c.good("extensions.obj", corners + "zebra 1\nV 9 9 9\nzebra 2\nf 1 2 3\nadobe_x y\n",
         points + "; faces 0 1 2; lines_skipped 4 5 'zebra 1'");
  c.good("fractions.obj", "v 0 0 0 1.0 0.5 0\nv 1 0 0 0 0 1\n", "0 0 0, 1 0 0; colors 255 128 0, 0 0 255");
  c.good("levels.obj", "v 0 0 0 200 7 0\n", "0 0 0; colors 200 7 0");
  for (const char* extras : {"0.5 -1 0", "300 1 1", "1", "1 1 x"})
    c.good("extras.obj", std::string("v 0 0 0 ") + extras + "\n", "0 0 0; vertex_extras");
  c.good("extras.obj", "v 0 0 0 1.0 0.5 0\nv 1 0 0\n", "0 0 0, 1 0 0; vertex_extras");

  for (const char* index :
       {"0", "5", "-5", "2147483648", "-2147483649", "4294967297", "1.5", "x", "1/1/1/1", "/1", "1/x"})
    c.bad("index.obj", corners + "f 1 2 " + index + "\n", {"line 5", index});
  for (const char* word : {"1,5", "1e400", "1.#IND", "1.#INF"})
    c.bad("number.obj", std::string("v 0 0 ") + word + "\n", {"line 1", word});
  for (const char* word : {"0.5 1 2", "-1", "\x01\x02", "v1.5,2"})
    c.bad("keyword.obj", corners + word + "\n", {"line 5", "not an OBJ keyword"});
  c.bad("vertex.obj", corners + "v 1 2\n", {"line 5", "v 1 2"});
  c.bad("face.obj", corners + "f 1 2", {"line 5", "found 2"});
  c.bad("no_corner.obj", corners + "f", {"line 5"});
  c.bad("nothing.obj", "# nothing\n", {"no vertex"});
  return c;
}

}  // namespace ahm::io::test

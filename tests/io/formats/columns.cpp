// Columns of numbers: XYZ, TXT, ASC, CSV and PTS.
#include "io/cases.hpp"

namespace ahm::io::test {
namespace columns_files {

void add_xyz(Cases& c) {
  c.good("digits.xyz", "# utm\n431234.567891 5412345.678912 12\n\n  +1 -2e-3\t.5  # tail\r\n",
         "431234.567891 5412345.678912 12, 1 -0.002 0.5");
  c.good("special.xyz", "nan -inf 1e-400\n", "nan -inf 0");
  c.good("old.xyz",
         "\xEF\xBB\xBF"
         "1 2 3\r4 5 6\r",
         "1 2 3, 4 5 6");
  c.good("normals.xyz", "1 2 3 0 0 1\n4 5 6 0 1 0\n", "1 2 3, 4 5 6; normals 0 0 1, 0 1 0");
  c.good("colors.txt", "1 2 3 0 0 1\n4 5 6 200 1 0\n", "1 2 3, 4 5 6; colors 0 0 1, 200 1 0; columns_as_colors 4 6");
  c.good("four.xyz", "1 2 3 0.7\n4 5 6 word\n", "1 2 3, 4 5 6; column_ignored column_4");
  c.good("nine.xyz", "1 2 3 200 10 0 0 0 1\n4 5 6 0 0 0 0 1 0\n",
         "1 2 3, 4 5 6; normals 0 0 1, 0 1 0; colors 200 10 0, 0 0 0; columns_as_colors 4 6");
  c.good("normals_twice.xyz", "1 2 3 0 0 1 0 0 1\n",
         "1 2 3; column_4 0; column_5 0; column_6 1; column_7 0; column_8 0; column_9 1; columns_unnamed 4 9");
  c.good("colors_twice.xyz", "1 2 3 9 9 9 9 9 9\n",
         "1 2 3; column_4 9; column_5 9; column_6 9; column_7 9; column_8 9; column_9 9; columns_as_colors 4 6; "
         "columns_as_colors 7 9; columns_unnamed 4 9");
  for (const char* text : {"1.5,2,3\n4,5,6\n", "1.5, 2, 3\n4,5, 6\n", "1.5 , 2 ,3\n4,5,6\n", "1.5;2;3\n4;5;6\n",
                           "1.5;2;3;\n4;5;6;\n", "1.5,2,3,\n4,5,6,\n"})
    c.good("delimiters.xyz", text, "1.5 2 3, 4 5 6");
  c.good("named.asc", "//X Y Z R G B Scalar Nx Ny Nz\n1 2 3 255 0 7 0.5 0 0 1\n",
         "1 2 3; normals 0 0 1; colors 255 0 7; Scalar 0.5");
  c.good("comments.txt", "// scanned\n//X,Y,Z,Rf,Gf,Bf\n// more\n1\n1,2,3,1,0.5,0\n", "1 2 3; colors 255 128 0");
  c.good("order.txt", "z y x\n1 2 3\n", "3 2 1");
  c.good("announced.xyz", "2\n1 2 3\n4 5 6\n", "1 2 3, 4 5 6");

  c.bad("short.xyz", "1 2 3\n4 5\n", {"line 2", "expected 3 columns", "found 2"});
  c.bad("long.xyz", "1 2 3\n4 5 6 7\n", {"line 2", "found 4"});
  c.bad("two.xyz", "1 2\n", {"line 1", "three"});
  c.bad("comment.xyz", "# only this\n", {"no point"});
  for (const char* word : {"1,5", "1e400", "-1e400", "1.#IND", "0x1p3", "1d5", "abc", "+-1"})
    c.bad("number.xyz", std::string("0 0 0\n0 0 ") + word + "\n", {"line 2", word});
  c.bad("normal.xyz", "1 2 3 x 0 1\n", {"line 1", "'x'"});
  c.bad("commas.xyz", "1,5 2,5 3,5\n", {"line 1", "1,5"});
  for (const char* text : {"1,5 2,5 3,5\n", "1,5\t2,5\t3,5\n", "1,5;2,5;3,5\n", "1,5; 2,5; 3,5;\n", "x;y;z\n1,5;2;3\n"})
    c.bad("commas.asc", text, {"'1,5'", "point", "'1.5'"});
  c.bad("mixed.xyz", "1;2;3\n4,5,6\n", {"line 2", "found 1"});
  c.bad("gap.xyz", "1;;3\n", {"line 1", "''"});
  c.bad("named.asc", "//X Y Z R G B\n1 2 3\n", {"line 2", "found 3"});
  c.bad("names.asc", "//X Y Z\n", {"no point"});
  c.bad("comment.asc", "// only this\n", {"no point"});
  c.bad("missing.xyz", "3\n1 2 3\n4 5 6\n", {"line 3", "missing: 1"});
  c.bad("more.xyz", "1\n1 2 3\n4 5 6\n", {"line 3", "more points"});
  c.bad("lie.xyz", "9223372036854775807\n1 2 3\n", {"announced"});
  c.bad("late.xyz", "1 2 3\n2\n1 2 3\n", {"line 2", "found 1"});
}

void add_pts(Cases& c) {
  c.good("scans.pts", "2\n1 2 3 -700 255 0 7\n4 5 6 12 0 0 0\n1\n7 8 9 2047 1 2 3\n",
         "1 2 3, 4 5 6, 7 8 9; colors 255 0 7, 0 0 0, 1 2 3; intensity -700 12 2047");
  c.good("intensity.pts", "1\n1 2 3 0.25\n", "1 2 3; intensity 0.25");
  c.good("points.pts", "1\n1 2 3\n", "1 2 3");
  c.good("scan.pts", "2\n1 2 3 4\n5 6 7 8\n", "1 2 3, 5 6 7; intensity 4 8", 17);
  c.bad("second.pts", "2\n1 2 3 4\n5 6 7 8\n2\n1 2 3 4\n", {"line 5", "missing: 1"});
  c.bad("more.pts", "1\n1 2 3 4\n5 6 7 8\n", {"line 3"});
  c.bad("word.pts", "1 2 3 high\n", {"line 1", "high"});
}

void add_csv(Cases& c) {
  c.good("names.csv", "id,Z,\"x\",note,y\n7,3,1,hello,2\n", "1 2 3; id 7; column_ignored note");
  c.good("semicolons.csv", "x;y;z;nx;ny;nz\n1;2;3;0;0;1\n", "1 2 3; normals 0 0 1");
  c.good("tabs.csv", "\xEF\xBB\xBFz\tmore\ty\tx\n1\t\t2\t3\n4\t7\t5\t6\n", "3 2 1, 6 5 4; more nan 7");
  c.good("unnamed.csv", "1, 2, 3\n4,5,6\n", "1 2 3, 4 5 6");
  c.good("blanks.csv", "1 2 3\n", "1 2 3");
  c.good("properties.csv", "id,x,y,z,status,height (m),empty\n7,1,2,3,ok,0.5,\n8,4,5,6,1,0.25,2\n",
         "1 2 3, 4 5 6; id 7 8; height__m_ 0.5 0.25; empty nan 2; column_ignored status");
  c.bad("missing.csv", "x,y,w\n1,2,3\n", {"'z'"});
  c.bad("twice.csv", "x,y,z,x\n1,2,3,4\n", {"'x'"});
  c.bad("short.csv", "x,y,z\n1,2\n", {"line 2"});
  c.bad("none.csv", "x,y,z\n", {"no point"});
  c.bad("comma.csv", "x;y;z\n1,5;2;3\n", {"line 2", "1,5"});
  c.bad("gap.csv", "1,,3\n", {"line 1"});
}

}  // namespace columns_files

Cases column_cases() {
  using namespace columns_files;
  Cases c;
  add_xyz(c), add_pts(c), add_csv(c);
  return c;
}

}  // namespace ahm::io::test

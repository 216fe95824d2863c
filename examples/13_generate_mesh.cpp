// Prints a mesh as OBJ: 13_generate_mesh knot > knot.obj; also a bowl and a flat disc.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>

namespace {

constexpr double pi = std::numbers::pi;

void print(double x, double y, double z) { std::printf("v %.9f %.9f %.9f\n", x, y, z); }

/// Quads between consecutive rings of vertices. `first` is the number of the first vertex, from 1. If `closed`, the last
/// ring joins the first.
void print_quads(int first, int rings, int around, bool closed) {
  for (int i = 0; i + !closed < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = first + i * around, b = first + (i + 1) % rings * around, next = (j + 1) % around;
      std::printf("f %d %d %d %d\n", a + j, b + j, b + next, a + next);
    }
}

/// The triangles between a ring and a vertex.
void print_fan(int middle, int first, int around, bool turned) {
  for (int j = 0; j < around; ++j) {
    const int here = first + j, next = first + (j + 1) % around;
    std::printf("f %d %d %d\n", middle, turned ? next : here, turned ? here : next);
  }
}

/// A tube around a trefoil knot.
void print_knot() {
  constexpr int along = 400, around = 48;
  constexpr double radius = 0.62;
  for (int i = 0; i < along; ++i) {
    const double t = 2 * pi * i / along;
    const double c[3] = {std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
    const double d[3] = {std::cos(t) + 4 * std::cos(2 * t), -std::sin(t) + 4 * std::sin(2 * t), -3 * std::cos(3 * t)};
    const double e[3] = {-std::sin(t) - 8 * std::sin(2 * t), -std::cos(t) + 8 * std::cos(2 * t), 9 * std::sin(3 * t)};
    // Binormal and normal of the curve (Frenet).
    double b[3] = {d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]};
    double n[3] = {b[1] * d[2] - b[2] * d[1], b[2] * d[0] - b[0] * d[2], b[0] * d[1] - b[1] * d[0]};
    const double b_length = std::hypot(b[0], b[1], b[2]), n_length = std::hypot(n[0], n[1], n[2]);
    for (int j = 0; j < around; ++j) {
      const double x = radius * std::cos(2 * pi * j / around) / n_length;
      const double y = radius * std::sin(2 * pi * j / around) / b_length;
      print(c[0] + x * n[0] + y * b[0], c[1] + x * n[1] + y * b[1], c[2] + x * n[2] + y * b[2]);
    }
  }
  print_quads(1, along, around, true);
}

/// A bowl of radius 1 with a thick wall. The first vertex is the middle of its inside, the last one that of its outside.
void print_bowl() {
  constexpr int around = 120, down = 40, rim = 6;
  const auto ring = [](double r, double z) {
    for (int j = 0; j < around; ++j) print(r * std::cos(2 * pi * j / around), r * std::sin(2 * pi * j / around), z);
  };
  print(0, 0, -0.54);
  for (int i = 1; i < down; ++i) ring(0.94 * std::sin(pi / 2 * i / down), -0.54 * std::cos(pi / 2 * i / down));
  for (int i = 0; i <= rim; ++i) ring(0.97 - 0.03 * std::cos(pi * i / rim), 0.03 * std::sin(pi * i / rim));
  for (int i = down - 1; i > 0; --i) ring(std::sin(pi / 2 * i / down), -0.6 * std::cos(pi / 2 * i / down));
  print(0, 0, -0.6);
  constexpr int rings = 2 * (down - 1) + rim + 1, last = 2 + rings * around;
  print_fan(1, 2, around, false);
  print_quads(2, rings, around, false);
  print_fan(last, last - around, around, true);
}

/// A flat disc of radius 1 around its first vertex.
void print_disc() {
  constexpr int around = 96, rings = 16;
  print(0, 0, 0);
  for (int i = 1; i <= rings; ++i)
    for (int j = 0; j < around; ++j)
      print(std::cos(2 * pi * j / around) * i / rings, std::sin(2 * pi * j / around) * i / rings, 0);
  print_fan(1, 2, around, false);
  print_quads(2, rings, around, false);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view shape = argc == 2 ? argv[1] : "knot";
  if (shape == "knot") return print_knot(), 0;
  if (shape == "bowl") return print_bowl(), 0;
  if (shape == "disc") return print_disc(), 0;
  std::fprintf(stderr, "usage: 13_generate_mesh [knot|bowl|disc]\n");
  return 2;
}

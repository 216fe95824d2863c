// The GLSL types and functions that palette.glsl uses, so that C++ and the browser share one file.
#pragma once

#include <algorithm>
#include <cmath>

namespace ahm::render::glsl {

// NOLINTBEGIN(readability-identifier-naming): names of GLSL
struct vec2 {
  float x = 0, y = 0;
  vec2() = default;
  explicit vec2(float all) : x(all), y(all) {}
  vec2(float first, float second) : x(first), y(second) {}
};

struct vec3 {
  float x = 0, y = 0, z = 0;
  vec3() = default;
  explicit vec3(float all) : x(all), y(all), z(all) {}
  vec3(float first, float second, float third) : x(first), y(second), z(third) {}
};
// NOLINTEND(readability-identifier-naming)

inline vec2 operator+(vec2 a, vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline vec2 operator-(vec2 a, vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline vec2 operator*(vec2 a, float s) { return {a.x * s, a.y * s}; }
inline vec2 operator*(float s, vec2 a) { return a * s; }
inline vec2 operator/(vec2 a, float s) { return {a.x / s, a.y / s}; }
inline vec3 operator+(vec3 a, vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline vec3 operator-(vec3 a, vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline vec3 operator-(vec3 a) { return {-a.x, -a.y, -a.z}; }
inline vec3 operator*(vec3 a, vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline vec3 operator*(vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline vec3 operator*(float s, vec3 a) { return a * s; }

inline float dot(vec2 a, vec2 b) { return a.x * b.x + a.y * b.y; }
inline float dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float length(vec2 a) { return std::sqrt(dot(a, a)); }
inline vec3 normalize(vec3 a) { return a * (1 / std::sqrt(dot(a, a))); }

inline float abs(float x) { return std::fabs(x); }
inline float atan(float y, float x) { return std::atan2(y, x); }
inline float cos(float x) { return std::cos(x); }
inline float sin(float x) { return std::sin(x); }
inline float exp(float x) { return std::exp(x); }
inline float pow(float x, float y) { return std::pow(x, y); }
inline float floor(float x) { return std::floor(x); }
inline float fract(float x) { return x - std::floor(x); }
inline float mod(float x, float y) { return x - y * std::floor(x / y); }
inline float max(float a, float b) { return std::max(a, b); }
inline float min(float a, float b) { return std::min(a, b); }
inline float clamp(float x, float low, float high) { return std::min(std::max(x, low), high); }
inline vec3 clamp(vec3 a, float low, float high) {
  return {clamp(a.x, low, high), clamp(a.y, low, high), clamp(a.z, low, high)};
}
inline vec2 abs(vec2 a) { return {abs(a.x), abs(a.y)}; }
inline vec3 mix(vec3 a, vec3 b, float t) { return a * (1 - t) + b * t; }

}  // namespace ahm::render::glsl

// The colors of all pictures, for GLSL ES 1.00 and, with glsl.hpp, for C++.
const float pi = 3.14159265;

// Linear RGB of an OKLCh color (Ottosson 2020). Unlike in HSV, hues of equal lightness look equally bright.
vec3 oklch(float lightness, float chroma, float hue) {
  float a = chroma * cos(hue), b = chroma * sin(hue);
  float l = lightness + 0.3963377774 * a + 0.2158037573 * b;
  float m = lightness - 0.1055613458 * a - 0.0638541728 * b;
  float s = lightness - 0.0894841775 * a - 1.2914855480 * b;
  vec3 lms = vec3(l * l * l, m * m * m, s * s * s);
  return clamp(vec3(dot(vec3(4.0767416621, -3.3077115913, 0.2309699292), lms),
                    dot(vec3(-1.2684380046, 2.6097574011, -0.3413193965), lms),
                    dot(vec3(-0.0041960863, -0.7034186147, 1.7076147010), lms)), 0.0, 1.0);
}

// Integral of the wave that is +1 on even and -1 on odd unit intervals.
float triangle_wave(float x) { return 1.0 - abs(2.0 * fract(0.5 * x) - 1.0); }

// The square wave, averaged over a pixel of this width: gray where intervals are smaller than pixels.
float square_wave(float x, float width) {
  float w = max(width, 0.004);
  return (triangle_wave(x + 0.5 * w) - triangle_wave(x - 0.5 * w)) / w;
}

// In the following functions, dx and dy are the changes of uv over one pixel. The result is linear RGB.

// Rings and sectors around the source. uv in ring widths.
vec3 polar_color(vec2 uv, vec2 dx, vec2 dy, float sectors) {
  float r = max(length(uv), 1e-6);
  vec2 radial = uv / r, around = vec2(-radial.y, radial.x);
  float ring_width = abs(dot(radial, dx)) + abs(dot(radial, dy));
  float sectors_per_radian = sectors / (2.0 * pi);
  float sector_width = (abs(dot(around, dx)) + abs(dot(around, dy))) / r * sectors_per_radian;
  float angle = atan(radial.y, radial.x);
  float checker = square_wave(r, ring_width) * square_wave(angle * sectors_per_radian, sector_width);
  float hue = angle + 0.5;
  return mix(oklch(0.50, 0.125, hue), oklch(0.83, 0.105, hue), 0.5 + 0.5 * checker);
}

// Squares of u and v: warm colors on the left of the curve (v > 0), cold colors on the right. The hue changes with the distance.
vec3 grid_color(vec2 uv, vec2 dx, vec2 dy) {
  vec2 width = abs(dx) + abs(dy);
  float checker = square_wave(uv.x, width.x) * square_wave(uv.y, width.y);
  float left = clamp(0.5 + uv.y / max(width.y, 1e-6), 0.0, 1.0);
  float turn = 1.6 * (1.0 - exp(-abs(uv.y) / 6.0));
  vec3 dark = mix(oklch(0.47, 0.12, 4.4 + turn), oklch(0.56, 0.125, 0.8 + turn), left);
  vec3 light = mix(oklch(0.80, 0.09, 4.4 + turn), oklch(0.88, 0.10, 0.8 + turn), left);
  return mix(dark, light, 0.5 + 0.5 * checker);
}

// Cells: uv.x is the number of one of twelve colors; uv.y is the distance from the cell's source, in ring widths. Adjacent hues differ in
// lightness, and successive numbers have distant hues.
vec3 cell_color(vec2 uv, vec2 dx, vec2 dy) {
  float number = floor(uv.x + 0.5);
  float hue = mod(5.0 * number, 12.0) * pi / 6.0 + 0.5;
  float ring = square_wave(uv.y, abs(dx.y) + abs(dy.y));
  float lightness = mod(number, 2.0) < 0.5 ? 0.58 : 0.80;
  return oklch(lightness + 0.035 * ring, 0.115, hue);
}

// The color of a distance in [0, 1], with evenly increasing lightness: violet, blue, green, yellow.
vec3 distance_color(float t) {
  t = clamp(t, 0.0, 1.0);
  float lightness = 0.28 + 0.62 * t;
  float chroma = 0.13 + 0.05 * t * t - 0.12 * t * (1.0 - t);
  return oklch(lightness, chroma, 5.45 - 3.62 * t - 0.06 * sin(2.0 * pi * t));
}

// Distance colors with thin dark lines at the rings.
vec3 distance_with_lines(vec2 uv, vec2 dx, vec2 dy, float rings) {
  float width = max(abs(dx.x) + abs(dy.x), 1e-6);
  float from_line = abs(uv.x - floor(uv.x + 0.5)) / width;
  float line = (1.0 - clamp(from_line - 0.4, 0.0, 1.0)) * clamp(0.25 / width - 0.5, 0.0, 1.0);
  return distance_color(uv.x / rings) * (1.0 - 0.30 * line);
}

vec3 plain_color() { return vec3(0.58, 0.56, 0.53); }

// `pattern` is the number of an ahm::render::Pattern. `sectors`: of the polar pattern. `rings`: distance at the end of the color scale.
vec3 map_color(int pattern, vec2 uv, vec2 dx, vec2 dy, float sectors, float rings) {
  if (pattern == 1) return grid_color(uv, dx, dy);
  if (pattern == 2) return cell_color(uv, dx, dy);
  if (pattern == 3) return distance_with_lines(uv, dx, dy, rings);
  if (pattern == 4) return plain_color();
  return polar_color(uv, dx, dy, sectors);
}

vec3 unknown_color() { return vec3(0.42); }

// The color where the quality is low: pale, with dark diagonal stripes. `pixel` in 1200ths of the picture's smaller side.
vec3 low_quality_color(vec3 color, vec2 pixel, float pixel_size) {
  float gray = 0.45 + 0.35 * dot(color, vec3(0.3, 0.5, 0.2));
  float width = 0.1414 * pixel_size;
  float stripe = 0.5 + 0.5 * square_wave(0.1414 * (pixel.x + pixel.y), 2.0 * width);
  return mix(vec3(gray), color, 0.18) * (1.0 - 0.62 * stripe);
}

// The color where the distance is only a lower bound: dark dots.
vec3 bounded_color(vec3 color, vec2 pixel, float pixel_size) {
  float width = 0.1414 * pixel_size;
  float dot_here = (0.5 + 0.5 * square_wave(0.1414 * pixel.x, 2.0 * width)) * (0.5 + 0.5 * square_wave(0.1414 * pixel.y, 2.0 * width));
  return color * (1.0 - 0.7 * dot_here);
}

// Diffuse light from above the viewer's left shoulder. The normal is in camera coordinates and points towards the viewer.
vec3 matte(vec3 color, vec3 normal) {
  vec3 key = normalize(vec3(-0.35, 0.55, 0.85));
  float diffuse = max(0.0, 0.75 * dot(normal, key) + 0.25);
  float sky = 0.5 + 0.5 * normal.y;
  return color * (0.20 + 0.12 * sky + 0.86 * diffuse);
}

vec3 lit(vec3 color, vec3 normal, vec3 to_eye) {
  vec3 half_way = normalize(normalize(vec3(-0.35, 0.55, 0.85)) + to_eye);
  return matte(color, normal) + vec3(0.03 * pow(max(0.0, dot(normal, half_way)), 60.0));
}

// The colours of every picture, for GLSL 3.30 and GLSL ES 1.00 alike.
const float pi = 3.14159265;

// OKLCh (Ottosson 2020): hues of equal lightness look equally bright, which HSV's do not. Result: linear RGB.
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

vec3 to_srgb(vec3 linear) {
  return mix(12.92 * linear, 1.055 * pow(max(linear, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, linear));
}

// Integral of the wave that is +1 on even and -1 on odd unit intervals.
float triangle_wave(float x) { return 1.0 - abs(2.0 * fract(0.5 * x) - 1.0); }

// That wave averaged over a pixel of this width: sharp near by, plain grey where cells are smaller than pixels.
float square_wave(float x, float width) {
  float w = max(width, 0.004);
  return (triangle_wave(x + 0.5 * w) - triangle_wave(x - 0.5 * w)) / w;
}

// The polar checkerboard at uv (in ring widths), where dx and dy are the changes of uv over one pixel. Linear RGB.
vec3 map_colour(vec2 uv, vec2 dx, vec2 dy, float sectors) {
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

vec3 unknown_colour() { return vec3(0.42); }

// Light from over the viewer's left shoulder, in camera coordinates; the normal looks towards the viewer.
vec3 lit(vec3 colour, vec3 normal, vec3 to_eye) {
  vec3 key = normalize(vec3(-0.35, 0.55, 0.85));
  float diffuse = max(0.0, 0.75 * dot(normal, key) + 0.25);
  float sky = 0.5 + 0.5 * normal.y;
  float gloss = pow(max(0.0, dot(normal, normalize(key + to_eye))), 60.0);
  return colour * (0.20 + 0.12 * sky + 0.86 * diffuse) + vec3(0.03 * gloss);
}

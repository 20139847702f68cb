#include "render/gl/shader_parts.h"

namespace hooke::render {

std::string shader_version(bool fast) {
  return fast ? "#version 330 core\n#define FAST\n" : "#version 330 core\n";
}

std::string lit_version(LitKind kind) {
  return shader_version(kind.fast) + "#define LIGHTS " + (kind.has_lights ? "int(light_count.x)\n" : "0\n");
}

std::string frame_part() {
  return R"(
layout(std140) uniform Frame {
  mat4 view_projection;
  mat4 shadow_matrix;
  mat4 shadow_clip;
  vec4 eye;             // w: near distance
  vec4 ray_right;       // half the picture's width at distance 1
  vec4 ray_up;
  vec4 ray_forward;
  vec4 sun_direction;
  vec4 sun_color;       // linear, times intensity
  vec4 zenith;          // linear
  vec4 horizon;         // linear; w: cover of clouds
  vec4 below;           // light that comes from the ground
  vec4 irradiance[9];   // spherical harmonics of the sky's light, ready to be summed
  vec4 shadow_info;     // texel [m], map size, 1 if there is a map, distance of the haze [m]
  vec4 shadow_light;    // depth of the map [m], tangent of the sun's half angle, taps, widest half shadow [m]
  vec4 viewport;        // width, height [px]; radius of occlusion [m], 1 if there is occlusion
};
)";
}

std::string color_part() {
  return R"(
// Khronos PBR Neutral (Khronos Group, "Khronos PBR Neutral Tone Mapper", 2024): colors stay as they are up to
// 0.76, and what is brighter goes to white without a change of hue, so that nothing burns. Color is lost at a third
// of the published rate, and less gray is taken off, because flags in the sun and dark folds are the subject here.
vec3 tone_mapped(vec3 color) {
  float x = min(color.r, min(color.g, color.b));
  const float gray = 0.015;
  color -= x < 2.0 * gray ? x - x * x / (4.0 * gray) : gray;
  float peak = max(color.r, max(color.g, color.b));
  const float start = 0.76;
  const float d = 1.0 - start;
  float new_peak = peak < start ? peak : 1.0 - d * d / (peak + d - start);
  color *= new_peak / max(peak, 1e-4);
  float g = peak < start ? 0.0 : 1.0 - 1.0 / (0.05 * (peak - new_peak) + 1.0);
  return mix(color, vec3(new_peak), g);
}
// The picture holds sRGB, which is encoded here once a pixel: a target that encodes by itself does so once a
// sample, at twice the time of the whole picture in software. The roots are within 0.003 of the true curve
// (Taylor, "sRGB approximations for HLSL", 2008).
vec3 encoded(vec3 color) {
  vec3 s1 = sqrt(color);
  vec3 s2 = sqrt(s1);
  vec3 s3 = sqrt(s2);
  return 0.585122381 * s1 + 0.783140355 * s2 - 0.368262736 * s3;
}
vec3 shown(vec3 color) {
  return encoded(tone_mapped(color));
}
// What is far away takes on some of the sky's color, but never so much that the horizon is lost.
vec3 with_haze(vec3 color, float distance_to_eye) {
  float x = distance_to_eye / shadow_info.w;
  return mix(color, 0.8 * horizon.rgb, 0.6 * (1.0 - exp(-x * x)));
}
)";
}

std::string sky_part() {
  return R"(
// A gradient with a glow around the sun. SkyLight::radiance is the same in C++.
vec3 sky_radiance(vec3 ray) {
  vec3 color = mix(horizon.rgb, zenith.rgb, 1.0 - exp(-3.5 * max(ray.y, 0.0)));
  float near_sun = max(dot(ray, sun_direction.xyz), 0.0);
  float s = near_sun * near_sun;
  s *= s;
  s *= s;
  return color + sun_color.rgb * (0.10 * s + 0.25 * s * s * s * s);
}
// What a surface of some roughness mirrors: the horizon is as wide as the highlight.
vec3 mirrored_sky(vec3 ray, float roughness) {
  float width = 0.03 + 0.9 * roughness;
  float down = smoothstep(-width, width, -ray.y);
  return mix(sky_radiance(ray), below.rgb, down);
}
vec3 sky_irradiance(vec3 n) {
  vec3 sum = irradiance[0].rgb + irradiance[1].rgb * n.y + irradiance[2].rgb * n.z + irradiance[3].rgb * n.x;
  sum += irradiance[4].rgb * (n.x * n.y) + irradiance[5].rgb * (n.y * n.z);
  sum += irradiance[6].rgb * (3.0 * n.z * n.z - 1.0) + irradiance[7].rgb * (n.x * n.z);
  sum += irradiance[8].rgb * (n.x * n.x - n.y * n.y);
  return max(sum, vec3(0.0));
}
)";
}

std::string corner_part() {
  return R"(
#ifdef FAST
// What changes evenly over a triangle is computed at its corners.
out vec3 sun_place;   // in the sun's map, see sun_visibility
out vec3 even_light;  // the sky's light on one side of the surface is even_light + odd_light, on the other the
out vec3 odd_light;   // difference
void light_corner(vec3 point, vec3 normal) {
  vec3 n = normal * inversesqrt(max(dot(normal, normal), 1e-30));
  float n_dot_l = dot(n, sun_direction.xyz);
  float slope = sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0));
  float side = n_dot_l < 0.0 ? -1.0 : 1.0;
  vec3 moved = point + side * n * shadow_info.x * (0.4 + 1.4 * slope);
  sun_place = (shadow_matrix * vec4(moved, 1.0)).xyz;
  vec3 here = sky_irradiance(n);
  vec3 there = sky_irradiance(-n);
  even_light = 0.5 * (here + there);
  odd_light = 0.5 * (here - there);
}
#endif
)";
}

namespace {

constexpr const char* kShadowPart = R"(
uniform sampler2DShadow shadow_map;
uniform sampler2D shadow_depth;
#ifdef CORNERS
in vec3 sun_place;
in vec3 even_light;
in vec3 odd_light;
#endif
// The sky's light on the side of the surface that is seen, or on the other one.
vec3 irradiance_on(vec3 n, float side) {
#ifdef CORNERS
  return max(even_light + (gl_FrontFacing ? side : -side) * odd_light, vec3(0.0));
#else
  return sky_irradiance(side * n);
#endif
}

// Each point of a disk is the golden angle further around than the one before, and a little further out: they
// are spread evenly (Vogel 1979).
const mat2 golden_turn = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);
vec2 first_way() {
  float turn = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  return vec2(cos(6.2831853 * turn), sin(6.2831853 * turn));
}

// A 3 x 3 tent from four bilinear taps (Castano, "Shadow mapping summary", 2013), in the part of a map that
// begins at a corner [texels].
float tent_shadow(sampler2DShadow map, vec2 map_size, vec2 corner, vec2 texel, float z, bool is_open) {
  vec2 base = floor(texel + 0.5);
  vec2 part = texel + 0.5 - base;
  base += corner - 0.5;
  vec2 w0 = 3.0 - 2.0 * part;
  vec2 w1 = 1.0 + 2.0 * part;
  vec2 p0 = (base + (2.0 - part) / w0 - 1.0) / map_size;
  vec2 p1 = (base + part / w1 + 1.0) / map_size;
  float depth = min(z, 1.0);
  // A loop that may run zero times: software drivers compute both sides of an if, but leave a loop.
  float sum = 0.0;
  int rows = is_open ? 2 : 0;
  for (int row = 0; row < rows; ++row) {
    float y = row == 0 ? p0.y : p1.y;
    sum += (row == 0 ? w0.y : w1.y) * (w0.x * textureLod(map, vec3(p0.x, y, depth), 0.0) +
                                       w1.x * textureLod(map, vec3(p1.x, y, depth), 0.0));
  }
  return rows > 0 ? sum / 16.0 : 1.0;
}

#ifdef FAST
float narrow_shadow(vec3 place, bool is_open) {
  // Two taps a texel apart see as many open as closed points of the pattern of a half shadow. A loop that may
  // run zero times, as above.
  vec3 tap = vec3(place.x - 0.5 / shadow_info.y, place.y, min(place.z, 1.0));
  float sum = 0.0;
  int taps = is_open ? 2 : 0;
  for (int i = 0; i < taps; ++i) {
    sum += textureLod(shadow_map, tap, 0.0);
    tap.x += 1.0 / shadow_info.y;
  }
  return taps > 0 ? 0.5 * sum : 1.0;
}
#else
// The sun is a disk, so the half shadow grows with the distance of what casts it (Fernando, "Percentage-closer
// soft shadows", 2005).
float soft_shadow(vec3 place, float slope, float n_dot_l, bool is_open) {
  float depth = min(place.z, 1.0);
  float texel = 1.0 / shadow_info.y;
  vec2 way = first_way();
  // Loops that may run zero times: software drivers compute both sides of an if, but leave a loop.
  int searches = is_open ? 6 : 0;
  // The meters of a half shadow in the map's own length.
  float per_meter = texel / shadow_info.x;
  float reach = clamp(shadow_light.y * depth * shadow_light.x, 2.0 * shadow_info.x, shadow_light.w) * per_meter;
  float found = 0.0;
  float gap = 0.0;
  for (int i = 0; i < searches; ++i) {
    float above = depth - textureLod(shadow_depth, place.xy + reach * sqrt((float(i) + 0.5) / 6.0) * way, 0.0).r;
    way = golden_turn * way;
    float counts = above > 0.0 ? 1.0 : 0.0;
    found += counts;
    gap += counts * above;
  }
  if (found < 0.5) found = 0.0;
  float half_shadow = shadow_light.y * gap / max(found, 1.0) * shadow_light.x;
  float radius = clamp(half_shadow * per_meter, 1.3 * texel, reach);
  int taps = found > 0.0 ? int(shadow_light.z) : 0;
  // The depth falls off along a surface that leans away from the sun, and more so over a wider filter.
  float lean = min(slope / max(n_dot_l, 0.05), 4.0) * max(radius - 1.3 * texel, 0.0) / per_meter / shadow_light.x;
  float sum = 0.0;
  float per_tap = 1.0 / max(float(taps), 1.0);
  for (int i = 0; i < taps; ++i) {
    vec2 from_middle = radius * sqrt((float(i) + 0.5) * per_tap) * way;
    sum += textureLod(shadow_map, vec3(place.xy + from_middle, depth - 0.5 * lean), 0.0);
    way = golden_turn * way;
  }
  return taps > 0 ? sum / float(taps) : 1.0;
}
#endif

// How much of the sun reaches a point. The point is moved along the normal by what the filter reaches over, more
// at grazing light, so that a surface does not shadow itself.
float sun_visibility(vec3 point, vec3 normal, float n_dot_l) {
#ifdef CORNERS
  vec3 place = sun_place;
#else
  float slope = sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0));
  vec3 moved = point + normal * shadow_info.x * (0.4 + 1.4 * slope);
  vec3 place = (shadow_matrix * vec4(moved, 1.0)).xyz;
#endif
  bool inside = all(greaterThan(place.xy, vec2(0.0))) && all(lessThan(place.xy, vec2(1.0)));
  bool is_open = n_dot_l > 0.0 && inside && shadow_info.z > 0.5;
#ifdef FAST
  return narrow_shadow(place, is_open);
#else
  return soft_shadow(place, slope, n_dot_l, is_open);
#endif
}
)";

constexpr const char* kLightsPart = R"(
layout(std140) uniform Lights {
  vec4 light_count;       // lights, size of a map in texels, rows of maps
  vec4 light_place[8];    // place and 1, or the direction to a light from far away and 0
  vec4 light_beam[8];     // direction in which it shines, cosine beyond which it is dark
  vec4 light_color[8];    // linear; one over the width of the rim, as a cosine
  vec4 light_map[8];      // first map or -1, number of maps, texel [m], of those with a place at 1 m
  mat4 light_matrix[12];  // to the space of a map
};
uniform sampler2DShadow light_maps;

struct Source {
  vec3 toward;  // direction to the light
  vec3 color;   // what arrives without shadows
  float away;   // distance, 1 for a light from far away
};

// Falloff by the square, and a cone with a soft rim: KHR_lights_punctual (Khronos Group 2018).
Source source_at(int i, vec3 point) {
  vec4 place = light_place[i];
  vec3 way = place.xyz - place.w * point;
  float squared = max(dot(way, way), 1e-4);
  Source source;
  source.toward = way * inversesqrt(squared);
  source.away = mix(1.0, sqrt(squared), place.w);
  float rim = clamp((dot(-source.toward, light_beam[i].xyz) - light_beam[i].w) * light_color[i].w, 0.0, 1.0);
  source.color = light_color[i].rgb * (rim * rim * mix(1.0, 1.0 / squared, place.w));
  return source;
}

// Which of the six maps of a point light looks along a direction.
float side_of(vec3 way) {
  vec3 size = abs(way);
  if (size.x >= size.y && size.x >= size.z) return way.x > 0.0 ? 0.0 : 1.0;
  if (size.y >= size.z) return way.y > 0.0 ? 2.0 : 3.0;
  return way.z > 0.0 ? 4.0 : 5.0;
}

// How much of a light reaches a point: a 3 x 3 tent from four bilinear taps (Castano, "Shadow mapping summary",
// 2013). The point is moved along the normal by what the filter reaches over, as for the sun.
float source_visibility(int i, vec3 point, vec3 normal, Source source, float n_dot_l) {
  vec4 map = light_map[i];
  float slope = sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0));
  vec3 moved = point + normal * (map.z * source.away * (0.4 + 1.4 * slope));
  float number = max(map.x, 0.0) + (map.y > 1.5 ? side_of(moved - light_place[i].xyz) : 0.0);
  vec4 place = light_matrix[int(number)] * vec4(moved, 1.0);
  place.xyz /= max(place.w, 1e-6);
  bool inside = all(greaterThan(place.xy, vec2(0.0))) && all(lessThan(place.xy, vec2(1.0))) && place.w > 0.0;
  bool is_open = map.x >= 0.0 && n_dot_l > 0.0 && inside;
  float size = light_count.y;
  vec2 texel = clamp(place.xy * size, 2.0, size - 2.0);
  vec2 tile = vec2(mod(number, 4.0), floor(number / 4.0)) * size;
  return tent_shadow(light_maps, vec2(4.0, light_count.z) * size, tile, texel, place.z, is_open);
}
)";

constexpr const char* kReflectionPart = R"(
uniform sampler2D occlusion_map;

// How much of the sky a pixel sees; see the occlusion shader.
float sky_visibility() {
  float seen = textureLod(occlusion_map, gl_FragCoord.xy / viewport.xy, 0.0).r;
  return viewport.w > 0.5 ? seen : 1.0;
}

// The share of the sky that a rough surface throws back: Karis, "Physically based shading on mobile", 2014.
vec3 mirrored_share(vec3 f0, float roughness, float n_dot_v) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
  vec2 ab = vec2(-1.04, 1.04) * a + r.zw;
  return f0 * ab.x + ab.y;
}

// What a surface throws back of a light, for white light of strength one: the microfacets of Trowbridge and
// Reitz, "GGX" (Walter and others 2007), with the shadowing of Hammon (2017) and the Fresnel term of Schlick
// (1994). It is relative to a white matte surface, so pi cancels.
vec3 highlight_of(vec3 l, vec3 f0, float roughness, vec3 n, vec3 v, float n_dot_l, float n_dot_v) {
  vec3 h = normalize(l + v);
  float n_dot_h = clamp(dot(n, h), 0.0, 1.0);
  float l_dot_h = clamp(dot(l, h), 0.0, 1.0);
  float a = max(roughness * roughness, 0.003);
  float q = n_dot_h * n_dot_h * (a * a - 1.0) + 1.0;
  float spread = a * a / (q * q);
  float shadowing = 0.5 / max(mix(2.0 * n_dot_l * n_dot_v, n_dot_l + n_dot_v, a), 1e-3);
  float away = 1.0 - l_dot_h;
  float away2 = away * away;
  return (f0 + (1.0 - f0) * (away2 * away2 * away)) * min(spread * shadowing, 60.0);
}

)";

constexpr const char* kLightPart = R"(
// The light that comes back apart from color below the surface (x of the pair) and from the surface itself.
struct Light {
  vec3 inner;  // to be multiplied by the color
  vec3 outer;
};

Light light_at(vec3 f0, float roughness, vec3 n, vec3 v, vec3 point) {
  float n_dot_l = dot(n, sun_direction.xyz);
  float n_dot_v = clamp(dot(n, v), 0.02, 1.0);
  float seen = sky_visibility();
  float facing = clamp(n_dot_l, 0.0, 1.0);
  vec3 sun = sun_color.rgb * facing * sun_visibility(point, n, n_dot_l) * (0.6 + 0.4 * seen);
  Light light;
  light.inner = irradiance_on(n, 1.0) * seen + sun;
  vec3 mirrored = mirrored_sky(reflect(-v, n), roughness) * mirrored_share(f0, roughness, n_dot_v);
  light.outer = mirrored * seen + sun * highlight_of(sun_direction.xyz, f0, roughness, n, v, facing, n_dot_v);
  int sources = LIGHTS;
  for (int i = 0; i < sources; ++i) {
    Source source = source_at(i, point);
    float toward = clamp(dot(n, source.toward), 0.0, 1.0);
    vec3 strength = source.color * toward * source_visibility(i, point, n, source, toward) * (0.6 + 0.4 * seen);
    light.inner += strength;
    light.outer += strength * highlight_of(source.toward, f0, roughness, n, v, toward, n_dot_v);
  }
  return light;
}
)";

}  // namespace

std::string shadow_part() {
  return std::string(kShadowPart) + kLightsPart;
}

std::string reflection_part() {
  return std::string(kReflectionPart) + kLightPart;
}

std::string mesh_inputs_part() {
  return R"(
invariant gl_Position;  // depths are compared with those of other shaders
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 row_x;  // the affine matrix by rows
layout(location = 4) in vec4 row_y;
layout(location = 5) in vec4 row_z;
layout(location = 6) in vec4 color;    // linear, alpha is the opacity
layout(location = 7) in vec4 surface;  // metalness, roughness, sheen, threads
layout(location = 8) in vec2 clear;    // transmission, strength of the relief
vec3 world_position() {
  vec4 p = vec4(position, 1.0);
  return vec3(dot(row_x, p), dot(row_y, p), dot(row_z, p));
}
)";
}

}  // namespace hooke::render

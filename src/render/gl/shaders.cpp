#include "render/gl/shaders.h"

#include "render/gl/shader_parts.h"

namespace hooke::render {

namespace {

const std::string kMeshVertex = R"(
out vec3 point;
out vec3 surface_normal;
out vec2 texture_place;
flat out vec4 tint;
flat out vec4 finish;
flat out vec2 glass;
void main() {
  point = world_position();
  // The cofactors turn normals the right way under uneven scale; a mirror would turn them inside out.
  vec3 c0 = cross(row_y.xyz, row_z.xyz);
  vec3 c1 = cross(row_z.xyz, row_x.xyz);
  vec3 c2 = cross(row_x.xyz, row_y.xyz);
  float side = dot(row_x.xyz, c0) < 0.0 ? -1.0 : 1.0;
  surface_normal = side * vec3(dot(c0, normal), dot(c1, normal), dot(c2, normal));
  texture_place = uv;
  tint = color;
  finish = surface;
  glass = clear;
  gl_Position = view_projection * vec4(point, 1.0);
#ifdef FAST
  light_corner(point, surface_normal);
#endif
}
)";

const std::string kMeshFragmentInputs = R"(
in vec3 point;
in vec3 surface_normal;
in vec2 texture_place;
flat in vec4 tint;
flat in vec4 finish;  // metalness, roughness, sheen, threads
flat in vec2 glass;  // share of the light that goes through, strength of the relief
uniform sampler2D surface_texture;
uniform int alpha_mode;  // AlphaMode
layout(location = 0, index = 0) out vec4 result;
)";

/// The color of the surface, with the texture if there is one.
std::string albedo_part(bool textured) {
  if (!textured) return "vec4 surface_color() { return tint; }\n";
  return R"(
vec4 surface_color() {
  vec4 albedo = tint;
  vec4 texel = texture(surface_texture, texture_place);
  albedo.rgb *= texel.rgb;
  if (alpha_mode == 1) {
    // Sharpened to about one pixel; the samples of the pixel make it smooth.
    albedo.a = clamp((texel.a - 0.5) / max(fwidth(texel.a), 1e-4) + 0.5, 0.0, 1.0);
    if (albedo.a < 0.02) discard;
  } else if (alpha_mode == 2) {
    albedo.a *= texel.a;
  }
  return albedo;
}
)";
}

/// The normal and the finish of the surface, with what images say of them.
std::string detail_part(bool detailed) {
  if (!detailed) {
    return R"(
vec3 shaded_normal(vec3 n) { return n; }
vec2 shaded_finish() { return finish.xy; }
)";
  }
  return R"(
uniform sampler2D normals_map;
uniform sampler2D finish_map;
// Tangents by the derivatives of the texture's coordinates: Schueler, "Normal mapping without precomputed
// tangents", ShaderX 5, 2006.
vec3 shaded_normal(vec3 n) {
  vec3 px = dFdx(point);
  vec3 py = dFdy(point);
  vec2 ux = dFdx(texture_place);
  vec2 uy = dFdy(texture_place);
  vec3 gx = cross(py, n);
  vec3 gy = cross(n, px);
  float side = dot(px, gx) < 0.0 ? -1.0 : 1.0;
  vec3 along_u = side * (gx * ux.x + gy * uy.x);
  vec3 along_v = side * (gx * ux.y + gy * uy.y);
  float longest = max(dot(along_u, along_u), dot(along_v, along_v));
  // 128 of 255 is zero, exactly.
  vec3 map = texture(normals_map, texture_place).xyz * (255.0 / 127.0) - 128.0 / 127.0;
  vec2 across = glass.y * map.xy * inversesqrt(max(longest, 1e-30));
  return normalize(across.x * along_u + across.y * along_v + max(map.z, 0.02) * n);
}
vec2 shaded_finish() {
  vec4 texel = texture(finish_map, texture_place);
  return finish.xy * texel.bg;
}
)";
}

const std::string kSolidFragment = R"(
void main() {
  vec4 albedo = surface_color();
  vec2 made = shaded_finish();
  vec3 n = shaded_normal(normalize(gl_FrontFacing ? surface_normal : -surface_normal));
  vec3 v = normalize(eye.xyz - point);
  vec3 f0 = mix(vec3(0.04), albedo.rgb, made.x);
  Light light = light_at(f0, made.y, n, v, point);
  vec3 color = albedo.rgb * (1.0 - made.x) * light.inner + light.outer;
  result = vec4(shown(with_haze(color, distance(eye.xyz, point))), albedo.a);
}
)";

// Light goes through in the surface's color, less of it where the surface mirrors. What is behind is
// multiplied by `passed` before the surface's own light is added.
const std::string kClearFragment = R"(
layout(location = 0, index = 1) out vec4 passed;
void main() {
  vec4 albedo = surface_color();
  vec2 made = shaded_finish();
  vec3 n = shaded_normal(normalize(gl_FrontFacing ? surface_normal : -surface_normal));
  vec3 v = normalize(eye.xyz - point);
  vec3 f0 = mix(vec3(0.04), albedo.rgb, made.x);
  Light light = light_at(f0, made.y, n, v, point);
  float away = 1.0 - clamp(dot(n, v), 0.0, 1.0);
  float mirrors = 0.04 + 0.96 * away * away * away * away * away;
  vec3 inner = albedo.rgb * (1.0 - made.x) * light.inner * (1.0 - glass.x);
  // Light that entered elsewhere leaves jelly all over its surface, more so where it is thin.
  inner += glass.x * (0.15 + 0.35 * away) * albedo.rgb * albedo.rgb * sky_irradiance(-v);
  vec3 color = tone_mapped(with_haze(inner + light.outer, distance(eye.xyz, point)));
  vec3 stain = mix(vec3(1.0), albedo.rgb, 0.45 + 0.55 * away);
  vec3 share = mix(vec3(1.0), glass.x * (1.0 - mirrors) * stain, albedo.a);
  // The picture holds encoded colors. A product stays one, nearly; a sum is right for a gray of a quarter behind.
  vec3 behind = 0.25 * share;
  result = vec4(encoded(albedo.a * color + behind) - encoded(behind), 1.0);
  passed = vec4(encoded(share), 0.0);
}
)";

// Cloth is lit from both sides: what falls on the far side comes through in the color of the threads. The
// sheen at the rim is that of fibers that stand out (after Estevez and Kulla, "Production friendly microfacet
// sheen BRDF", 2017).
const std::string kClothFragment = R"(
// Threads over and under one another, paler where they shrink to pixels.
float weave(vec2 place, float threads) {
  vec2 t = place * threads;
  vec2 d = fwidth(t);
  float visible = threads > 0.0 ? clamp(1.6 - 2.0 * max(d.x, d.y), 0.0, 1.0) : 0.0;
  vec2 across = abs(fract(t) - 0.5) * 2.0;
  float over = mod(floor(t.x) + floor(t.y), 2.0);
  float height = 1.0 - mix(across.x * across.x, across.y * across.y, over);
  return 1.0 - visible * 0.5 * (1.0 - height);
}
void main() {
  vec4 albedo = surface_color();
  albedo.rgb *= weave(texture_place, finish.w);
  vec2 made = shaded_finish();
  vec3 n = shaded_normal(normalize(gl_FrontFacing ? surface_normal : -surface_normal));
  vec3 v = normalize(eye.xyz - point);
  float n_dot_l = dot(n, sun_direction.xyz);
  float side = n_dot_l < 0.0 ? -1.0 : 1.0;
  float facing = abs(n_dot_l);
  float seen = sky_visibility();
  vec3 sun = sun_color.rgb * facing * sun_visibility(point, side * n, facing) * (0.5 + 0.5 * seen);
  float n_dot_v = clamp(dot(n, v), 0.02, 1.0);
  vec3 through = 0.3 * albedo.rgb;
  vec3 color = albedo.rgb * (irradiance_on(n, 1.0) * seen + (side > 0.0 ? sun : vec3(0.0)));
  color += through * (0.5 * irradiance_on(n, -1.0) * seen + (side > 0.0 ? vec3(0.0) : sun));
  // Smooth threads, such as silk's, shine; rough ones have a rim of light.
  float gloss = side > 0.0 ? 1.0 : 0.0;
  color += gloss * sun * highlight_of(sun_direction.xyz, vec3(0.03), made.y, n, v, facing, n_dot_v);
  float rim = 1.0 - n_dot_v;
  rim *= rim * rim;
  vec3 fibers = mix(vec3(1.0), albedo.rgb, 0.6);
  color += finish.z * rim * fibers * (0.7 * irradiance_on(n, 1.0) * seen + 0.5 * sun);
  int sources = LIGHTS;
  for (int i = 0; i < sources; ++i) {
    Source source = source_at(i, point);
    float toward = dot(n, source.toward);
    float front = toward < 0.0 ? 0.0 : 1.0;
    float lit = abs(toward);
    vec3 strength = source.color * lit * source_visibility(i, point, (2.0 * front - 1.0) * n, source, lit);
    strength *= 0.5 + 0.5 * seen;
    color += mix(through, albedo.rgb, front) * strength + 0.5 * finish.z * rim * fibers * strength;
    color += front * strength * highlight_of(source.toward, vec3(0.03), made.y, n, v, lit, n_dot_v);
  }
  result = vec4(shown(with_haze(color, distance(eye.xyz, point))), albedo.a);
}
)";

// The strands of a rope as a relief on its tube: the texture's u goes once around, v along it in the tube's
// circumferences.
const std::string kRopeFragment = R"(
void main() {
  vec4 albedo = tint;
  float phase = 3.0 * texture_place.x + 1.1 * texture_place.y;
  vec2 d = fwidth(texture_place * vec2(3.0, 1.1));
  float visible = clamp(1.5 - 3.0 * max(d.y, min(d.x, 0.4)), 0.0, 1.0);
  float across = 2.0 * abs(fract(phase) - 0.5);
  float height = sqrt(max(1.0 - across * across, 0.0));
  vec3 n = normalize(surface_normal);
  // Mikkelsen, "Bump mapping unparametrized surfaces on the GPU", 2010. The strands are a third as wide as the
  // rope.
  vec3 px = dFdx(point);
  vec3 py = dFdy(point);
  vec3 gx = cross(py, n);
  vec3 gy = cross(n, px);
  float det = dot(px, gx);
  float bump = visible * finish.w;
  vec3 grad = sign(det) * (dFdx(height) * gx + dFdy(height) * gy) * bump;
  float limit = abs(det) / max(length(grad), 1e-12);
  n = normalize(abs(det) * n - grad * min(1.0, 1.5 * limit));
  albedo.rgb *= mix(1.0, 0.35 + 0.65 * height, visible);
  vec3 v = normalize(eye.xyz - point);
  vec3 f0 = mix(vec3(0.04), albedo.rgb, finish.x);
  Light light = light_at(f0, finish.y, n, v, point);
  vec3 color = albedo.rgb * (1.0 - finish.x) * light.inner + light.outer;
  result = vec4(shown(with_haze(color, distance(eye.xyz, point))), 1.0);
}
)";

// Kajiya and Kay, "Rendering fur with three dimensional textures", 1989; two highlights, the second in the
// hair's color, as of Marschner and others, 2003, in the form of Scheuermann, 2004.
const std::string kHairFragment = R"(
float highlight(vec3 along, vec3 h, float shift, vec3 up, float exponent) {
  float c = dot(normalize(along + shift * up), h);
  return pow(max(1.0 - c * c, 0.0), 0.5 * exponent);
}
void main() {
  vec3 along = normalize(surface_normal);
  vec3 v = normalize(eye.xyz - point);
  vec3 l = sun_direction.xyz;
  // The normal of the strip that faces the eye.
  vec3 n = normalize(v - along * dot(v, along));
  float c = dot(along, l);
  float sine = sqrt(max(1.0 - c * c, 0.0));
  float wrapped = clamp(0.5 + 0.6 * dot(n, l), 0.0, 1.0);
  // u is a number of the strand's own.
  float lot = fract(7.31 * texture_place.x);
  vec3 albedo = tint.rgb * (0.75 + 0.5 * lot);
  vec3 sun = sun_color.rgb * sun_visibility(point, l, 1.0);
  vec3 h = normalize(l + v);
  float white = highlight(along, h, -0.08 + 0.08 * lot, n, 90.0);
  float own = highlight(along, h, 0.12 + 0.12 * lot, n, 24.0);
  float seen = sky_visibility();
  vec3 color = albedo * (0.75 * sky_irradiance(n) * seen + sun * sine * wrapped);
  color += sun * wrapped * (0.16 * white + 0.9 * albedo * own);
  int sources = LIGHTS;
  for (int i = 0; i < sources; ++i) {
    Source source = source_at(i, point);
    vec3 between = normalize(source.toward + v);
    float across = dot(along, source.toward);
    float lit = clamp(0.5 + 0.6 * dot(n, source.toward), 0.0, 1.0);
    vec3 strength = source.color * lit * source_visibility(i, point, source.toward, source, 1.0);
    float pale = highlight(along, between, -0.08 + 0.08 * lot, n, 90.0);
    float colored = highlight(along, between, 0.12 + 0.12 * lot, n, 24.0);
    color += strength * (albedo * sqrt(max(1.0 - across * across, 0.0)) + 0.16 * pale + 0.9 * albedo * colored);
  }
  result = vec4(shown(with_haze(color, distance(eye.xyz, point))), 1.0);
}
)";

std::string instanced_depth_vertex(const std::string& matrix) {
  return shader_version() + frame_part() + mesh_inputs_part() +
         "out vec2 texture_place;\nvoid main() {\n  texture_place = uv;\n  gl_Position = " + matrix +
         " * vec4(world_position(), 1.0);\n}\n";
}

/// Holes are left out, and of what lets light through, so many points as light goes through.
const std::string kHoledDepth = R"(
in vec2 texture_place;
uniform sampler2D surface_texture;
uniform float density;
uniform int has_texture;
void main() {
  float alpha = has_texture != 0 ? texture(surface_texture, texture_place).a : 1.0;
  // An even pattern of four points (Bayer 1973), which the filter of the shadow blurs away.
  ivec2 place = ivec2(gl_FragCoord.xy) & 1;
  float lot = 0.25 * float(place.x == place.y ? place.x : 3 - place.x) + 0.125;
  if (alpha < 0.5 || lot > density) discard;
}
)";

}  // namespace

ShaderSource mesh_shader(MeshLook look, MeshImages images, LitKind kind) {
  // A hair has no surface.
  const bool by_corners = kind.fast && look != MeshLook::kHair;
  std::string fragment = lit_version(kind) + (by_corners ? "#define CORNERS\n" : "") + frame_part() +
                         color_part() + sky_part() + shadow_part() + reflection_part() + kMeshFragmentInputs +
                         albedo_part(images != MeshImages::kNone) + detail_part(images == MeshImages::kAll);
  switch (look) {
    case MeshLook::kSolid:
      fragment += kSolidFragment;
      break;
    case MeshLook::kClear:
      fragment += kClearFragment;
      break;
    case MeshLook::kCloth:
      fragment += kClothFragment;
      break;
    case MeshLook::kRope:
      fragment += kRopeFragment;
      break;
    case MeshLook::kHair:
      fragment += kHairFragment;
      break;
  }
  return {shader_version(by_corners) + frame_part() + sky_part() + corner_part() + mesh_inputs_part() +
              kMeshVertex,
          fragment};
}

ShaderSource depth_shader(DepthFrom from, bool holed) {
  const std::string matrix = from == DepthFrom::kSun ? "shadow_clip" : "view_projection";
  return {instanced_depth_vertex(matrix), shader_version() + (holed ? kHoledDepth : "void main() {}\n")};
}

}  // namespace hooke::render

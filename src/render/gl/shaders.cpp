#include "render/gl/shaders.h"

namespace hooke::render {

namespace {

const std::string kVersion = "#version 330 core\n";

const std::string kFrame = R"(
layout(std140) uniform Frame {
  mat4 view_projection;
  mat4 shadow_matrix;
  mat4 shadow_clip;
  vec4 eye;           // w: near distance
  vec4 ray_right;     // half the picture's width at distance 1
  vec4 ray_up;
  vec4 ray_forward;
  vec4 sun_direction;
  vec4 sun_color;     // linear, times intensity
  vec4 zenith;        // linear
  vec4 horizon;       // linear
  vec4 sky_light;     // ambient light from above
  vec4 ground_light;  // ambient light from below
  vec4 shadow_info;   // texel [m], map size, 1 if there is a map, fog distance [m]
  vec4 viewport;      // width, height [px]
};
)";

const std::string kColor = R"(
// Straight up to 0.6, then a soft shoulder that ends at 1: bright colors keep their hue, highlights do not clip.
vec3 tone_mapped(vec3 color) {
  vec3 over = max(color - 0.6, 0.0);
  return min(color, 0.6) + 0.4 * (1.0 - exp(-over / 0.4));
}
vec3 with_fog(vec3 color, float distance_to_eye) {
  float x = distance_to_eye / shadow_info.w;
  return mix(color, horizon.rgb, 1.0 - exp(-x * x));
}
)";

const std::string kLighting = R"(
uniform sampler2DShadow shadow_map;

// How much of the sun reaches a point: a 3 x 3 tent from four bilinear taps (Castano, "Shadow mapping summary",
// 2013). The point is moved along the normal by what the filter reaches over, more at grazing light, so that a
// surface does not shadow itself.
float sun_visibility(vec3 point, vec3 normal, float n_dot_l) {
  float slope = sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0));
  vec3 moved = point + normal * shadow_info.x * (0.5 + 1.6 * slope);
  vec3 place = (shadow_matrix * vec4(moved, 1.0)).xyz;
  bool inside = all(greaterThan(place.xy, vec2(0.0))) && all(lessThan(place.xy, vec2(1.0)));

  float size = shadow_info.y;
  vec2 texel = place.xy * size;
  vec2 base = floor(texel + 0.5);
  vec2 part = texel + 0.5 - base;
  base -= 0.5;
  vec2 w0 = 3.0 - 2.0 * part;
  vec2 w1 = 1.0 + 2.0 * part;
  vec2 p0 = (base + (2.0 - part) / w0 - 1.0) / size;
  vec2 p1 = (base + part / w1 + 1.0) / size;
  float depth = min(place.z, 1.0);
  // A loop that may run zero times: software drivers compute both sides of an if, but leave a loop.
  float sum = 0.0;
  int rows = n_dot_l > 0.0 && inside && shadow_info.z > 0.5 ? 2 : 0;
  for (int row = 0; row < rows; ++row) {
    float y = row == 0 ? p0.y : p1.y;
    sum += (row == 0 ? w0.y : w1.y) * (w0.x * texture(shadow_map, vec3(p0.x, y, depth)) +
                                       w1.x * texture(shadow_map, vec3(p1.x, y, depth)));
  }
  return rows > 0 ? sum / 16.0 : 1.0;
}

vec3 lit(vec3 albedo, vec3 normal, vec3 point, vec2 gloss) {
  vec3 to_eye = normalize(eye.xyz - point);
  float n_dot_l = dot(normal, sun_direction.xyz);
  vec3 light = mix(ground_light.rgb, sky_light.rgb, 0.5 + 0.5 * normal.y);
  // The sky is brighter around the sun, which keeps folds readable where the sun itself does not reach.
  light *= 0.875 + 0.275 * n_dot_l;
  vec3 color = albedo * light;
  // Towards the light the highlight starts softly, so that it has no edge where the light ends.
  float facing = clamp(n_dot_l, 0.0, 1.0);
  vec3 sun = sun_color.rgb * sun_visibility(point, normal, n_dot_l);
  float n_dot_h = max(dot(normal, normalize(sun_direction.xyz + to_eye)), 0.0);
  color += sun * (albedo * facing + gloss.y * min(8.0 * facing, 1.0) * pow(n_dot_h, gloss.x));
  // At grazing angles every surface mirrors some sky.
  float grazing = 1.0 - clamp(dot(normal, to_eye), 0.0, 1.0);
  float squared = grazing * grazing;
  color += 0.35 * gloss.y * squared * squared * sky_light.rgb;
  return color;
}
)";

const std::string kMeshInputs = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 row_x;  // the affine matrix by rows
layout(location = 4) in vec4 row_y;
layout(location = 5) in vec4 row_z;
layout(location = 6) in vec4 color;  // linear, alpha is the opacity
layout(location = 7) in vec2 gloss;  // exponent, strength
vec3 world_position() {
  vec4 p = vec4(position, 1.0);
  return vec3(dot(row_x, p), dot(row_y, p), dot(row_z, p));
}
)";

}  // namespace

ShaderSource mesh_shader() {
  return {kVersion + kFrame + kMeshInputs + R"(
out vec3 point;
out vec3 surface_normal;
out vec2 texture_place;
flat out vec4 tint;
flat out vec2 shine;
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
  shine = gloss;
  gl_Position = view_projection * vec4(point, 1.0);
}
)",
          kVersion + kFrame + kColor + kLighting + R"(
in vec3 point;
in vec3 surface_normal;
in vec2 texture_place;
flat in vec4 tint;
flat in vec2 shine;
uniform sampler2D surface_texture;
uniform int has_texture;
uniform int alpha_mode;  // AlphaMode
out vec4 result;
void main() {
  vec4 albedo = tint;
  if (has_texture != 0) {
    vec4 texel = texture(surface_texture, texture_place);
    albedo.rgb *= texel.rgb;
    if (alpha_mode == 1) {
      // Sharpened to about one pixel; the samples of the pixel make it smooth.
      albedo.a = clamp((texel.a - 0.5) / max(fwidth(texel.a), 1e-4) + 0.5, 0.0, 1.0);
      if (albedo.a < 0.02) discard;
    } else if (alpha_mode == 2) {
      albedo.a *= texel.a;
    }
  }
  vec3 n = normalize(gl_FrontFacing ? surface_normal : -surface_normal);
  vec3 color = lit(albedo.rgb, n, point, shine);
  result = vec4(tone_mapped(with_fog(color, distance(eye.xyz, point))), alpha_mode == 0 ? 1.0 : albedo.a);
}
)"};
}

ShaderSource shadow_shader() {
  return {kVersion + kFrame + kMeshInputs + R"(
void main() { gl_Position = shadow_clip * vec4(world_position(), 1.0); }
)",
          kVersion + "void main() {}\n"};
}

ShaderSource cutout_shadow_shader() {
  return {kVersion + kFrame + kMeshInputs + R"(
out vec2 texture_place;
void main() {
  texture_place = uv;
  gl_Position = shadow_clip * vec4(world_position(), 1.0);
}
)",
          kVersion + R"(
in vec2 texture_place;
uniform sampler2D surface_texture;
void main() {
  if (texture(surface_texture, texture_place).a < 0.5) discard;
}
)"};
}

ShaderSource ground_shader() {
  return {kVersion + kFrame + R"(
layout(location = 0) in vec3 position;
uniform vec4 plane;  // center x, height, center z, scale of the mesh
void main() {
  vec3 world = vec3(plane.x, plane.y, plane.z) + plane.w * position;
  gl_Position = view_projection * vec4(world, 1.0);
}
)",
          kVersion + kFrame + kColor + kLighting + R"(
uniform vec4 plane;
uniform vec4 ground_color;  // linear
uniform vec4 grid_color;    // w: spacing [m], 0 is none
uniform vec2 grid_origin;
out vec4 result;

// Share of lines of a width (in cells) over a pixel of size `d` (in cells). Thinner than a pixel they become
// paler instead of breaking up; as cells shrink to pixels only their mean stays.
float grid_cover(vec2 p, vec2 d, float width) {
  vec2 drawn = clamp(vec2(width), d, vec2(0.5));
  vec2 away = abs(fract(p - 0.5) - 0.5);
  vec2 soft = 0.75 * d + 1e-5;
  vec2 line = 1.0 - smoothstep(0.5 * drawn - soft, 0.5 * drawn + soft, away);
  line *= clamp(width / drawn, 0.0, 1.0);
  line = mix(line, vec2(width), clamp(2.0 * d - 0.6, 0.0, 1.0));
  return mix(line.x, 1.0, line.y);
}

void main() {
  // The point is the ray's, not the triangle's: exact however large the triangle is.
  vec2 screen = 2.0 * gl_FragCoord.xy / viewport.xy - 1.0;
  vec3 ray = ray_forward.xyz + screen.x * ray_right.xyz + screen.y * ray_up.xyz;
  float along = (plane.y - eye.y) / min(ray.y, -1e-6);
  vec3 point = eye.xyz + along * ray;
  float far = along * length(ray);
  vec3 albedo = ground_color.rgb;
  if (grid_color.w > 0.0) {
    vec2 p = (point.xz - grid_origin) / grid_color.w;
    // Size of a pixel on the plane along x and z.
    vec2 d = max(max(abs(dFdx(p)), abs(dFdy(p))), 1e-6);
    float cover = 0.55 * grid_cover(p, d, 0.014);
    cover = max(cover, grid_cover(0.1 * p, 0.1 * d, 0.003));
    albedo = mix(albedo, grid_color.rgb, cover * exp(-far / (0.35 * shadow_info.w)));
  }
  vec3 color = lit(albedo, vec3(0.0, 1.0, 0.0), point, vec2(8.0, 0.0));
  result = vec4(tone_mapped(with_fog(color, far)), 1.0);
}
)"};
}

ShaderSource sky_shader() {
  return {kVersion + kFrame + R"(
out vec3 ray;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  ray = ray_forward.xyz + corner.x * ray_right.xyz + corner.y * ray_up.xyz;
  gl_Position = vec4(corner, 1.0, 1.0);
}
)",
          kVersion + kFrame + kColor + R"(
in vec3 ray;
out vec4 result;
void main() {
  float height = max(normalize(ray).y, 0.0);
  vec3 color = mix(horizon.rgb, zenith.rgb, 1.0 - exp(-3.0 * height));
  result = vec4(tone_mapped(color), 1.0);
}
)"};
}

ShaderSource line_shader() {
  return {kVersion + kFrame + R"(
layout(location = 0) in vec4 from;   // w: width [px]
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 color;  // linear
flat out vec4 tint;
void main() {
  tint = color;
  vec4 a = view_projection * vec4(from.xyz, 1.0);
  vec4 b = view_projection * vec4(to, 1.0);
  // The part behind the eye has no place on the screen: cut at the near plane.
  float near = eye.w;
  if (a.w < near && b.w < near) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  if (a.w < near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * viewport.xy;
  along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1.0, 0.0);
  int corner = gl_VertexID;
  vec4 end = (corner & 1) == 0 ? a : b;
  float side = corner < 2 ? -1.0 : 1.0;
  vec2 offset = side * vec2(-along.y, along.x) * from.w / viewport.xy;
  // A little toward the eye, so that a line on a surface stays visible.
  gl_Position = vec4(end.xy + offset * end.w, end.z - 1e-4 * end.w, end.w);
}
)",
          kVersion + R"(
flat in vec4 tint;
out vec4 result;
void main() { result = tint; }
)"};
}

ShaderSource text_shader() {
  return {kVersion + kFrame + R"(
layout(location = 0) in vec2 place;
layout(location = 1) in vec3 color;
flat out vec3 tint;
void main() {
  tint = color;
  gl_Position = vec4(2.0 * place.x / viewport.x - 1.0, 1.0 - 2.0 * place.y / viewport.y, 0.0, 1.0);
}
)",
          kVersion + R"(
flat in vec3 tint;
out vec4 result;
void main() { result = vec4(tint, 1.0); }
)"};
}

ShaderSource present_shader() {
  return {kVersion + R"(
out vec2 place;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  place = 0.5 + 0.5 * corner;
  gl_Position = vec4(corner, 0.0, 1.0);
}
)",
          kVersion + R"(
in vec2 place;
uniform sampler2D picture;
out vec4 result;
// Reading the picture decodes sRGB; the window wants it encoded.
void main() {
  vec3 c = texture(picture, place).rgb;
  vec3 low = 12.92 * c;
  vec3 high = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
  result = vec4(mix(high, low, vec3(lessThan(c, vec3(0.0031308)))), 1.0);
}
)"};
}

}  // namespace hooke::render

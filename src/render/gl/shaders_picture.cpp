#include "render/gl/shader_parts.h"
#include "render/gl/shaders.h"

namespace hooke::render {

namespace {

const std::string kGroundVertex = R"(
layout(location = 0) in vec3 position;
uniform vec4 plane;  // center x, height, center z, scale of the mesh
void main() {
  vec3 world = vec3(plane.x, plane.y, plane.z) + plane.w * position;
  gl_Position = view_projection * vec4(world, 1.0);
}
)";

const std::string kGroundFragment = R"(
uniform vec4 plane;
uniform vec4 ground_color;  // linear
uniform vec4 grid_color;    // w: spacing [m], 0 is none
uniform vec2 grid_origin;
uniform sampler2D noise_map;
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
  vec2 from_grid = point.xz - grid_origin;
  vec3 albedo = ground_color.rgb;
#ifndef FAST
  // Uneven like a real floor: fine grain near by, large patches far away.
  float grain = texture(noise_map, 1.7 * from_grid).r + texture(noise_map, 0.045 * from_grid).r;
  albedo *= 1.0 + 0.09 * (grain - 1.0);
#endif
  if (grid_color.w > 0.0) {
    vec2 p = from_grid / grid_color.w;
    // Size of a pixel on the plane along x and z.
    vec2 d = max(max(abs(dFdx(p)), abs(dFdy(p))), 1e-6);
    albedo = mix(albedo, grid_color.rgb, grid_cover(p, d, 0.012));
  }
  float seen = sky_visibility();
  vec3 n = vec3(0.0, 1.0, 0.0);
  float facing = clamp(sun_direction.y, 0.0, 1.0);
  vec3 sun = sun_color.rgb * facing * sun_visibility(point, n, sun_direction.y) * (0.6 + 0.4 * seen);
  vec3 color = albedo * (sky_irradiance(n) * seen + sun);
  int sources = LIGHTS;
  for (int i = 0; i < sources; ++i) {
    Source source = source_at(i, point);
    float toward = clamp(source.toward.y, 0.0, 1.0);
    color += albedo * source.color * toward * source_visibility(i, point, n, source, toward) * (0.6 + 0.4 * seen);
  }
  // At grazing angles even a rough floor mirrors some sky.
  float away = 1.0 - clamp(-ray.y / length(ray), 0.0, 1.0);
  away *= away;
  color += 0.10 * away * away * horizon.rgb * seen;
  result = vec4(shown(with_haze(color, far)), 1.0);
}
)";

const std::string kSkyFragment = R"(
in vec3 ray;
uniform sampler2D noise_map;
out vec4 result;
void main() {
  vec3 way = normalize(ray);
  vec3 color = sky_radiance(way);
  // Thin clouds on a plane high above, fewer toward the horizon.
  float up = max(way.y, 0.0);
  vec2 place = 0.22 * way.xz / (up + 0.12);
#ifdef FAST
  float thickness = textureLod(noise_map, place, 0.0).r;
#else
  float thickness = 0.65 * texture(noise_map, place).r + 0.35 * texture(noise_map, 3.1 * place + 0.37).r;
#endif
  float cover = smoothstep(0.9 - 0.75 * horizon.w, 1.25 - 0.75 * horizon.w, thickness + 0.2);
  vec3 cloud = 0.2 * sun_color.rgb + 0.65 * horizon.rgb;
  color = mix(color, cloud, 0.8 * cover * smoothstep(0.0, 0.22, up));
  result = vec4(shown(color), 1.0);
}
)";

// How much of the sky each point sees, from depths near by: McGuire and others, "Scalable ambient
// obscurance", 2012. Normals come from the nearer neighbor on each side, so that rims get no false ones.
const std::string kOcclusionFragment = R"(
in vec2 place;
uniform sampler2D depth_map;
uniform vec4 half_pixel;  // size of a pixel of the map, and taps, and pixels at distance 1 for a length of 1
out vec2 result;

float distance_at(vec2 where) {
  return eye.w / max(1.0 - textureLod(depth_map, where, 0.0).r, 1e-6);
}
vec3 point_at(vec2 where, float along) {
  vec2 screen = 2.0 * where - 1.0;
  return along * (ray_forward.xyz + screen.x * ray_right.xyz + screen.y * ray_up.xyz);
}
void main() {
  vec2 dx = vec2(half_pixel.x, 0.0);
  vec2 dy = vec2(0.0, half_pixel.y);
  float d = distance_at(place);
  float left = distance_at(place - dx);
  float right = distance_at(place + dx);
  float low = distance_at(place - dy);
  float high = distance_at(place + dy);
  vec3 p = point_at(place, d);
  vec3 along_x = abs(left - d) < abs(right - d) ? p - point_at(place - dx, left) : point_at(place + dx, right) - p;
  vec3 along_y = abs(low - d) < abs(high - d) ? p - point_at(place - dy, low) : point_at(place + dy, high) - p;
  vec3 n = normalize(cross(along_x, along_y));
  float radius = viewport.z;
  float reach = min(radius * half_pixel.w / d, 60.0);
  // Beyond this the sky is seen by all.
  int taps = reach > 1.5 && d < 400.0 * radius ? int(half_pixel.z) : 0;
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  vec2 way = vec2(cos(turn), sin(turn));
  const mat2 golden_turn = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);
  float sum = 0.0;
  float bias = 0.01 * radius + 0.002 * d;
  for (int i = 0; i < taps; ++i) {
    float part = (float(i) + 0.5) / float(taps);
    vec2 where = place + part * reach * half_pixel.xy * way;
    way = golden_turn * way;
    vec3 to = point_at(where, distance_at(where)) - p;
    float vv = dot(to, to);
    float f = max(1.0 - vv / (radius * radius), 0.0);
    sum += f * f * max(dot(to, n) - bias, 0.0) * inversesqrt(vv + 1e-4 * radius * radius);
  }
  result = vec2(max(1.0 - 5.0 * sum / max(float(taps), 1.0), 0.0), d / (d + 16.0 * radius));
}
)";

// The mean over the pixels around that are about as far away: four taps between pixels, which weigh four
// each.
const std::string kOcclusionBlurFragment = R"(
in vec2 place;
uniform sampler2D picture;
uniform vec2 step_over;  // one pixel along x and y
out vec2 result;
void main() {
  vec2 middle = textureLod(picture, place, 0.0).rg;
  vec2 sum = vec2(middle.r, 1.0);
  for (int i = 0; i < 4; ++i) {
    vec2 corner = vec2((i & 1) == 0 ? -1.0 : 1.0, (i & 2) == 0 ? -1.0 : 1.0);
    vec2 other = textureLod(picture, place + corner * vec2(1.5, 1.5) * step_over, 0.0).rg;
    float weight = clamp(2.0 - 60.0 * abs(other.g - middle.g), 0.0, 1.0);
    sum += weight * vec2(other.r, 1.0);
  }
  result = vec2(sum.x / sum.y, middle.g);
}
)";

const std::string kPictureVertex = R"(
out vec2 place;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  place = 0.5 + 0.5 * corner;
  gl_Position = vec4(corner, 1.0, 1.0);  // behind everything
}
)";

}  // namespace

ShaderSource ground_shader(LitKind kind) {
  return {shader_version() + frame_part() + kGroundVertex, lit_version(kind) + frame_part() + color_part() +
                                                               sky_part() + shadow_part() +
                                                               reflection_part() + kGroundFragment};
}

ShaderSource ground_depth_shader() {
  return {shader_version() + frame_part() + kGroundVertex, shader_version() + "void main() {}\n"};
}

ShaderSource sky_shader(bool fast) {
  return {shader_version() + frame_part() + R"(
out vec3 ray;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  ray = ray_forward.xyz + corner.x * ray_right.xyz + corner.y * ray_up.xyz;
  gl_Position = vec4(corner, 1.0, 1.0);
}
)",
          shader_version(fast) + frame_part() + color_part() + sky_part() + kSkyFragment};
}

ShaderSource occlusion_shader() {
  return {shader_version() + kPictureVertex, shader_version() + frame_part() + kOcclusionFragment};
}

ShaderSource occlusion_blur_shader() {
  return {shader_version() + kPictureVertex, shader_version() + kOcclusionBlurFragment};
}

ShaderSource line_shader() {
  return {shader_version() + frame_part() + color_part() + R"(
layout(location = 0) in vec4 from;   // w: width [px]
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 color;  // linear
flat out vec4 tint;
void main() {
  tint = vec4(encoded(color.rgb), color.a);
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
          shader_version() + R"(
flat in vec4 tint;
out vec4 result;
void main() { result = tint; }
)"};
}

ShaderSource text_shader() {
  return {shader_version() + frame_part() + color_part() + R"(
layout(location = 0) in vec2 place;
layout(location = 1) in vec3 color;
flat out vec3 tint;
void main() {
  tint = encoded(color);
  gl_Position = vec4(2.0 * place.x / viewport.x - 1.0, 1.0 - 2.0 * place.y / viewport.y, 0.0, 1.0);
}
)",
          shader_version() + R"(
flat in vec3 tint;
out vec4 result;
void main() { result = vec4(tint, 1.0); }
)"};
}

ShaderSource present_shader() {
  return {shader_version() + kPictureVertex, shader_version() + R"(
in vec2 place;
uniform sampler2D picture;
out vec4 result;
void main() { result = vec4(textureLod(picture, place, 0.0).rgb, 1.0); }
)"};
}

}  // namespace hooke::render

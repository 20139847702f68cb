#include "io/motion/motion_usda_looks.h"

#include "io/motion/motion_names.h"

#include <array>
#include <cmath>
#include <numbers>

namespace hooke::io {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLampRadius = 0.02;  ///< Of the ball that a point light of USD is [m].

/// A Texture is one image of a material, each of whose numbers x is read as scale x + bias.
struct Texture {
  const char* name;
  const std::string& file;
  const char* color_space;
  std::array<double, 4> scale = {1, 1, 1, 1};
  std::array<double, 4> bias = {0, 0, 0, 0};
};

std::string text_of(const std::array<double, 4>& v) {
  return "(" + usda_number(v[0]) + ", " + usda_number(v[1]) + ", " + usda_number(v[2]) + ", " +
         usda_number(v[3]) + ")";
}

void put_texture(UsdaText& text, const std::string& path, const Texture& texture) {
  if (texture.file.empty()) return;
  text.begin("def Shader \"" + std::string(texture.name) + "\"");
  text.line("uniform token info:id = \"UsdUVTexture\"");
  text.line("asset inputs:file = @./" + texture.file + "@");
  text.line("float4 inputs:scale = " + text_of(texture.scale));
  if (texture.bias != std::array<double, 4>{}) text.line("float4 inputs:bias = " + text_of(texture.bias));
  text.line("token inputs:sourceColorSpace = \"" + std::string(texture.color_space) + "\"");
  text.line("float2 inputs:st.connect = <" + path + "/reader.outputs:result>");
  text.line("token inputs:wrapS = \"repeat\"");
  text.line("token inputs:wrapT = \"repeat\"");
  for (const char* output : {"float outputs:r", "float outputs:g", "float outputs:b", "float outputs:a"})
    text.line(output);
  text.line("float3 outputs:rgb");
  text.end();
}

DVec3 color_of(const std::array<float, 3>& c) {
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

void put_surface(UsdaText& text, const MotionMaterial& material, const std::string& path,
                 const MaterialImages& images) {
  text.line("token outputs:surface.connect = <" + path + "/surface.outputs:surface>");
  text.begin("def Shader \"surface\"");
  text.line("uniform token info:id = \"UsdPreviewSurface\"");
  if (images.color.empty()) {
    text.line("color3f inputs:diffuseColor = " + usda_vector(color_of(material.color)));
  } else {
    text.line("color3f inputs:diffuseColor.connect = <" + path + "/image.outputs:rgb>");
  }
  if (images.roughness.empty()) {
    text.line("float inputs:metallic = " + usda_number(static_cast<double>(material.metalness)));
    text.line("float inputs:roughness = " + usda_number(static_cast<double>(roughness_of(material))));
  } else {
    text.line("float inputs:metallic.connect = <" + path + "/finish.outputs:b>");
    text.line("float inputs:roughness.connect = <" + path + "/finish.outputs:g>");
  }
  if (!images.normals.empty()) {
    text.line("normal3f inputs:normal.connect = <" + path + "/normals.outputs:rgb>");
  }
  if (material.cutout && !images.color.empty()) {
    text.line("float inputs:opacity.connect = <" + path + "/image.outputs:a>");
    text.line("float inputs:opacityThreshold = 0.5");
  } else {
    // A preview surface knows no transmission: what lets light through is seen through.
    const double closed = 1 - static_cast<double>(material.transmission);
    text.line("float inputs:opacity = " + usda_number(closed * static_cast<double>(material.opacity)));
  }
  text.line("token outputs:surface");
  text.end();
}

/// Writes the attributes of a light at a place, whose light goes in a direction. `intensity` counts whatever
/// the size of the light (normalize).
void put_light(UsdaText& text, const MotionLight& light, double intensity) {
  text.line("color3f inputs:color = " + usda_vector(color_of(light.color)));
  text.line("float inputs:intensity = " + usda_number(intensity));
  text.line("bool inputs:normalize = 1");
  if (!light.shadows) text.line("bool inputs:shadow:enable = 0");
  if (light.kind != MotionLight::Kind::kDirectional) {
    text.line("float inputs:radius = " + usda_number(kLampRadius));
    text.line("bool treatAsPoint = 1");
    text.line("double3 xformOp:translate = " + usda_vector(light.position));
  }
  if (light.kind == MotionLight::Kind::kSpot) {
    const double outer = static_cast<double>(light.outer_angle);
    text.line("float inputs:shaping:cone:angle = " + usda_number(outer * 180 / kPi));
    text.line("float inputs:shaping:cone:softness = " +
              usda_number(1 - static_cast<double>(light.inner_angle) / outer));
  }
  const Quaternion<double> q = rotation_of_light(light.direction);
  text.line("quatd xformOp:orient = " + text_of({q.w, q.x, q.y, q.z}));
  text.line(light.kind == MotionLight::Kind::kDirectional
                ? "uniform token[] xformOpOrder = [\"xformOp:orient\"]"
                : "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]");
}

}  // namespace

void put_shaders(UsdaText& text, const MotionMaterial& material, const std::string& path,
                 const MaterialImages& images) {
  put_surface(text, material, path, images);
  if (!has_images(material)) return;
  text.begin("def Shader \"reader\"");
  text.line("uniform token info:id = \"UsdPrimvarReader_float2\"");
  text.line("string inputs:varname = \"st\"");
  text.line("float2 outputs:result");
  text.end();
  const DVec3 color = color_of(material.color);
  const double relief = static_cast<double>(material.normal_scale);
  put_texture(text, path, {"image", images.color, "sRGB", {color.x, color.y, color.z, 1}});
  put_texture(text, path,
              {"normals", images.normals, "raw", {2 * relief, 2 * relief, 2, 1}, {-relief, -relief, -1, 0}});
  put_texture(text, path,
              {"finish",
               images.roughness,
               "raw",
               {1, static_cast<double>(roughness_of(material)), static_cast<double>(material.metalness), 1}});
}

// A white matte surface of luminance L has an illuminance of pi L. A ball whose intensity is shared out over
// its surface of 4 pi r^2 gives a quarter of it as illuminance at 1 m.
void put_lights(UsdaText& text, const MotionData& data) {
  if (data.lights.empty() && !data.sky) return;
  NameBook book(NameStyle::kIdentifier);
  text.begin("def Scope \"Lights\"");
  if (data.sky) {
    text.begin("def DomeLight \"" + book.take("sky", "sky") + "\"");
    text.line("color3f inputs:color = " + usda_vector(color_of(*data.sky)));
    text.line("float inputs:intensity = 1");
    text.end();
  }
  for (const MotionLight& light : data.lights) {
    const bool is_far = light.kind == MotionLight::Kind::kDirectional;
    const bool is_spot = light.kind == MotionLight::Kind::kSpot;
    std::string schemas = is_spot ? "\"ShapingAPI\"" : "";
    if (!light.shadows) schemas += std::string(schemas.empty() ? "" : ", ") + "\"ShadowAPI\"";
    std::vector<std::string> metadata;
    if (!schemas.empty()) metadata.push_back("prepend apiSchemas = [" + schemas + "]");
    text.begin(
        (is_far ? "def DistantLight \"" : "def SphereLight \"") + book.take(light.name, "light") + "\"",
        metadata);
    put_light(text, light, (is_far ? kPi : 4 * kPi) * static_cast<double>(light.strength));
    text.end();
  }
  text.end();
}

}  // namespace hooke::io

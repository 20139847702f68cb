#include "io/model/model_write.h"

#include <array>
#include <charconv>
#include <map>

namespace hooke::io {

namespace {

/// Appends the shortest text that reads back as the same float, whatever the locale.
void append(std::string& text, float value) {
  std::array<char, 32> buffer = {};
  text += ' ';
  text.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr);
}

/// Writes each different tuple once and returns its number, which starts at 1.
template <std::size_t kSize>
class Lines {
 public:
  explicit Lines(std::string_view keyword) : keyword_(keyword) {}

  std::size_t number_of(const std::array<float, kSize>& tuple) {
    const auto [entry, is_new] = numbers_.try_emplace(tuple, numbers_.size() + 1);
    if (is_new) {
      text_ += keyword_;
      for (const float value : tuple) append(text_, value);
      text_ += '\n';
    }
    return entry->second;
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string_view keyword_;
  std::string text_;
  std::map<std::array<float, kSize>, std::size_t> numbers_;
};

std::string write_mtl(const Model& model, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    const ModelMaterial& material = model.materials[m];
    text += "newmtl " + names[m] + "\nKd";
    for (const float channel : material.color) append(text, srgb_of_linear(channel));
    text += "\nKs 0.2 0.2 0.2\nNs";
    append(text, material.shininess);
    text += "\nd";
    append(text, material.opacity);
    text += '\n';
    if (const std::string image = image_name(material); !image.empty()) text += "map_Kd " + image + "\n";
    text += '\n';
  }
  return text;
}

}  // namespace

ObjText write_obj(const Model& model, std::string_view library) {
  const std::vector<std::string> names = plain_material_names(model, 64);
  const bool with_uvs = has_uvs(model);
  Lines<3> positions("v");
  Lines<2> uvs("vt");
  Lines<3> normals("vn");
  std::vector<std::string> corner_of;
  corner_of.reserve(model.vertices.size());
  for (const ModelVertex& vertex : model.vertices) {
    std::string corner = ' ' + std::to_string(positions.number_of(vertex.position)) + '/';
    if (with_uvs) corner += std::to_string(uvs.number_of(vertex.uv));
    corner_of.push_back(corner + '/' + std::to_string(normals.number_of(vertex.normal)));
  }
  std::string faces;
  for (const ModelPart& part : model.parts) {
    faces += "usemtl " + names[part.material] + "\n";
    for (std::uint32_t i = part.first; i < part.first + part.count; i += 3) {
      faces += 'f';
      for (std::uint32_t k = i; k < i + 3; ++k) faces += corner_of[model.indices[k]];
      faces += '\n';
    }
  }
  return {.obj = "# meters, y up\nmtllib " + std::string(library) + "\no model\n" + positions.text() +
                 uvs.text() + normals.text() + faces,
          .mtl = write_mtl(model, names)};
}

}  // namespace hooke::io

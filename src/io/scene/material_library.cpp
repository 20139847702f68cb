#include "io/scene/material_library.h"

#include "hooke/scene_io.h"

#include "io/json/json_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace hooke::io {

namespace {

/// What `friction` is where no figure is known, as in ContactDesc.
constexpr double kUnknownFriction = 0.5;

struct MaterialLibrary {
  std::map<std::string, JsonNode> materials;  ///< By name; without their sources.
  JsonNode pairs;
};

JsonNode without_source(const JsonNode& record) {
  JsonNode result = record;
  std::erase_if(result.children, [](const JsonNode& child) { return child.key == "source"; });
  return result;
}

MaterialLibrary read_library() {
  MaterialLibrary library;
  const MaterialTexts texts = material_texts();
  for (const char* text : {texts.solids, texts.sheets, texts.ropes}) {
    JsonDocument document;
    static_cast<void>(parse_json(text, "materials", document));
    for (const JsonNode& record : document.root.children)
      library.materials.emplace(record.key, without_source(record));
  }
  JsonDocument document;
  static_cast<void>(parse_json(texts.pairs, "materials", document));
  library.pairs = document.root;
  return library;
}

const MaterialLibrary& library() {
  static const MaterialLibrary made = read_library();
  return made;
}

const JsonNode* find_record(const std::string& name) {
  const auto found = library().materials.find(name);
  return found == library().materials.end() ? nullptr : &found->second;
}

std::string text_of(const JsonNode& object, std::string_view key) {
  const JsonNode* child = object.find(key);
  return child != nullptr && child->kind == JsonNode::Kind::kString ? child->text : std::string();
}

double number_of(const JsonNode& object, std::string_view key, double fallback) {
  const JsonNode* child = object.find(key);
  return child != nullptr && child->kind == JsonNode::Kind::kNumber ? child->number : fallback;
}

void move_to(JsonNode& node, std::uint32_t offset) {
  node.offset = offset;
  node.key_offset = offset;
  for (JsonNode& child : node.children) move_to(child, offset);
}

/// Adds a copy of `value` under `key`, which stands at `offset`, unless the object has that key.
void add_missing(JsonNode& object, std::string_view key, const JsonNode& value, std::uint32_t offset) {
  if (object.find(key) != nullptr) return;
  move_to(object.add(key, value), offset);
}

/// Calls `act` with each list of objects of one kind: those of the scene, and those that its timeline adds.
template <class Act>
void for_each_object(JsonNode& root, std::string_view kind, const Act& act) {
  const auto in = [&](JsonNode& objects) {
    JsonNode* list = objects.find(kind);
    if (list == nullptr || list->kind != JsonNode::Kind::kArray) return;
    for (JsonNode& object : list->children)
      if (object.kind == JsonNode::Kind::kObject) act(object);
  };
  in(root);
  JsonNode* timeline = root.find("timeline");
  if (timeline == nullptr) return;
  for (JsonNode& event : timeline->children)
    if (JsonNode* added = event.find("add"); added != nullptr) in(*added);
}

/// Returns the parts of a body's shape, or null.
JsonNode* parts_of(JsonNode& body) {
  JsonNode* shape = body.find("shape");
  JsonNode* parts = shape != nullptr ? shape->find("parts") : nullptr;
  return parts != nullptr && parts->kind == JsonNode::Kind::kArray ? parts : nullptr;
}

/// Takes the materials of one scene from the library.
class Taking {
 public:
  explicit Taking(JsonNode& root) : root_(root) {}

  void run() {
    complete_own();
    for (const std::string_view kind : {"bodies", "ropes", "cloths", "solids", "particles"}) {
      for_each_object(root_, kind, [&](JsonNode& object) {
        use(object, "material");
        if (JsonNode* parts = parts_of(object); parts != nullptr)
          for (JsonNode& part : parts->children) use(part, "material");
      });
    }
    if (JsonNode* pairs = root_.find("material_pairs"); pairs != nullptr) {
      for (JsonNode& pair : pairs->children) {
        use(pair, "a");
        use(pair, "b");
      }
    }
    for_each_object(root_, "bodies", [&](JsonNode& body) { give_body(body); });
    for_each_object(root_, "ropes", [&](JsonNode& rope) { give_rope(rope); });
    for_each_object(root_, "cloths", [&](JsonNode& cloth) { give_cloth(cloth); });
    for_each_object(root_, "solids", [&](JsonNode& solid) { give_solid(solid); });
    add_pairs();
  }

 private:
  /// Completes materials that are like one of the library.
  void complete_own() {
    JsonNode* materials = root_.find("materials");
    if (materials == nullptr || materials->kind != JsonNode::Kind::kObject) return;
    for (JsonNode& material : materials->children) {
      if (material.kind != JsonNode::Kind::kObject) continue;
      const std::string like = text_of(material, "like");
      const JsonNode* record = find_record(like);
      if (record == nullptr) continue;
      if (material.find("friction") == nullptr && material.find("static_friction") == nullptr)
        bases_[material.key] = like;
      const std::uint32_t offset = material.find("like")->offset;
      // Static friction of the library is meant for its own friction.
      const bool has_friction = material.find("friction") != nullptr;
      for (const JsonNode& value : record->children)
        if (!has_friction || value.key != "static_friction") add_missing(material, value.key, value, offset);
    }
  }

  /// Adds a material that an object names and the scene does not say.
  void use(const JsonNode& object, std::string_view key) {
    const std::string name = text_of(object, key);
    const JsonNode* record = find_record(name);
    if (record == nullptr) return;
    JsonNode* materials = root_.find("materials");
    if (materials != nullptr && materials->kind != JsonNode::Kind::kObject) return;
    if (materials != nullptr && materials->find(name) != nullptr) return;
    const std::uint32_t offset = object.find(key)->offset;
    if (materials == nullptr) {
      materials = &root_.add("materials", make_object());
      move_to(*materials, offset);
    }
    JsonNode& added = materials->add(name, *record);
    added.add("like", make_string(name));
    move_to(added, offset);
    bases_[name] = name;
  }

  /// Returns the material that an object names, or null.
  [[nodiscard]] const JsonNode* material_of(const JsonNode& object) const {
    const JsonNode* materials = root_.find("materials");
    const std::string name = text_of(object, "material");
    return materials != nullptr && !name.empty() ? materials->find(name) : nullptr;
  }

  /// Gives an object a figure of its material.
  void give(JsonNode& object, std::string_view key, std::string_view figure) const {
    const JsonNode* material = material_of(object);
    const JsonNode* value = material != nullptr ? material->find(figure) : nullptr;
    if (value != nullptr) add_missing(object, key, *value, object.find("material")->offset);
  }

  void give_body(JsonNode& body) const {
    // What does not move has no mass.
    if (text_of(body, "kind") != "dynamic") return;
    JsonNode* parts = parts_of(body);
    if (parts == nullptr) {
      if (body.find("mass") == nullptr) give(body, "density", "density");
      if (body.find("fracture") == nullptr) give(body, "yields", "yields");
      return;
    }
    for (JsonNode& part : parts->children) {
      if (part.kind != JsonNode::Kind::kObject) continue;
      const JsonNode* material = material_of(part.find("material") != nullptr ? part : body);
      const JsonNode* density = material != nullptr ? material->find("density") : nullptr;
      if (density != nullptr) add_missing(part, "density", *density, part.offset);
    }
  }

  void give_solid(JsonNode& solid) const {
    if (solid.find("total_mass") == nullptr) give(solid, "density", "density");
    if (text_of(solid, "elasticity") == "shape_matching") return;
    give(solid, "young_modulus", "young_modulus");
    give(solid, "poisson_ratio", "poisson_ratio");
  }

  void give_cloth(JsonNode& cloth) const {
    if (cloth.find("total_mass") == nullptr) give(cloth, "areal_density", "areal_density");
    give(cloth, "stretch_stiffness", "stretch_stiffness");
    give(cloth, "shear_stiffness", "shear_stiffness");
    // Springs to the second neighbor have another unit.
    const std::string bend = text_of(cloth, "bend");
    if (bend != "spring" && bend != "none") give(cloth, "bend_stiffness", "bend_stiffness");
  }

  void give_rope(JsonNode& rope) const {
    give(rope, "strength", "strength");
    const JsonNode* material = material_of(rope);
    if (material == nullptr) return;
    const std::uint32_t offset = rope.find("material")->offset;
    if (const double diameter = number_of(*material, "diameter", 0); diameter > 0)
      add_missing(rope, "radius", make_number(diameter / 2), offset);
    if (const double linear_density = number_of(*material, "linear_density", 0); linear_density > 0) {
      const double mass = linear_density * rest_length(rope);
      if (mass > 0) add_missing(rope, "total_mass", make_number(mass), offset);
    }
  }

  static double rest_length(const JsonNode& rope) {
    const JsonNode* points = rope.find("points");
    if (points == nullptr)
      return number_of(rope, "length_at_rest", static_cast<double>(RopeDesc{}.length_at_rest));
    double sum = 0;
    for (std::size_t i = 1; i < points->children.size(); ++i) {
      const JsonNode& a = points->children[i - 1];
      const JsonNode& b = points->children[i];
      if (a.children.size() != 3 || b.children.size() != 3) return 0;
      double squared = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double step = b.children[k].number - a.children[k].number;
        squared += step * step;
      }
      sum += std::sqrt(squared);
    }
    return sum;
  }

  /// Adds what the library says on two materials of the scene.
  void add_pairs() {
    std::set<std::pair<std::string, std::string>> said;
    if (const JsonNode* pairs = root_.find("material_pairs"); pairs != nullptr) {
      if (pairs->kind != JsonNode::Kind::kArray) return;
      for (const JsonNode& pair : pairs->children) {
        said.emplace(text_of(pair, "a"), text_of(pair, "b"));
        said.emplace(text_of(pair, "b"), text_of(pair, "a"));
      }
    }
    for (const JsonNode& pair : library().pairs.children) {
      for (const auto& [name_a, base_a] : bases_) {
        for (const auto& [name_b, base_b] : bases_) {
          if (base_a != text_of(pair, "a") || base_b != text_of(pair, "b")) continue;
          if (!said.emplace(name_a, name_b).second) continue;
          add_pair(pair, name_a, name_b);
        }
      }
    }
  }

  void add_pair(const JsonNode& record, const std::string& a, const std::string& b) {
    JsonNode* pairs = root_.find("material_pairs");
    if (pairs == nullptr) pairs = &root_.add("material_pairs", make_array());
    const JsonNode& materials = *root_.find("materials");
    const JsonNode& first = *materials.find(a);
    const JsonNode& second = *materials.find(b);
    JsonNode pair = make_object();
    pair.add("a", make_string(a));
    pair.add("b", make_string(b));
    // What the record leaves out is as without it.
    const double friction = std::sqrt(number_of(first, "friction", kUnknownFriction) *
                                      number_of(second, "friction", kUnknownFriction));
    pair.add("friction", make_number(number_of(record, "friction", friction)));
    if (const JsonNode* value = record.find("static_friction")) pair.add("static_friction", *value);
    const double restitution =
        std::max(number_of(first, "restitution", 0), number_of(second, "restitution", 0));
    pair.add("restitution", make_number(number_of(record, "restitution", restitution)));
    move_to(pairs->add(std::move(pair)), first.offset);
  }

  JsonNode& root_;
  /// The library's name of each material of the scene whose friction is the library's.
  std::map<std::string, std::string> bases_;
};

}  // namespace

void take_from_library(JsonNode& root) {
  if (root.kind == JsonNode::Kind::kObject) Taking(root).run();
}

bool is_in_library(const std::string& name) {
  return find_record(name) != nullptr;
}

std::string library_hint(const std::string& name) {
  std::string all;
  for (const auto& [known, record] : library().materials) {
    if (edit_distance_up_to_2(known, name) <= 2) return ", did you mean " + in_quotes(known) + "?";
    all += (all.empty() ? "; the library has " : ", ") + known;
  }
  return all;
}

}  // namespace hooke::io

namespace hooke {

std::vector<std::string> library_materials() {
  std::vector<std::string> names;
  for (const auto& [name, record] : io::library().materials) names.push_back(name);
  return names;
}

}  // namespace hooke

#pragma once

#include "io/scene/scene_table.h"

#include <type_traits>

/// \file
/// Holds what the tables of all named objects share.

namespace hooke::io {

inline bool check_named(Reader& reader, const JsonNode& node, const std::string& name) {
  const JsonNode* child = node.find("name");
  if (child == nullptr) return true;
  reader.enter("name");
  const bool good = check_name(reader, *child, name);
  reader.leave();
  return good;
}

template <class T>
bool check_tagged(Reader& reader, const JsonNode& node, const void* object) {
  const SceneTag& tag = static_cast<const T*>(object)->tag;
  if (!std::is_same_v<T, SceneBody> && !tag.array.rotations.empty()) {
    return reader.fail(node, ErrorCode::kOutOfRange, "only an array of bodies has 'rotations'");
  }
  return check_named(reader, node, tag.name);
}

/// Adds the keys of SceneTag, which every object but a field has. Bodies have no key for a stepper of the
/// laboratory.
template <class T>
void add_tag_rows(std::vector<Field>& rows) {
  rows.insert(
      rows.begin(),
      {field<&T::tag, &SceneTag::name>(
           "name", "", kNotEmpty, "Unique. Without it the object is called by its place, as `ropes[0]`."),
       field<&T::tag, &SceneTag::material>("material", "", kNotEmpty, "A name in `materials`.")});
  rows.push_back(field<&T::tag, &SceneTag::friction>(
      "friction", "", between(0, 100), "Coulomb coefficient, instead of the material's or of 0.5."));
  if constexpr (!std::is_same_v<T, SceneBody>) {
    rows.push_back(field<&T::tag, &SceneTag::stepper>(
        "stepper", "", kNotEmpty,
        "How the laboratory integrates it, as `rk4`, or `auto`; `hooke compare --help` lists them."));
  }
  rows.push_back(field<&T::desc, &decltype(T::desc)::connection_points>(
      "connection_points", "m", kAny,
      std::is_same_v<T, SceneBody>
          ? "Places in its frame that hooks may name as `object.name`."
          : "Places that hooks may name as `object.name`: points, or what is nearest to a place, in the "
            "frame of its `position`, of ropes, grids and particles in the world."));
  rows.push_back(
      field<&T::tag, &SceneTag::array>("array", "", kAny, "Copies, named `name[0]`, `name[1]`, ..."));
}

}  // namespace hooke::io

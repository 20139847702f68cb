#include "hooke/scene_io.h"

#include "io/scene/scene_table.h"

namespace hooke {

namespace io {

namespace {

std::string help_with_unit(const Field& field) {
  return *field.unit == '\0' ? field.help : std::string(field.help) + " [" + field.unit + "]";
}

/// Returns the value of a key that is not given. It is null when the key is required or has nothing to show.
JsonNode default_of(const Kind& kind, const Field& field) {
  const bool shown = field.use == Field::Use::kOptional && field.write != nullptr;
  JsonNode value = shown ? field.write(kind.defaults()) : JsonNode{};
  const bool unsayable = value.text == "rigid" && !field.rule.rigid;  // The bound does not exist.
  const bool empty = value.kind == JsonNode::Kind::kObject || unsayable ||
                     (value.kind == JsonNode::Kind::kString && value.text.empty());
  return empty ? JsonNode{} : value;
}

JsonNode field_schema(const Kind& kind, const Field& field) {
  JsonNode value = field.group != nullptr ? schema_reference(field.group()) : field.schema(field.rule);
  if (value.find("$ref") != nullptr) {
    // Draft 7 of JSON Schema ignores what stands beside a reference.
    JsonNode all = make_array();
    all.add(std::move(value));
    value = make_object();
    value.add("allOf", std::move(all));
  }
  value.add("description", make_string(help_with_unit(field)));
  JsonNode initial = default_of(kind, field);
  if (initial.kind != JsonNode::Kind::kNull) value.add("default", std::move(initial));
  return value;
}

JsonNode needs(const char* key) {
  JsonNode keys = make_array();
  keys.add(make_string(key));
  JsonNode schema = make_object();
  schema.add("required", std::move(keys));
  return schema;
}

JsonNode kind_schema(const Kind& kind) {
  JsonNode schema = make_object();
  schema.add("description", make_string(kind.help));
  schema.add("type", make_string("object"));
  JsonNode properties = make_object();
  JsonNode required_keys = make_array();
  JsonNode choices = make_array();
  for (const Field& field : kind.fields) {
    properties.add(field.key, field_schema(kind, field));
    if (field.use == Field::Use::kRequired) required_keys.add(make_string(field.key));
    if (field.use == Field::Use::kChoice) choices.add(needs(field.key));
  }
  schema.add("properties", std::move(properties));
  if (!required_keys.children.empty()) schema.add("required", std::move(required_keys));
  if (!choices.children.empty()) schema.add("oneOf", std::move(choices));
  schema.add("additionalProperties", make_boolean(false));
  return schema;
}

std::string type_text(const Field& field) {
  if (field.group == nullptr) return field.type();
  const std::string name = field.group().name;
  return "[" + name + "](#" + name + ")";
}

std::string default_text(const Kind& kind, const Field& field) {
  if (field.use == Field::Use::kRequired) return "required";
  if (field.use == Field::Use::kChoice) return "one of";
  const JsonNode value = default_of(kind, field);
  if (value.kind == JsonNode::Kind::kNull) return "";
  return "`" + to_flat_text(value) + "`";
}

std::string kind_table(const Kind& kind) {
  std::string text = "### " + std::string(kind.name) + "\n\n" + kind.help + "\n";
  if (kind.fields.empty()) return text + "\n";
  text += "\n| key | type | unit | range | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const Field& field : kind.fields) {
    text += "| `" + std::string(field.key) + "` | " + type_text(field) + " | " + field.unit + " | " +
            range_text(field.rule) + " | " + default_text(kind, field) + " | " + field.help + " |\n";
  }
  return text + "\n";
}

}  // namespace

}  // namespace io

std::string scene_schema() {
  io::JsonNode definitions = io::make_object();
  for (const io::Kind* kind : io::all_kinds()) definitions.add(kind->name, io::kind_schema(*kind));
  io::JsonNode schema = io::make_object();
  schema.add("$schema", io::make_string("http://json-schema.org/draft-07/schema#"));
  schema.add("title", io::make_string("Hooke scene, version " + std::to_string(kSceneVersion)));
  io::JsonNode all = io::make_array();
  all.add(io::schema_reference(io::kind_of<Scene>()));
  schema.add("allOf", std::move(all));
  schema.add("definitions", std::move(definitions));
  return io::to_text(schema);
}

std::string scene_reference() {
  std::string text;
  for (const io::Kind* kind : io::all_kinds()) text += io::kind_table(*kind);
  text.pop_back();
  return text;
}

}  // namespace hooke

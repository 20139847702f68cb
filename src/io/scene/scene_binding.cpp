#include "io/scene/scene_binding.h"

#include <algorithm>
#include <cstring>
#include <numbers>

namespace hooke::io {

namespace {

std::string digits(double value) {
  return make_number(value).text;
}

const Field* find_field(const Kind& kind, std::string_view key) {
  const auto found =
      std::find_if(kind.fields.begin(), kind.fields.end(), [&](const Field& f) { return f.key == key; });
  return found == kind.fields.end() ? nullptr : &*found;
}

std::string hint(const Kind& kind, std::string_view key) {
  const Field* best = nullptr;
  int smallest = 3;
  for (const Field& field : kind.fields) {
    const int distance = edit_distance_up_to_2(key, field.key);
    if (distance < smallest) {
      smallest = distance;
      best = &field;
    }
  }
  // Two edits can make any two short words equal, so that these are not suggested.
  const bool alike = best != nullptr && smallest < static_cast<int>(std::strlen(best->key));
  return alike ? ", did you mean '" + std::string(best->key) + "'?" : "";
}

bool read_field(Reader& reader, const JsonNode& node, const Field& field, void* object) {
  if (field.choose != nullptr) field.choose(object);
  reader.enter(field.key);
  const char* unit = reader.set_unit(field.unit);
  const bool good = field.group != nullptr ? read_object(reader, node, field.group(), object)
                                           : field.read(reader, node, field.rule, object);
  reader.set_unit(unit);
  reader.leave();
  return good;
}

std::string list_of_choices(const Kind& kind) {
  std::string words;
  for (const Field& field : kind.fields) {
    if (field.is_choice()) words += (words.empty() ? "'" : ", '") + std::string(field.key) + "'";
  }
  return words;
}

/// Checks that required keys are present, and one of the choices, if the kind has any.
bool check_presence(Reader& reader, const JsonNode& node, const Kind& kind) {
  bool good = true;
  bool choosing = false;
  const JsonNode* choice = nullptr;
  for (const Field& field : kind.fields) {
    const JsonNode* child = node.find(field.key);
    if (field.use == Field::Use::kRequired && child == nullptr) {
      good = reader.fail(node, ErrorCode::kOutOfRange, "needs '" + std::string(field.key) + "'");
    }
    choosing = choosing || field.is_choice();
    if (!field.is_choice() || child == nullptr) continue;
    if (choice != nullptr) {
      const bool later = child->offset > choice->offset;
      reader.fail_key(later ? *child : *choice,
                      "cannot stand beside '" + (later ? choice : child)->key + "'");
      good = false;
    }
    choice = child;
  }
  if (choosing && choice == nullptr) {
    good = reader.fail(node, ErrorCode::kOutOfRange, "needs one of " + list_of_choices(kind));
  }
  return good;
}

bool same_field(const Field& field, const void* a, const void* b) {
  if (field.chosen != nullptr && field.chosen(a) != field.chosen(b)) return false;
  if (field.chosen != nullptr && !field.chosen(a)) return true;
  return field.group != nullptr ? same_object(field.group(), a, b) : field.same(a, b);
}

}  // namespace

std::string Reader::path() const {
  std::string text;
  for (const Step& step : path_) {
    if (step.key.data() == nullptr) {
      text += "[" + std::to_string(step.index) + "]";
    } else {
      // A key may be as long as the file.
      constexpr std::size_t kLongestKey = 64;
      text += (text.empty() ? "" : ".") + std::string(step.key.substr(0, kLongestKey));
    }
  }
  return text;
}

bool Reader::fail(const JsonNode& node, ErrorCode code, std::string reason) {
  if (!full()) errors_.push_back({node.offset, {code, path(), std::move(reason)}});
  return false;
}

bool Reader::fail_type(const JsonNode& node, const char* wanted) {
  std::string reason = std::string("is ") + name_of(node.kind);
  if (node.kind == JsonNode::Kind::kString) reason = in_quotes(node.text) + " is a string";
  reason += std::string(", must be ") + wanted;
  const bool number = std::string_view(wanted).starts_with("a number");
  if (number && node.kind == JsonNode::Kind::kString && *unit_ != '\0') {
    reason += " (in " + std::string(unit_) + ", without a unit)";
  }
  return fail(node, ErrorCode::kWrongType, std::move(reason));
}

bool Reader::check(const JsonNode& node, double value, const Rule& rule) {
  const bool large_enough = rule.above_least ? value > rule.least : value >= rule.least;
  if (large_enough && value <= rule.most) return true;
  return fail(node, ErrorCode::kOutOfRange,
              document_.number_text(node) + " is out of range, must be " + range_text(rule));
}

void Reader::fail_key(const JsonNode& child, std::string reason) {
  if (full()) return;
  enter(child.key);
  errors_.push_back({child.key_offset, {ErrorCode::kUnknownKey, path(), std::move(reason)}});
  leave();
}

bool read_object(Reader& reader, const JsonNode& node, const Kind& kind, void* object) {
  if (node.kind != JsonNode::Kind::kObject) return reader.fail_type(node, "an object");
  bool good = true;
  for (const JsonNode& child : node.children) {
    if (reader.full()) return false;
    const Field* field = find_field(kind, child.key);
    if (field == nullptr) {
      reader.fail_key(child, "unknown key" + hint(kind, child.key));
      good = false;
      continue;
    }
    good = read_field(reader, child, *field, object) && good;
  }
  good = check_presence(reader, node, kind) && good;
  return good && (kind.check == nullptr || kind.check(reader, node, object));
}

JsonNode write_object(const Kind& kind, const void* object) {
  JsonNode node = make_object();
  for (const Field& field : kind.fields) {
    if (field.write == nullptr && field.group == nullptr) continue;
    const bool wanted =
        field.is_choice() ? field.chosen(object)
                          : field.use == Field::Use::kRequired || !same_field(field, object, kind.defaults());
    if (!wanted) continue;
    node.add(field.key, field.group != nullptr ? write_object(field.group(), object) : field.write(object));
  }
  return node;
}

bool same_object(const Kind& kind, const void* a, const void* b) {
  return std::all_of(kind.fields.begin(), kind.fields.end(), [&](const Field& field) {
    return (field.same == nullptr && field.group == nullptr) || same_field(field, a, b);
  });
}

JsonNode schema_reference(const Kind& kind) {
  JsonNode node = make_object();
  node.add("$ref", make_string("#/definitions/" + std::string(kind.name)));
  return node;
}

JsonNode schema_number(const Rule& rule, bool integer) {
  JsonNode number = make_object();
  number.add("type", make_string(integer ? "integer" : "number"));
  if (std::isfinite(rule.least)) {
    number.add(rule.above_least ? "exclusiveMinimum" : "minimum", make_number(rule.least));
  }
  if (std::isfinite(rule.most)) number.add("maximum", make_number(rule.most));
  if (!rule.rigid) return number;
  JsonNode words = make_array();
  words.add(make_string("rigid"));
  words.add(make_string("inf"));
  JsonNode word = make_object();
  word.add("enum", std::move(words));
  JsonNode either = make_array();
  either.add(std::move(number));
  either.add(std::move(word));
  JsonNode node = make_object();
  node.add("anyOf", std::move(either));
  return node;
}

JsonNode schema_list(JsonNode element, std::size_t fewest, std::size_t most) {
  JsonNode list = make_object();
  list.add("type", make_string("array"));
  list.add("items", std::move(element));
  if (fewest > 0) list.add("minItems", make_integer(static_cast<std::int64_t>(fewest)));
  if (most < kMostJsonValues) list.add("maxItems", make_integer(static_cast<std::int64_t>(most)));
  return list;
}

std::string range_text(const Rule& rule) {
  const bool bounded = std::isfinite(rule.most);
  std::string text;
  if (std::isfinite(rule.least) && bounded && !rule.above_least) {
    text = digits(rule.least) + " to " + digits(rule.most);
  } else if (std::isfinite(rule.least)) {
    text = (rule.above_least ? "greater than " : "at least ") + digits(rule.least);
    if (bounded) text += " and at most " + digits(rule.most);
  } else if (bounded) {
    text = "at most " + digits(rule.most);
  }
  return rule.rigid ? text + (text.empty() ? "" : " or ") + "\"rigid\"" : text;
}

bool read_number(Reader& reader, const JsonNode& node, const Rule& rule, double& value) {
  if (node.kind != JsonNode::Kind::kNumber) return reader.fail_type(node, "a number");
  if (!reader.check(node, node.number, rule)) return false;
  value = node.number;
  return true;
}

bool read_word(Reader& reader, const JsonNode& node, std::span<const EnumName> names, int& value) {
  if (node.kind != JsonNode::Kind::kString) return reader.fail_type(node, "a string");
  std::string words;
  for (const EnumName& name : names) {
    if (node.text == name.name) {
      value = name.value;
      return true;
    }
    words += (words.empty() ? "'" : ", '") + std::string(name.name) + "'";
  }
  return reader.fail(node, ErrorCode::kOutOfRange, in_quotes(node.text) + " is not one of " + words);
}

bool Codec<bool>::read(Reader& reader, const JsonNode& node, const Rule& /*rule*/, bool& value) {
  if (node.kind != JsonNode::Kind::kBoolean) return reader.fail_type(node, "true or false");
  value = node.boolean;
  return true;
}

JsonNode Codec<bool>::schema(const Rule& /*rule*/) {
  JsonNode schema = make_object();
  schema.add("type", make_string("boolean"));
  return schema;
}

bool Codec<std::string>::read(Reader& reader, const JsonNode& node, const Rule& rule, std::string& value) {
  if (node.kind != JsonNode::Kind::kString) return reader.fail_type(node, "a string");
  if (node.text.size() < rule.fewest_elements) {
    return reader.fail(node, ErrorCode::kOutOfRange, "must not be empty");
  }
  value = node.text;
  return true;
}

JsonNode Codec<std::string>::schema(const Rule& rule) {
  JsonNode schema = make_object();
  schema.add("type", make_string("string"));
  if (rule.fewest_elements > 0) {
    schema.add("minLength", make_integer(static_cast<std::int64_t>(rule.fewest_elements)));
  }
  return schema;
}

bool expect_list(Reader& reader, const JsonNode& node, std::size_t fewest, std::size_t most) {
  if (node.kind != JsonNode::Kind::kArray) return reader.fail_type(node, "a list");
  const std::size_t size = node.children.size();
  if (size >= fewest && size <= most) return true;
  const std::string wanted = (fewest == most ? "must have " : "must have at least ") + std::to_string(fewest);
  return reader.fail(node, ErrorCode::kOutOfRange,
                     "has " + std::to_string(size) + (size == 1 ? " element, " : " elements, ") + wanted);
}

bool check_name(Reader& reader, const JsonNode& node, const std::string& name) {
  constexpr std::size_t kLongestName = 64;
  if (name.empty()) return reader.fail(node, ErrorCode::kOutOfRange, "a name must not be empty");
  if (name.size() > kLongestName) {
    return reader.fail(node, ErrorCode::kOutOfRange, "a name must not be longer than 64 bytes");
  }
  const bool plain = std::none_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' || c == 127 || c == '[' || c == ']' || c == '.';
  });
  return plain ||
         reader.fail(node, ErrorCode::kOutOfRange,
                     in_quotes(name) + " has a character that a name must not have ([ ] . or control)");
}

namespace {

/// These are the forms of a rotation that are written for people.
struct AxisAngle {
  DVec3 axis = {0, 1, 0};
  double angle_deg = 0;
  std::optional<DVec3> euler_deg = {};
};

const Kind& axis_angle_kind() {
  static const Kind kind = {
      .name = "rotation",
      .help = "A turn: `{\"axis\", \"angle_deg\"}`, or `{\"euler_deg\"}`, or a quaternion `[x, y, z, w]`.",
      .fields = {field<&AxisAngle::axis>("axis", "", kAny, "Direction of the axis; any length but zero."),
                 field<&AxisAngle::angle_deg>("angle_deg", "degrees", kAny,
                                              "Counter-clockwise seen against the axis."),
                 field<&AxisAngle::euler_deg>(
                     "euler_deg", "degrees", kAny,
                     "Turns about the fixed x, then y, then z axis; replaces axis and angle.")},
      .defaults = defaults_of<AxisAngle>};
  return kind;
}

DVec3 unit_axis(int i) {
  return {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
}

Quaternion<double> rotation_of(const AxisAngle& turn) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  if (!turn.euler_deg.has_value()) return quaternion_about(turn.axis, kRadians * turn.angle_deg);
  const DVec3 e = *turn.euler_deg;
  return quaternion_about(unit_axis(2), kRadians * e.z) * quaternion_about(unit_axis(1), kRadians * e.y) *
         quaternion_about(unit_axis(0), kRadians * e.x);
}

}  // namespace

template <>
const Kind& kind_of<Quat>() {
  return axis_angle_kind();
}

bool Codec<Quat>::read(Reader& reader, const JsonNode& node, const Rule& /*rule*/, Quat& value) {
  if (node.kind == JsonNode::Kind::kArray) {
    Quat q = {};
    if (!read_elements<Real, 4>(reader, node, kAny, {&q.x, &q.y, &q.z, &q.w})) return false;
    if (q == Quat{0, 0, 0, 0}) {
      return reader.fail(node, ErrorCode::kOutOfRange, "a quaternion must not be zero");
    }
    value = q;
    return true;
  }
  AxisAngle turn;
  if (!read_object(reader, node, axis_angle_kind(), &turn)) return false;
  if (length(turn.axis) == 0.0) {
    return reader.fail(node, ErrorCode::kOutOfRange, "the axis must not be zero");
  }
  const Quaternion<double> q = rotation_of(turn);
  value = {static_cast<Real>(q.x), static_cast<Real>(q.y), static_cast<Real>(q.z), static_cast<Real>(q.w)};
  return true;
}

JsonNode Codec<Quat>::schema(const Rule& /*rule*/) {
  JsonNode forms = make_array();
  forms.add(schema_list(schema_number(kAny, false), 4, 4));
  forms.add(schema_reference(axis_angle_kind()));
  JsonNode schema = make_object();
  schema.add("anyOf", std::move(forms));
  return schema;
}

}  // namespace hooke::io

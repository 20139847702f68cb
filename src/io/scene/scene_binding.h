#pragma once

#include "hooke/desc.h"

#include "io/json/json_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

/// \file
/// Connects members of structs with keys of JSON objects. A `Kind` is the table of one JSON object. It has a
/// `Field` for each key, made from the path of members that leads to its value. Reading, writing, comparing,
/// the schema and the documentation all use the same tables (scene_table.cpp).
///
/// Read in this order: Rule, Field, Kind, the functions over kinds, Codec (what a value of a type looks like
/// in JSON), field() and group(), which make table rows.

namespace hooke::io {

struct Kind;

/// A Rule says what a number must obey, and how long a list may be.
struct Rule {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;         ///< Whether `least` itself is excluded.
  bool rigid = false;               ///< Whether the word "rigid" stands for infinity.
  std::size_t fewest_elements = 0;  ///< Least number of elements of a list, or of bytes of a text.
};

inline constexpr Rule kAny = {};
inline constexpr Rule kPositive = {.least = 0, .above_least = true};
inline constexpr Rule kNotNegative = {.least = 0};
inline constexpr Rule kPositiveOrRigid = {.least = 0, .above_least = true, .rigid = true};
inline constexpr Rule kNotNegativeOrRigid = {.least = 0, .rigid = true};
inline constexpr Rule kNotEmpty = {.fewest_elements = 1};
constexpr Rule between(double least, double most) {
  return {.least = least, .most = most};
}

/// Reads a tree into structs and collects what is wrong with it.
class Reader {
 public:
  Reader(const JsonDocument& document, std::vector<JsonError>& errors)
      : document_(document), errors_(errors) {}

  /// Reports that the current value is wrong. Always returns false, so that a reader can return it.
  bool fail(const JsonNode& node, ErrorCode code, std::string reason);
  /// Reports that the current value is not of the wanted kind; returns false.
  bool fail_type(const JsonNode& node, const char* wanted);
  /// Checks a finite number against a rule.
  bool check(const JsonNode& node, double value, const Rule& rule);
  /// Reports an error at the key of a child of the current object.
  void fail_key(const JsonNode& child, std::string reason);
  /// Tells whether enough errors were found to stop reading.
  [[nodiscard]] bool full() const { return errors_.size() >= kMostErrors; }

  void enter(std::string_view key) { path_.push_back({key, 0}); }
  void enter(std::size_t index) { path_.push_back({{}, index}); }
  void leave() { path_.pop_back(); }
  /// Sets the unit of the value that is being read, for messages; returns the previous one.
  const char* set_unit(const char* unit) { return std::exchange(unit_, unit); }

 private:
  struct Step {
    std::string_view key;
    std::size_t index = 0;
  };
  [[nodiscard]] std::string path() const;

  const JsonDocument& document_;
  std::vector<JsonError>& errors_;
  std::vector<Step> path_;
  const char* unit_ = "";
};

/// A Field is one key of a JSON object. Its functions take the object that the kind describes.
struct Field {
  enum class Use : std::uint8_t {
    kOptional,
    kRequired,
    kChoice,  ///< Exactly one of the choices of an object must be there.
  };

  const char* key = "";
  const char* unit = "";
  const char* help = "";
  Rule rule = {};
  Use use = Use::kOptional;
  bool (*read)(Reader& reader, const JsonNode& node, const Rule& rule, void* object) = nullptr;
  JsonNode (*write)(const void* object) = nullptr;
  bool (*same)(const void* a, const void* b) = nullptr;
  JsonNode (*schema)(const Rule& rule) = nullptr;
  std::string (*type)() = nullptr;
  void (*choose)(void* object) = nullptr;  ///< Makes the object have this choice.
  bool (*chosen)(const void* object) = nullptr;
  const Kind& (*group)() = nullptr;  ///< The value is an object that describes members of the same struct.

  [[nodiscard]] bool is_choice() const { return use == Use::kChoice; }
};

/// A Kind is one kind of JSON object: the table of its keys.
struct Kind {
  const char* name = "";
  const char* help = "";
  std::vector<Field> fields = {};
  const void* (*defaults)() = nullptr;
  /// Checks what no single key can. It is called when all keys were read without an error, and returns false
  /// after a failure.
  bool (*check)(Reader& reader, const JsonNode& node, const void* object) = nullptr;
};

bool read_object(Reader& reader, const JsonNode& node, const Kind& kind, void* object);
/// Writes an object without what equals the default, unless a key is required or chosen.
[[nodiscard]] JsonNode write_object(const Kind& kind, const void* object);
[[nodiscard]] bool same_object(const Kind& kind, const void* a, const void* b);

/// Returns the JSON of a reference such as {"$ref": "#/definitions/rope"}.
[[nodiscard]] JsonNode schema_reference(const Kind& kind);
[[nodiscard]] JsonNode schema_number(const Rule& rule, bool integer);
/// Returns text such as "greater than 0" or "2 to 65536"; it is empty when everything is accepted.
[[nodiscard]] std::string range_text(const Rule& rule);
bool read_number(Reader& reader, const JsonNode& node, const Rule& rule, double& value);

/// Returns the table of a struct; specialized in scene_table_*.cpp.
template <class T>
const Kind& kind_of();

template <class T>
const void* defaults_of() {
  static const T value = {};
  return &value;
}

struct EnumName {
  const char* name;
  int value;
};
/// Returns the words for an enumeration; specialized in scene_table.h.
template <class E>
std::span<const EnumName> names_of();
bool read_word(Reader& reader, const JsonNode& node, std::span<const EnumName> names, int& value);

template <class T>
inline constexpr bool kByName = false;

// -- Codecs: what a value of a type looks like in JSON.
// ------------------------------------------------------

/// This is the codec of a struct with a table.
template <class T>
struct Codec {
  static bool read(Reader& reader, const JsonNode& node, const Rule& /*rule*/, T& value) {
    return read_object(reader, node, kind_of<T>(), &value);
  }
  static JsonNode write(const T& value) { return write_object(kind_of<T>(), &value); }
  static bool same(const T& a, const T& b) { return same_object(kind_of<T>(), &a, &b); }
  static JsonNode schema(const Rule& /*rule*/) { return schema_reference(kind_of<T>()); }
  static std::string type() { return "[" + std::string(kind_of<T>().name) + "](#" + kind_of<T>().name + ")"; }
};

template <std::floating_point T>
struct Codec<T> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, T& value) {
    double number = 0;
    if (rule.rigid && node.kind == JsonNode::Kind::kString && (node.text == "rigid" || node.text == "inf")) {
      value = std::numeric_limits<T>::infinity();
      return true;
    }
    if (rule.rigid && node.kind != JsonNode::Kind::kNumber)
      return reader.fail_type(node, "a number or \"rigid\"");
    if (!read_number(reader, node, rule, number)) return false;
    // The shortest text of the largest number is a little more than that number.
    constexpr auto kMost = std::numeric_limits<T>::max();
    constexpr double kRounding = 1 + static_cast<double>(std::numeric_limits<T>::epsilon()) / 4;
    if (std::abs(number) / kRounding > static_cast<double>(kMost)) {
      return reader.fail(node, ErrorCode::kOutOfRange, "is too large for a number of this precision");
    }
    const bool is_most = std::abs(number) > static_cast<double>(kMost);
    const T rounded =
        is_most ? std::copysign(kMost, static_cast<T>(number > 0 ? 1 : -1)) : static_cast<T>(number);
    if (!reader.check(node, static_cast<double>(rounded), rule)) return false;
    value = rounded;
    return true;
  }
  static JsonNode write(T value) { return std::isinf(value) ? make_string("rigid") : make_number(value); }
  /// The sign of zero counts, because a scene that has -0 gives other bits.
  static bool same(T a, T b) { return a == b && std::signbit(a) == std::signbit(b); }
  static JsonNode schema(const Rule& rule) { return schema_number(rule, false); }
  static std::string type() { return "number"; }
};

template <std::integral T>
struct Codec<T> {
  static Rule within(Rule rule) {
    rule.least = std::max(rule.least, static_cast<double>(std::numeric_limits<T>::lowest()));
    rule.most = std::min(rule.most, static_cast<double>(std::numeric_limits<T>::max()));
    return rule;
  }
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, T& value) {
    double number = 0;
    if (!read_number(reader, node, within(rule), number)) return false;
    if (number != std::floor(number)) {
      return reader.fail(node, ErrorCode::kWrongType, "must be a whole number");
    }
    value = static_cast<T>(number);
    return true;
  }
  static JsonNode write(T value) { return make_integer(static_cast<std::int64_t>(value)); }
  static bool same(T a, T b) { return a == b; }
  static JsonNode schema(const Rule& rule) { return schema_number(within(rule), true); }
  static std::string type() { return "whole number"; }
};

template <>
struct Codec<bool> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, bool& value);
  static JsonNode write(bool value) { return make_boolean(value); }
  static bool same(bool a, bool b) { return a == b; }
  static JsonNode schema(const Rule& rule);
  static std::string type() { return "true or false"; }
};

template <>
struct Codec<std::string> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, std::string& value);
  static JsonNode write(const std::string& value) { return make_string(value); }
  static bool same(const std::string& a, const std::string& b) { return a == b; }
  static JsonNode schema(const Rule& rule);
  static std::string type() { return "text"; }
};

template <class E>
requires std::is_enum_v<E>
struct Codec<E> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& /*rule*/, E& value) {
    int number = 0;
    if (!read_word(reader, node, names_of<E>(), number)) return false;
    value = static_cast<E>(number);
    return true;
  }
  static JsonNode write(E value) {
    for (const EnumName& name : names_of<E>()) {
      if (name.value == static_cast<int>(value)) return make_string(name.name);
    }
    return make_string("");
  }
  static bool same(E a, E b) { return a == b; }
  static JsonNode schema(const Rule& /*rule*/) {
    JsonNode words = make_array();
    for (const EnumName& name : names_of<E>()) words.add(make_string(name.name));
    JsonNode schema = make_object();
    schema.add("enum", std::move(words));
    return schema;
  }
  static std::string type() {
    std::string words;
    for (const EnumName& name : names_of<E>()) {
      words += (words.empty() ? "`\"" : ", `\"") + std::string(name.name) + "\"`";
    }
    return words;
  }
};

/// Checks that the node is a list of a number of elements in [fewest, most]; reports an error if not.
bool expect_list(Reader& reader, const JsonNode& node, std::size_t fewest, std::size_t most);
[[nodiscard]] JsonNode schema_list(JsonNode element, std::size_t fewest, std::size_t most);

template <class T, std::size_t N>
bool read_elements(Reader& reader, const JsonNode& node, const Rule& rule, std::array<T*, N> elements) {
  if (!expect_list(reader, node, N, N)) return false;
  bool good = true;
  for (std::size_t i = 0; i < N; ++i) {
    reader.enter(i);
    good = Codec<T>::read(reader, node.children[i], rule, *elements[i]) && good;
    reader.leave();
  }
  return good;
}

template <class T, std::size_t N>
struct Codec<std::array<T, N>> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, std::array<T, N>& value) {
    std::array<T*, N> elements = {};
    for (std::size_t i = 0; i < N; ++i) elements[i] = &value[i];
    return read_elements(reader, node, rule, elements);
  }
  static JsonNode write(const std::array<T, N>& value) {
    JsonNode list = make_array();
    for (const T& element : value) list.add(Codec<T>::write(element));
    return list;
  }
  static bool same(const std::array<T, N>& a, const std::array<T, N>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), Codec<T>::same);
  }
  static JsonNode schema(const Rule& rule) { return schema_list(Codec<T>::schema(rule), N, N); }
  static std::string type() { return "[" + std::to_string(N) + " x " + Codec<T>::type() + "]"; }
};

template <class T>
struct Codec<Vector3<T>> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, Vector3<T>& value) {
    return read_elements<T, 3>(reader, node, rule, {&value.x, &value.y, &value.z});
  }
  static JsonNode write(const Vector3<T>& v) { return Codec<std::array<T, 3>>::write({v.x, v.y, v.z}); }
  static bool same(const Vector3<T>& a, const Vector3<T>& b) {
    return Codec<std::array<T, 3>>::same({a.x, a.y, a.z}, {b.x, b.y, b.z});
  }
  static JsonNode schema(const Rule& rule) { return Codec<std::array<T, 3>>::schema(rule); }
  static std::string type() { return "[x, y, z]"; }
};

/// This is the object form of a rotation: {"axis", "angle_deg"}, or {"euler_deg"}.
template <>
const Kind& kind_of<Quat>();

/// A rotation is [x, y, z, w], or {"axis", "angle_deg"}, or {"euler_deg"}.
template <>
struct Codec<Quat> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, Quat& value);
  static JsonNode write(const Quat& q) { return Codec<std::array<Real, 4>>::write({q.x, q.y, q.z, q.w}); }
  static bool same(const Quat& a, const Quat& b) {
    return Codec<std::array<Real, 4>>::same({a.x, a.y, a.z, a.w}, {b.x, b.y, b.z, b.w});
  }
  static JsonNode schema(const Rule& rule);
  static std::string type() { return "[rotation](#rotation)"; }
};

template <class T>
struct Codec<std::optional<T>> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, std::optional<T>& value) {
    T content = {};
    if (!Codec<T>::read(reader, node, rule, content)) return false;
    value = std::move(content);
    return true;
  }
  static JsonNode write(const std::optional<T>& value) {
    return value.has_value() ? Codec<T>::write(*value) : JsonNode{};
  }
  static bool same(const std::optional<T>& a, const std::optional<T>& b) {
    return a.has_value() == b.has_value() && (!a.has_value() || Codec<T>::same(*a, *b));
  }
  static JsonNode schema(const Rule& rule) { return Codec<T>::schema(rule); }
  static std::string type() { return Codec<T>::type(); }
};

template <class T>
struct Codec<std::vector<T>> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, std::vector<T>& value) {
    if (!expect_list(reader, node, rule.fewest_elements, std::numeric_limits<std::size_t>::max()))
      return false;
    value.assign(node.children.size(), T{});
    bool good = true;
    for (std::size_t i = 0; i < value.size() && !reader.full(); ++i) {
      reader.enter(i);
      good = Codec<T>::read(reader, node.children[i], rule, value[i]) && good;
      reader.leave();
    }
    return good;
  }
  static JsonNode write(const std::vector<T>& value) {
    JsonNode list = make_array();
    for (const T& element : value) list.add(Codec<T>::write(element));
    return list;
  }
  static bool same(const std::vector<T>& a, const std::vector<T>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (!Codec<T>::same(a[i], b[i])) return false;
    }
    return true;
  }
  static JsonNode schema(const Rule& rule) {
    return schema_list(Codec<T>::schema(rule), rule.fewest_elements, std::numeric_limits<std::size_t>::max());
  }
  static std::string type() { return "list of " + Codec<T>::type(); }
};

/// Checks the name of an object, material or mesh.
bool check_name(Reader& reader, const JsonNode& node, const std::string& name);

/// This is the codec of a list that is written as a JSON object; the keys are the names of its elements.
template <class T>
requires kByName<T>
struct Codec<std::vector<T>> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, std::vector<T>& value) {
    if (node.kind != JsonNode::Kind::kObject) return reader.fail_type(node, "an object");
    value.assign(node.children.size(), T{});
    bool good = true;
    for (std::size_t i = 0; i < value.size() && !reader.full(); ++i) {
      reader.enter(node.children[i].key);
      value[i].name = node.children[i].key;
      good = check_name(reader, node.children[i], value[i].name) &&
             Codec<T>::read(reader, node.children[i], rule, value[i]) && good;
      reader.leave();
    }
    return good;
  }
  static JsonNode write(const std::vector<T>& value) {
    JsonNode object = make_object();
    for (const T& element : value) object.add(element.name, Codec<T>::write(element));
    return object;
  }
  static bool same(const std::vector<T>& a, const std::vector<T>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i].name != b[i].name || !Codec<T>::same(a[i], b[i])) return false;
    }
    return true;
  }
  static JsonNode schema(const Rule& rule) {
    JsonNode schema = make_object();
    schema.add("type", make_string("object"));
    schema.add("additionalProperties", Codec<T>::schema(rule));
    return schema;
  }
  static std::string type() { return "object of name: " + Codec<T>::type(); }
};

// -- Rows of tables.
// ------------------------------------------------------------------------------------------

template <class T>
struct MemberTraits;
template <class Object, class Value>
struct MemberTraits<Value Object::*> {
  using ObjectType = Object;
  using ValueType = Value;
};

/// Follows pointers to members: reach<&SceneRope::desc, &RopeDesc::masses>(rope).
template <auto First, auto... Rest>
auto& reach(auto& object) {
  if constexpr (sizeof...(Rest) == 0) {
    return object.*First;
  } else {
    return reach<Rest...>(object.*First);
  }
}

/// These are the functions of a table row for the member that `First, Rest...` lead to.
template <auto First, auto... Rest>
struct Path {
  using Object = typename MemberTraits<decltype(First)>::ObjectType;
  static auto& in(void* object) { return reach<First, Rest...>(*static_cast<Object*>(object)); }
  static const auto& in(const void* object) {
    return reach<First, Rest...>(*static_cast<const Object*>(object));
  }
  using Value = std::remove_cvref_t<decltype(in(static_cast<void*>(nullptr)))>;

  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, void* object) {
    return Codec<Value>::read(reader, node, rule, in(object));
  }
  static JsonNode write(const void* object) { return Codec<Value>::write(in(object)); }
  static bool same(const void* a, const void* b) { return Codec<Value>::same(in(a), in(b)); }
};

/// Makes a key whose value is the member at the path `Members...`.
template <auto... Members>
Field field(const char* key, const char* unit, Rule rule, const char* help) {
  using P = Path<Members...>;
  return {.key = key,
          .unit = unit,
          .help = help,
          .rule = rule,
          .read = &P::read,
          .write = &P::write,
          .same = &P::same,
          .schema = &Codec<typename P::Value>::schema,
          .type = &Codec<typename P::Value>::type};
}

inline Field required(Field row) {
  row.use = Field::Use::kRequired;
  return row;
}

/// Makes a key whose value is an object that describes several members of the same struct.
inline Field group(const char* key, const Kind& (*table)(), const char* help) {
  Field row;
  row.key = key;
  row.help = help;
  row.group = table;
  return row;
}

/// Makes a key that is there when the enumerator at the path `Members...` has the value `Choice`.
template <auto Choice, auto... Members>
Field choice(Field row) {
  using P = Path<Members...>;
  row.use = Field::Use::kChoice;
  row.choose = [](void* object) { P::in(object) = Choice; };
  row.chosen = [](const void* object) { return P::in(object) == Choice; };
  return row;
}

}  // namespace hooke::io

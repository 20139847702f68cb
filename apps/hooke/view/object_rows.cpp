#include "hooke/view/object_rows.h"

#include <algorithm>
#include <string_view>

namespace hooke::app {

namespace {

/// Returns "brick" for "brick[3]", and nothing for what is no member of an array.
std::string_view array_of(std::string_view name) {
  return name.ends_with(']') ? name.substr(0, name.rfind('[')) : std::string_view();
}

bool same_letter(char a, char b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return lower(a) == lower(b);
}

bool has(const std::string& name, const std::string& find) {
  return std::search(name.begin(), name.end(), find.begin(), find.end(), same_letter) != name.end();
}

}  // namespace

std::vector<ObjectRow> object_rows(const std::vector<const ListedObject*>& objects, const std::string& find,
                                   const std::set<std::string>& open, const std::string& selected) {
  std::vector<ObjectRow> rows;
  std::size_t head = 0;  // The last row of an array.
  std::string_view array;
  for (const ListedObject* object : objects) {
    const std::string& name = object->name;
    if (!find.empty()) {
      if (has(name, find)) rows.push_back({name});
      continue;
    }
    const std::string_view own = array_of(name);
    if (!own.empty() && own != array) {
      head = rows.size();
      rows.push_back({std::string(own), 0, open.contains(std::string(own)) || own == array_of(selected)});
    }
    array = own;
    if (!own.empty()) ++rows[head].members;
    if (own.empty() || rows[head].is_open) rows.push_back({name});
  }
  return rows;
}

}  // namespace hooke::app

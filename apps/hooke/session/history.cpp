#include "hooke/session/history.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace hooke::app {

namespace {

constexpr std::size_t kMostRows = 36000;  ///< Ten minutes of 60 steps a second; the oldest go then.

void write_number(std::string& text, double value) {
  char number[32];
  std::snprintf(number, sizeof(number), ",%.9g", value);
  text += number;
}

}  // namespace

void History::take_columns(const std::vector<MeasuredValue>& world, const std::string& object,
                           const std::vector<MeasuredValue>& of_object) {
  std::vector<Column> columns;
  for (const MeasuredValue& value : world) columns.push_back({value.name, value.unit});
  for (const MeasuredValue& value : of_object) columns.push_back({object + ": " + value.name, value.unit});
  const auto same = [](const Column& a, const Column& b) { return a.name == b.name; };
  if (std::equal(columns.begin(), columns.end(), columns_.begin(), columns_.end(), same)) return;
  for (Row& row : rows_) row.values.resize(std::min(row.values.size(), world.size()));
  columns_ = std::move(columns);
}

void History::note(std::uint64_t step, double time, const std::vector<MeasuredValue>& world,
                   const std::string& object, const std::vector<MeasuredValue>& of_object) {
  const std::lock_guard lock(mutex_);
  while (!rows_.empty() && rows_.back().step >= step) rows_.pop_back();
  take_columns(world, object, of_object);
  Row row = {.step = step, .time = time};
  for (const MeasuredValue& value : world) row.values.push_back(value.value);
  for (const MeasuredValue& value : of_object) row.values.push_back(value.value);
  rows_.push_back(std::move(row));
  if (rows_.size() > kMostRows) rows_.pop_front();
}

void History::clear() {
  const std::lock_guard lock(mutex_);
  rows_.clear();
  columns_.clear();
}

std::vector<History::Column> History::columns() const {
  const std::lock_guard lock(mutex_);
  return columns_;
}

std::size_t History::size() const {
  const std::lock_guard lock(mutex_);
  return rows_.size();
}

History::Curve History::curve(const std::string& name, double seconds) const {
  const std::lock_guard lock(mutex_);
  Curve curve;
  const auto found = std::find_if(columns_.begin(), columns_.end(),
                                  [&](const Column& column) { return column.name == name; });
  if (found == columns_.end() || rows_.empty()) return curve;
  const auto index = static_cast<std::size_t>(found - columns_.begin());
  const double first = rows_.back().time - seconds;
  const auto from =
      std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.time >= first; });
  for (auto row = from; row != rows_.end(); ++row) {
    if (row->values.size() > index) curve.push_back({row->time, row->values[index]});
  }
  return curve;
}

std::string History::csv() const {
  const std::lock_guard lock(mutex_);
  std::string text = "step,time [s]";
  for (const Column& column : columns_) {
    std::string name = column.name;
    std::replace(name.begin(), name.end(), ',', ' ');
    text += "," + name + (column.unit.empty() ? "" : " [" + column.unit + "]");
  }
  text += '\n';
  for (const Row& row : rows_) {
    text += std::to_string(row.step);
    write_number(text, row.time);
    for (const double value : row.values) write_number(text, value);
    text.append(columns_.size() - row.values.size(), ',');
    text += '\n';
  }
  return text;
}

}  // namespace hooke::app

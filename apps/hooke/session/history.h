#pragma once

#include "hooke/session/measured_value.h"

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace hooke::app {

/// Figures over time, for plots and tables: those of the world, and those of one object since it was
/// selected. One thread notes them, and any thread may read them.
class History {
 public:
  struct Column {
    std::string name = {};  ///< As "momentum x"; "rope: largest tension" for one of an object.
    std::string unit = {};
  };
  /// Times [s] and values.
  using Curve = std::vector<std::array<double, 2>>;

  /// Notes the figures of a step. Rows of this step and of later ones go, as after a rewind. When another
  /// object is meant than before, the figures of that one go.
  void note(std::uint64_t step, double time, const std::vector<MeasuredValue>& world,
            const std::string& object, const std::vector<MeasuredValue>& of_object);
  /// Forgets everything.
  void clear();

  [[nodiscard]] std::vector<Column> columns() const;
  /// A column over the last `seconds`; empty for a name that is none.
  [[nodiscard]] Curve curve(const std::string& name, double seconds) const;
  /// All of it as comma-separated values, with a line of names and units first. A figure that was not known
  /// yet is empty.
  [[nodiscard]] std::string csv() const;
  [[nodiscard]] std::size_t size() const;

 private:
  struct Row {
    std::uint64_t step = 0;
    double time = 0;
    std::vector<double> values = {};  ///< In the order of columns; those of the object may be missing.
  };
  /// Says which columns there are, and drops values of columns that are no more.
  void take_columns(const std::vector<MeasuredValue>& world, const std::string& object,
                    const std::vector<MeasuredValue>& of_object);

  mutable std::mutex mutex_;  ///< Guards what follows.
  std::vector<Column> columns_;
  std::deque<Row> rows_;
};

}  // namespace hooke::app

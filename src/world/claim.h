#pragma once

#include "hooke/result.h"
#include "hooke/world.h"

#include "base/float_environment.h"
#include "world/world_data.h"

#include <memory>

/// \file
/// Every call of the API reaches a World's data through one of these classes. They make sure that the host's
/// rounding mode never changes the bits, that a World that was moved from holds nothing, and that nothing but
/// the step itself changes a World during a step.

namespace hooke::world {

/// A call that changes the world makes a Claim first. It is refused if the World was moved from, or if a step
/// runs, which is when force laws are called.
class Claim {
 public:
  explicit Claim(const std::shared_ptr<WorldData>& data) : data_(data.get()) {}

  explicit operator bool() const { return data_ != nullptr && !data_->stepping; }
  /// Says why the call is refused.
  [[nodiscard]] Error error() const;

  WorldData* operator->() const { return data_; }
  WorldData& operator*() const { return *data_; }
  [[nodiscard]] state::Tables& tables() const { return data_->tables; }

 private:
  base::FloatEnvironment environment_;
  WorldData* data_;
};

/// A call that only reads makes a Reading first. A World that was moved from reads as an empty one.
class Reading {
 public:
  explicit Reading(const std::shared_ptr<WorldData>& data);

  const WorldData* operator->() const { return &data_; }
  [[nodiscard]] const state::Tables& tables() const { return data_.tables; }

 private:
  base::FloatEnvironment environment_;
  const WorldData& data_;
};

}  // namespace hooke::world

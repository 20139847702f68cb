#pragma once

#include "hooke/result.h"
#include "hooke/world.h"

#include "base/float_environment.h"
#include "world/world_data.h"

#include <memory>

/// \file
/// How every call of the API comes to a World's data. Whatever the host does around it, what a call computes
/// has the same bits; a World that was moved from has nothing; and nothing changes while a step runs.

namespace hooke::world {

/// Of a call that changes the world. Refused where there is none, or where the call comes from a force law.
class Claim {
 public:
  explicit Claim(const std::shared_ptr<WorldData>& data) : data_(data.get()) {}

  explicit operator bool() const { return data_ != nullptr && !data_->stepping; }
  /// Why it is refused.
  [[nodiscard]] Error error() const;

  WorldData* operator->() const { return data_; }
  WorldData& operator*() const { return *data_; }
  [[nodiscard]] state::Tables& tables() const { return data_->tables; }

 private:
  base::FloatEnvironment environment_;
  WorldData* data_;
};

/// Of a call that only reads. A World that was moved from is read as one that holds nothing.
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

#include "world/claim.h"

namespace hooke::world {

namespace {

const WorldData& nothing() {
  static const WorldData nothing;
  return nothing;
}

}  // namespace

Error Claim::error() const {
  if (data_ == nullptr) return {ErrorCode::kStaleId, "world", "was moved from: it holds nothing any more"};
  return {ErrorCode::kUnsupported, "world", "cannot change during a step: a force law may only add forces"};
}

Reading::Reading(const std::shared_ptr<WorldData>& data) : data_(data ? *data : nothing()) {}

}  // namespace hooke::world

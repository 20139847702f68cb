#pragma once

#include "hooke/event.h"

#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Cloth that tears: docs/decisions/0043-ropes-and-cloth-that-break.md. The strain of a point is the mean of
/// those of its triangles, by area; each is sum (lambda_k - 1) d_k d_k^T over its principal stretches
/// lambda_k > 1 and their directions d_k (of F^T F, with F from the form at rest). Where the largest strain
/// of a point exceeds what the cloth can take, the point splits: its triangles before and behind the plane
/// across that direction part. The side with more area keeps the point, with its pin, its hooks and its
/// number. The other gets a new point at the end of the object. Both get their share of the mass by area, and
/// the same place and velocity. Springs along the crack are shared out; what led across it is gone
/// (build/cloth_splits.h).

namespace hooke::build {

/// Splits points of a cloth that are strained too much: at most eight, those first
/// that are strained most over what they take, none beside another. Rows of later objects move. Appends an
/// event for each, with `time` [s].
void tear_cloth(std::uint32_t object, double time, state::Tables& tables,
                std::vector<ClothTearEvent>& events);

}  // namespace hooke::build

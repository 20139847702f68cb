#pragma once

#include "hooke/shape.h"

#include <vector>

namespace hooke::geometry {

/// Is told what decompose_convex does, and may know the answer. It must not throw.
class PartsListener {
 public:
  PartsListener() = default;
  PartsListener(const PartsListener&) = delete;
  PartsListener& operator=(const PartsListener&) = delete;
  virtual ~PartsListener() = default;

  /// Returns parts that were made before of the same mesh with the same limits; empty if there are none.
  virtual std::vector<MeshDesc> recall(const MeshDesc& mesh, Real concavity_max, int parts_max) = 0;
  /// Takes note of parts that were made.
  virtual void keep(const MeshDesc& mesh, Real concavity_max, int parts_max,
                    const std::vector<MeshDesc>& parts) = 0;
  /// Is told which part of the work is done, from 0 to 1.
  virtual void advance(double part) = 0;
};

/// While it lives, the calls of decompose_convex of this thread have the listener. Scopes nest.
class PartsListening {
 public:
  explicit PartsListening(PartsListener* listener);
  PartsListening(const PartsListening&) = delete;
  PartsListening& operator=(const PartsListening&) = delete;
  ~PartsListening();

  /// Returns the listener of this thread; null without one.
  [[nodiscard]] static PartsListener* current();

 private:
  PartsListener* before_;
};

}  // namespace hooke::geometry

#pragma once

#include <cfenv>
#if defined(__SSE2__) || defined(_M_X64)
#include <xmmintrin.h>
#define HOOKE_HAS_MXCSR 1
#endif

namespace hooke::base {

/// Sets round-to-nearest and gradual underflow for the calling thread, and restores the settings of the host
/// on destruction. A host that flushes denormals or rounds upward must not change the bits of a result. This
/// costs a few nanoseconds where the host has the same settings. The rounding of the x87 unit is set, too,
/// because the C library converts between text and numbers by it.
class FloatEnvironment {
 public:
#ifdef HOOKE_HAS_MXCSR
  FloatEnvironment() : saved_(_mm_getcsr()), rounding_(std::fegetround()) {
    if (rounding_ != FE_TONEAREST) std::fesetround(FE_TONEAREST);
    if (differs()) _mm_setcsr(kDefault);
  }
  ~FloatEnvironment() {
    if (rounding_ != FE_TONEAREST) std::fesetround(rounding_);
    if (differs()) _mm_setcsr(saved_);
  }
#else
  FloatEnvironment() {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatEnvironment() {
    std::fesetenv(&saved_);
  }
#endif
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
#ifdef HOOKE_HAS_MXCSR
  static constexpr unsigned kDefault = 0x1F80;  // All exceptions masked, round to nearest, no FTZ, no DAZ.
  static constexpr unsigned kFlags = 0x3F;      // Exceptions that have occurred so far.
  [[nodiscard]] bool differs() const {
    return (saved_ & ~kFlags) != kDefault;
  }
  unsigned saved_;
  int rounding_;
#else
  std::fenv_t saved_;
#endif
};

}  // namespace hooke::base

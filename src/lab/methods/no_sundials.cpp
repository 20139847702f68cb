#include "lab/methods/methods.h"

/// This stands in for sundials.cpp where the library is not installed.

namespace hooke::lab {

const bool kHasSundials = false;

namespace {

void refuse(Workspace& work) {
  work.error =
      Error{ErrorCode::kUnsupported, "stepper", "this build has no SUNDIALS (Debian: libsundials-dev)"};
}

}  // namespace

void step_adams_moulton(const System&, double, double, State&, Workspace& work) {
  refuse(work);
}
void step_bdf(const System&, double, double, State&, Workspace& work) {
  refuse(work);
}
void step_dormand_prince(const System&, double, double, State&, Workspace& work) {
  refuse(work);
}

}  // namespace hooke::lab

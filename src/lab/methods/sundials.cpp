#include "lab/methods/implicit.h"
#include "lab/methods/methods.h"

#include <arkode/arkode_erkstep.h>
#include <cmath>
#include <cstdio>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

/// The SUNDIALS library (Hindmarsh et al. 2005, ACM TOMS 31) chooses order and steps so that the error of
/// each step stays below the tolerance. A step of the laboratory is many of the library.

namespace hooke::lab {

const bool kHasSundials = true;

namespace {

constexpr long kMostSteps = 1000000;  ///< Steps of the library in one of the laboratory.
constexpr int kKrylovDimension = 60;
/// By this share gamma may change before the preconditioner is made anew.
constexpr double kGammaMayChange = 0.3;

/// An Integrator is the memory of SUNDIALS for one system, from the first step to the next change of y from
/// outside.
struct Integrator {
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  SUNNonlinearSolver fixed_point = nullptr;
  SUNLinearSolver krylov = nullptr;
  void* cvode = nullptr;
  void* erk = nullptr;
  const System* system = nullptr;
  ImplicitMatrix matrix;
  long steps_before = 0;

  Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  ~Integrator() {
    if (cvode != nullptr) CVodeFree(&cvode);
    if (erk != nullptr) ERKStepFree(&erk);
    if (krylov != nullptr) SUNLinSolFree(krylov);
    if (fixed_point != nullptr) SUNNonlinSolFree(fixed_point);
    if (y != nullptr) N_VDestroy(y);
    if (context != nullptr) SUNContext_Free(&context);
  }
};

Eigen::Map<State> map_of(N_Vector vector) {
  return {N_VGetArrayPointer(vector), N_VGetLength(vector)};
}

int slope(realtype t, N_Vector y, N_Vector result, void* user) {
  const State value = (*static_cast<Integrator*>(user)->system)(t, map_of(y));
  if (!value.allFinite()) return 1;  // A positive value makes the library try a smaller step.
  map_of(result) = value;
  return 0;
}

// NOLINTNEXTLINE(readability-function-size): the signature is CVODE's
int jacobian_times(N_Vector direction, N_Vector result, realtype t, N_Vector y, N_Vector, void* user,
                   N_Vector) {
  const System& system = *static_cast<Integrator*>(user)->system;
  map_of(result) = system.jacobian_times(t, map_of(y), map_of(direction));
  return 0;
}

// GMRES solves CVODE's linear equations. Preconditioned by the matrix of an earlier step it needs a few
// rounds, instead of hundreds where springs are stiff.

// NOLINTNEXTLINE(readability-function-size): the signature is CVODE's
int factor_preconditioner(realtype t, N_Vector y, N_Vector, booleantype may_keep, booleantype* is_new,
                          realtype gamma, void* user) {
  auto& i = *static_cast<Integrator*>(user);
  const bool near = std::abs(i.matrix.gamma() - gamma) <= kGammaMayChange * gamma;
  *is_new = may_keep != 0 && near ? SUNFALSE : SUNTRUE;
  if (*is_new == SUNFALSE) return 0;
  return i.matrix.factor(*i.system, t, map_of(y), gamma) ? 0 : 1;
}

// NOLINTNEXTLINE(readability-function-size): the signature is CVODE's
int precondition(realtype, N_Vector, N_Vector, N_Vector right, N_Vector result, realtype, realtype, int,
                 void* user) {
  const auto& i = *static_cast<Integrator*>(user);
  map_of(result) = i.matrix.solve_whole(*i.system, map_of(right));
  return 0;
}

using Begin = bool (*)(Integrator& i, double t, const Workspace& work);

bool begin_adams_moulton(Integrator& i, double t, const Workspace& work) {
  i.cvode = CVodeCreate(CV_ADAMS, i.context);
  i.fixed_point = SUNNonlinSol_FixedPoint(i.y, 0, i.context);
  return i.cvode != nullptr && i.fixed_point != nullptr && CVodeInit(i.cvode, slope, t, i.y) == 0 &&
         CVodeSStolerances(i.cvode, work.tolerance, work.tolerance) == 0 &&
         CVodeSetUserData(i.cvode, &i) == 0 && CVodeSetMaxNumSteps(i.cvode, kMostSteps) == 0 &&
         CVodeSetNonlinearSolver(i.cvode, i.fixed_point) == 0;
}

bool begin_bdf(Integrator& i, double t, const Workspace& work) {
  i.cvode = CVodeCreate(CV_BDF, i.context);
  i.krylov = SUNLinSol_SPGMR(i.y, SUN_PREC_LEFT, kKrylovDimension, i.context);
  return i.cvode != nullptr && i.krylov != nullptr && CVodeInit(i.cvode, slope, t, i.y) == 0 &&
         CVodeSStolerances(i.cvode, work.tolerance, work.tolerance) == 0 &&
         CVodeSetUserData(i.cvode, &i) == 0 && CVodeSetMaxNumSteps(i.cvode, kMostSteps) == 0 &&
         CVodeSetLinearSolver(i.cvode, i.krylov, nullptr) == 0 &&
         CVodeSetJacTimes(i.cvode, nullptr, jacobian_times) == 0 &&
         CVodeSetPreconditioner(i.cvode, factor_preconditioner, precondition) == 0;
}

bool begin_dormand_prince(Integrator& i, double t, const Workspace& work) {
  i.erk = ERKStepCreate(slope, t, i.y, i.context);
  return i.erk != nullptr && ERKStepSStolerances(i.erk, work.tolerance, work.tolerance) == 0 &&
         ERKStepSetUserData(i.erk, &i) == 0 && ERKStepSetMaxNumSteps(i.erk, kMostSteps) == 0 &&
         ERKStepSetTableNum(i.erk, ARKODE_DORMAND_PRINCE_7_4_5) == 0;
}

/// Errors come back as values, so that the library must print nothing.
void no_handler(int, const char*, const char*, char*, void*) {}

std::shared_ptr<Integrator> make(Begin begin, const System& f, double t, const State& y,
                                 const Workspace& work) {
  auto i = std::make_shared<Integrator>();
  i->system = &f;
  if (SUNContext_Create(nullptr, &i->context) != 0) return nullptr;
  i->y = N_VNew_Serial(y.size(), i->context);
  if (i->y == nullptr) return nullptr;
  map_of(i->y) = y;
  if (!begin(*i, t, work)) return nullptr;
  if (i->cvode != nullptr) CVodeSetErrHandlerFn(i->cvode, no_handler, nullptr);
  if (i->erk != nullptr) ERKStepSetErrHandlerFn(i->erk, no_handler, nullptr);
  return i;
}

int evolve(Integrator& i, double end) {
  double reached = 0;
  if (i.erk != nullptr) {
    ERKStepSetStopTime(i.erk, end);
    return ERKStepEvolve(i.erk, end, i.y, &reached, ARK_NORMAL);
  }
  CVodeSetStopTime(i.cvode, end);
  return CVode(i.cvode, end, i.y, &reached, CV_NORMAL);
}

long steps_of(Integrator& i) {
  long steps = 0;
  if (i.erk != nullptr) {
    ERKStepGetNumSteps(i.erk, &steps);
  } else {
    CVodeGetNumSteps(i.cvode, &steps);
  }
  return steps;
}

void step_by_tolerance(Begin begin, const System& f, double t, double h, State& y, Workspace& work) {
  if (work.integrator == nullptr) work.integrator = make(begin, f, t, y, work);
  auto* i = static_cast<Integrator*>(work.integrator.get());
  if (i != nullptr) {
    i->system = &f;
    if (evolve(*i, t + h) >= 0) {
      y = map_of(i->y);
      const long steps = steps_of(*i);
      work.inner_steps += static_cast<std::uint64_t>(steps - i->steps_before);
      i->steps_before = steps;
      return;
    }
  }
  char text[128];
  std::snprintf(text, sizeof(text), "SUNDIALS could not keep the tolerance %g after t = %.6g s",
                work.tolerance, t);
  work.error = Error{ErrorCode::kLimitExceeded, f.name(), text};
}

}  // namespace

void step_adams_moulton(const System& f, double t, double h, State& y, Workspace& work) {
  step_by_tolerance(begin_adams_moulton, f, t, h, y, work);
}
void step_bdf(const System& f, double t, double h, State& y, Workspace& work) {
  step_by_tolerance(begin_bdf, f, t, h, y, work);
}
void step_dormand_prince(const System& f, double t, double h, State& y, Workspace& work) {
  step_by_tolerance(begin_dormand_prince, f, t, h, y, work);
}

}  // namespace hooke::lab

#pragma once

#include "lab/methods/growth.h"
#include "lab/methods/method.h"

/// \file
/// Declares every method: its step, and its growth on an oscillation. Each has one file, to be read side by
/// side, simplest first: euler, symplectic_euler, taylor2_paper, paper, taylor2, taylor3, heun, midpoint,
/// verlet, rk4, adams_bashforth, implicit_euler, adams_moulton, bdf; sundials for those with tolerances.

namespace hooke::lab {

void step_euler(const System& f, double t, double h, State& y, Workspace& work);
double growth_euler(Oscillator o);

void step_symplectic_euler(const System& f, double t, double h, State& y, Workspace& work);
double growth_symplectic_euler(Oscillator o);

void step_taylor2_paper(const System& f, double t, double h, State& y, Workspace& work);
double growth_taylor2_paper(Oscillator o);

void step_paper(const System& f, double t, double h, State& y, Workspace& work);
double growth_paper(Oscillator o);

void step_taylor2(const System& f, double t, double h, State& y, Workspace& work);
double growth_taylor2(Oscillator o);

void step_taylor3(const System& f, double t, double h, State& y, Workspace& work);
double growth_taylor3(Oscillator o);

void step_heun(const System& f, double t, double h, State& y, Workspace& work);
double growth_heun(Oscillator o);

void step_midpoint(const System& f, double t, double h, State& y, Workspace& work);
double growth_midpoint(Oscillator o);

void step_verlet(const System& f, double t, double h, State& y, Workspace& work);
double growth_verlet(Oscillator o);

void step_rk4(const System& f, double t, double h, State& y, Workspace& work);
double growth_rk4(Oscillator o);

void step_ab2(const System& f, double t, double h, State& y, Workspace& work);
double growth_ab2(Oscillator o);

void step_ab3(const System& f, double t, double h, State& y, Workspace& work);
double growth_ab3(Oscillator o);

void step_ab4(const System& f, double t, double h, State& y, Workspace& work);
double growth_ab4(Oscillator o);

void step_implicit_euler(const System& f, double t, double h, State& y, Workspace& work);
double growth_implicit_euler(Oscillator o);

void step_am2(const System& f, double t, double h, State& y, Workspace& work);
double growth_am2(Oscillator o);

void step_am3(const System& f, double t, double h, State& y, Workspace& work);
double growth_am3(Oscillator o);

void step_am4(const System& f, double t, double h, State& y, Workspace& work);
double growth_am4(Oscillator o);

void step_bdf2(const System& f, double t, double h, State& y, Workspace& work);
double growth_bdf2(Oscillator o);

void step_bdf3(const System& f, double t, double h, State& y, Workspace& work);
double growth_bdf3(Oscillator o);

void step_bdf4(const System& f, double t, double h, State& y, Workspace& work);
double growth_bdf4(Oscillator o);

/// These methods keep a tolerance by means of SUNDIALS (sundials.cpp). Without the library (no_sundials.cpp)
/// a step gives an error.
extern const bool kHasSundials;
void step_adams_moulton(const System& f, double t, double h, State& y, Workspace& work);
void step_bdf(const System& f, double t, double h, State& y, Workspace& work);
void step_dormand_prince(const System& f, double t, double h, State& y, Workspace& work);

}  // namespace hooke::lab

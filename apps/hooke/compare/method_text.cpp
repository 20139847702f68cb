#include "hooke/compare/method_text.h"

#include <array>
#include <utility>

namespace hooke::app {

namespace {

using Entry = std::pair<std::string_view, MethodText>;

constexpr std::array kOneStep = {
    Entry{
        "euler",
        {"x' = x + h v,  v' = v + h a(x, v)", "\u221a(1 + y\u00b2)",
         "Both slopes are taken at the start of the step, so that the step goes straight on along the "
         "tangent. An oscillation is a circle in the plane of x and v/omega, and a tangent leads out of its "
         "circle: each step ends on a larger one. A smaller step makes that slower, but none is small "
         "enough. Only damping that takes more than the method adds helps: h omega must be below twice the "
         "damping ratio."}},
    Entry{
        "symplectic_euler",
        {"v' = v + h a(x, v),  x' = x + h v'", "1 up to y = 2, then it grows",
         "It differs from explicit Euler in one sign: the new velocity moves the position. The step is two "
         "shears, one along v and one along x, and a shear changes no area, so that the motion cannot "
         "spiral out or in. The energy swings about its true value and stays there. From h omega = 2 on the "
         "mass overshoots by more than it came from, and everything is lost at once."}},
    Entry{
        "taylor2_paper",
        {"x' = x + h v + h\u00b2 a/2,  v' = v + h a", "\u221a(1 + y\u00b2/2)",
         "The position is a parabola, which free fall needs, but the velocity still takes its slope at the "
         "start of the step. The error of the velocity is Euler's, so the oscillation grows as Euler's does, "
         "half as fast."}},
    Entry{"paper",
          {"v' = v + h a,  x' = x + h v' + h\u00b2 a/2", "\u221a(1 \u2212 y\u00b2/2) up to y = \u221a2",
           "The new velocity moves the position, and the parabola moves it once more. That is too far by "
           "h\u00b2 a: in free fall the mass is ahead, and in an oscillation the surplus acts as a brake. So "
           "it is "
           "stable up to h omega = 1.414, and loses energy that the motion should keep."}},
    Entry{
        "taylor2",
        {"x' = x + h v + h\u00b2 a/2,  v' = v + h a + h\u00b2 a\u0307/2", "\u221a(1 + y\u2074/4)",
         "The Taylor series of the solution, cut after the second term, with the exact rate of change of the "
         "force. What is cut off leaves a growth of y\u2074/8 a step: without damping it always grows, but "
         "with "
         "small steps so slowly that it can hardly be seen."}},
    Entry{
        "taylor3",
        {"x' = x + h v + h\u00b2 a/2 + h\u00b3 a\u0307/6,  v' = v + h a + h\u00b2 a\u0307/2 + h\u00b3 "
         "a\u0308/6",
         "\u221a(1 \u2212 y\u2074/12 + y\u2076/36)",
         "The Taylor series, cut after the third term. Here the error left brakes the oscillation instead of "
         "feeding it, up to h omega = \u221a3."}},
    Entry{"heun",
          {"k1 = f(y),  k2 = f(y + h k1),  y' = y + h (k1 + k2)/2", "\u221a(1 + y\u2074/4)",
           "It tries Euler's step, takes the slope at its end, and goes on with the mean of both slopes. The "
           "error of the tangent cancels to second order; what is left lets an undamped oscillation grow by "
           "y\u2074/8 a step."}},
    Entry{
        "midpoint",
        {"k1 = f(y),  k2 = f(y + h k1/2),  y' = y + h k2", "\u221a(1 + y\u2074/4)",
         "It takes the slope in the middle of the step, where half of Euler's step leads. On an oscillation "
         "this is the same map as Heun's: of second order, and growing by y\u2074/8 a step without "
         "damping."}},
    Entry{
        "verlet",
        {"w = v + h a/2,  x' = x + h w,  v' = w + h a(x')/2", "1 up to y = 2, then it grows",
         "Half a kick, a drift, half a kick: the same forward as backward in time. It is symplectic Euler, "
         "seen half a step later, and so keeps areas, too; the symmetry makes it second order. It costs one "
         "evaluation of the forces per step, which is why molecules and planets are computed with it."}},
    Entry{
        "rk4",
        {"k1 = f(y), k2 = f(y + h k1/2), k3 = f(y + h k2/2), k4 = f(y + h k3),  y' = y + h (k1 + 2 k2 + 2 k3 "
         "+ k4)/6",
         "\u221a(1 \u2212 y\u2076/72 + y\u2078/576)",
         "Four slopes, weighed so that all errors up to the fourth order cancel. It brakes oscillations very "
         "slightly, by y\u2076/144 a step, until h omega = 2\u221a2 = 2.83, where it grows at once and "
         "fast."}},
};

constexpr std::array kOthers = {
    Entry{"ab2",
          {"y' = y + h (3 f\u2080 \u2212 f\u208b\u2081)/2", "largest root of a square",
           "It draws a line through the last two slopes and follows it. It pays one evaluation for second "
           "order, but what was remembered is an oscillation of its own, and undamped motion grows slowly at "
           "any step."}},
    Entry{"ab3",
          {"y' = y + h (23 f\u2080 \u2212 16 f\u208b\u2081 + 5 f\u208b\u2082)/12", "largest root of a cubic",
           "A parabola through the last three slopes. The more a method remembers, the sooner what it "
           "remembers oscillates by itself: it is stable only up to h omega = 0.72."}},
    Entry{
        "ab4",
        {"y' = y + h (55 f\u2080 \u2212 59 f\u208b\u2081 + 37 f\u208b\u2082 \u2212 9 f\u208b\u2083)/24",
         "largest root of a quartic",
         "A cubic through the last four slopes: fourth order for one evaluation per step, and stable only up "
         "to h omega = 0.43."}},
    Entry{
        "implicit_euler",
        {"y' = y + h f(y')", "1/\u221a(1 + y\u00b2)",
         "The slope is taken at the end of the step, which has to be solved for. On the circle that is the "
         "tangent that arrives, so that each step ends on a smaller one: stable at any step, and it eats the "
         "energy of everything that is fast."}},
    Entry{
        "am2",
        {"y' = y + h (f(y) + f(y'))/2", "1",
         "Half of explicit and half of implicit Euler, the trapezoidal rule: what one adds the other takes. "
         "It keeps an oscillation at any step, though not its frequency."}},
    Entry{"am3",
          {"y' = y + h (5 f' + 8 f\u2080 \u2212 f\u208b\u2081)/12", "largest root of a square",
           "A parabola through the unknown slope and the last two. It is of third order and stable for decay "
           "up to h |\u03bb| = 6, but lets undamped oscillations grow slowly."}},
    Entry{"am4",
          {"y' = y + h (9 f' + 19 f\u2080 \u2212 5 f\u208b\u2081 + f\u208b\u2082)/24",
           "largest root of a cubic",
           "A cubic through the unknown slope and the last three. Its region of stability is small for an "
           "implicit method: it is made for accuracy, not for stiffness."}},
    Entry{
        "bdf2",
        {"y' = (4 y \u2212 y\u208b\u2081)/3 + 2/3 h f(y')", "largest root of a square",
         "The parabola through two known states and the unknown one must have the right slope at its end. It "
         "is stable at any step and brakes less than implicit Euler."}},
    Entry{
        "bdf3",
        {"y' = (18 y \u2212 9 y\u208b\u2081 + 2 y\u208b\u2082)/11 + 6/11 h f(y')", "largest root of a cubic",
         "A cubic through three known states. It suits what decays fast; an undamped oscillation of medium "
         "h omega grows, because the region of stability leaves out a strip beside the imaginary axis."}},
    Entry{
        "bdf4",
        {"y' = (48 y \u2212 36 y\u208b\u2081 + 16 y\u208b\u2082 \u2212 3 y\u208b\u2083)/25 + 12/25 h f(y')",
         "largest root of a quartic",
         "A quartic through four known states. The strip beside the imaginary axis, where oscillations grow, "
         "is wider than that of bdf3."}},
    Entry{"adams_moulton",
          {"Adams-Moulton of order 1 to 12", "by tolerance",
           "It chooses order and step by the error that it estimates, and tries again where that is too "
           "large."}},
    Entry{"bdf",
          {"backward differentiation of order 1 to 5", "by tolerance",
           "It chooses order and step by the error that it estimates. It suits stiff motion."}},
    Entry{"dormand_prince",
          {"Runge-Kutta of order 5, with one of order 4 inside", "by tolerance",
           "The difference of the two is the estimate of the error, by which it chooses its step."}},
    Entry{
        "solver",
        {"predict, then correct constraints, substep by substep", "none: no linear map",
         "The real-time solver of the engine does not multiply an oscillation by one factor. It moves what a "
         "substep cannot follow to where its constraints want it, as an implicit method would, and so stays "
         "stable at any stiffness."}},
    Entry{"declared",
          {"what the declared accuracy chose", "see the method",
           "The laboratory tried methods and steps until the accuracy that the scene declares was kept."}},
};

}  // namespace

MethodText method_text(std::string_view name) {
  for (const Entry& entry : kOneStep) {
    if (entry.first == name) return entry.second;
  }
  for (const Entry& entry : kOthers) {
    if (entry.first == name) return entry.second;
  }
  return {};
}

}  // namespace hooke::app

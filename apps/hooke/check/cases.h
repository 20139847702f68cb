#pragma once

#include "check.h"

#include <vector>

/// \file
/// The cases, by what they are about. The formula of each known answer stands above its function.

namespace hooke::check {

using Rows = std::vector<CheckRow>;

// cases_fall.cpp: one particle in gravity, air and fields
Rows free_fall(const CheckSetting& setting);
Rows linear_drag(const CheckSetting& setting);
Rows quadratic_drag(const CheckSetting& setting);
Rows kepler_orbit(const CheckSetting& setting);
Rows charge_in_magnetic_field(const CheckSetting& setting);

// cases_springs.cpp: particles and springs
Rows simple_oscillator(const CheckSetting& setting);
Rows damped_oscillator(const CheckSetting& setting);
Rows chain_modes(const CheckSetting& setting);
Rows dumbbell(const CheckSetting& setting);

// cases_rope_statics.cpp: at rest
Rows hanging_weight(const CheckSetting& setting);
Rows series_and_parallel(const CheckSetting& setting);
Rows catenary(const CheckSetting& setting);
Rows elastic_catenary(const CheckSetting& setting);
Rows resolution_of_rope(const CheckSetting& setting);
Rows heavy_load(const CheckSetting& setting);

// cases_rope_motion.cpp
Rows wave_speeds(const CheckSetting& setting);
Rows crane(const CheckSetting& setting);
Rows folded_rope(const CheckSetting& setting);
Rows any_stiffness(const CheckSetting& setting);

// cases_pendulum.cpp
Rows pendulum_amplitude(const CheckSetting& setting);
Rows pendulum_right_angle(const CheckSetting& setting);
Rows inverted_pendulum(const CheckSetting& setting);

// cases_two_angles.cpp
Rows double_pendulum(const CheckSetting& setting);
Rows conical_pendulum(const CheckSetting& setting);

// cases_contact.cpp: friction
Rows capstan(const CheckSetting& setting);
Rows sliding_block(const CheckSetting& setting);

// cases_time.cpp: the same physics at any rate
Rows display_rate(const CheckSetting& setting);
Rows overload(const CheckSetting& setting);
Rows gusts(const CheckSetting& setting);

// cases_methods.cpp
Rows orders(const CheckSetting& setting);
Rows stability(const CheckSetting& setting);

}  // namespace hooke::check

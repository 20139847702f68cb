#pragma once

#include "check.h"

#include <vector>

/// \file
/// The cases, by what they are about. The formula of each known answer stands above its function.

namespace hooke::check {

// cases_fall.cpp: one particle in gravity, drag and fields
std::vector<CheckRow> free_fall(const CheckSetting& setting);

// cases_rope_statics.cpp
std::vector<CheckRow> series_and_parallel(const CheckSetting& setting);

// cases_pendulum.cpp
std::vector<CheckRow> pendulum_amplitude(const CheckSetting& setting);

}  // namespace hooke::check

#pragma once

#include "hooke/bsp.h"
#include "hooke/clock.h"
#include "hooke/cut.h"
#include "hooke/debug_draw.h"
#include "hooke/desc.h"
#include "hooke/event.h"
#include "hooke/fracture.h"
#include "hooke/geometry.h"
#include "hooke/hand.h"
#include "hooke/id.h"
#include "hooke/limits.h"
#include "hooke/machine.h"
#include "hooke/math.h"
#include "hooke/placement.h"
#include "hooke/query.h"
#include "hooke/result.h"
#include "hooke/shape.h"
#include "hooke/statics.h"
#include "hooke/version.h"
#include "hooke/world.h"

/// \file
/// The whole public API of the core.

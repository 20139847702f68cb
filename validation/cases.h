#pragma once

#include "validation/check.h"

#include <vector>

/// \file
/// Declares the cases by subject; file names are those in validation/cases. The formula of each known answer
/// stands above its function.

namespace hooke::check {

using Rows = std::vector<CheckRow>;

// fall.cpp has one particle in gravity, air and fields.
Rows free_fall(const CheckSetting& setting);
Rows linear_drag(const CheckSetting& setting);
Rows quadratic_drag(const CheckSetting& setting);
Rows kepler_orbit(const CheckSetting& setting);
Rows charge_in_magnetic_field(const CheckSetting& setting);

// fields.cpp has bodies in liquid, in air and in magnetic fields.
Rows floating_bodies_in_water(const CheckSetting& setting);
Rows bodies_in_air(const CheckSetting& setting);
Rows magnetic_dipoles(const CheckSetting& setting);

// springs.cpp has particles and springs.
Rows simple_oscillator(const CheckSetting& setting);
Rows damped_oscillator(const CheckSetting& setting);
Rows chain_modes(const CheckSetting& setting);
Rows dumbbell(const CheckSetting& setting);

// rope_statics.cpp has ropes at rest, rods.cpp rods that bend, coupled_groups.cpp ropes with bodies tied to
// them.
Rows hanging_weight(const CheckSetting& setting);
Rows series_and_parallel(const CheckSetting& setting);
Rows catenary(const CheckSetting& setting);
Rows elastic_catenary(const CheckSetting& setting);
Rows cantilevers(const CheckSetting& setting);
Rows bent_to_circle(const CheckSetting& setting);
Rows elastica(const CheckSetting& setting);
Rows euler_columns(const CheckSetting& setting);
Rows heavy_column(const CheckSetting& setting);
Rows atwood(const CheckSetting& setting);
Rows cycloid(const CheckSetting& setting);
Rows swinging_load(const CheckSetting& setting);
Rows table_on_ropes(const CheckSetting& setting);
Rows resolution_of_rope(const CheckSetting& setting);
Rows heavy_load(const CheckSetting& setting);

// twist.cpp has ropes that resist twist.
Rows bent_and_twisted(const CheckSetting& setting);
Rows torsion(const CheckSetting& setting);
Rows link_of_loop(const CheckSetting& setting);
Rows twisted_rod(const CheckSetting& setting);

// rope_motion.cpp has moving ropes.
Rows wave_speeds(const CheckSetting& setting);
Rows crane(const CheckSetting& setting);
Rows folded_rope(const CheckSetting& setting);
Rows any_stiffness(const CheckSetting& setting);

// pendulum.cpp has pendulums in a plane.
Rows pendulum_amplitude(const CheckSetting& setting);
Rows pendulum_right_angle(const CheckSetting& setting);
Rows inverted_pendulum(const CheckSetting& setting);

// two_angles.cpp has pendulums with two angles.
Rows double_pendulum(const CheckSetting& setting);
Rows conical_pendulum(const CheckSetting& setting);

// contact.cpp has friction of ropes and particles.
Rows capstan(const CheckSetting& setting);
Rows sliding_block(const CheckSetting& setting);

// solids.cpp has solids of tetrahedra.
Rows pulled_bar(const CheckSetting& setting);
Rows hanging_bar(const CheckSetting& setting);
Rows cantilever_of_jelly(const CheckSetting& setting);
Rows jelly_wave(const CheckSetting& setting);
Rows patch_test(const CheckSetting& setting);
Rows pushed_cubes(const CheckSetting& setting);

// cloth.cpp has sheets and closed cloths, drape.cpp how cloth falls and flutters.
Rows balloon(const CheckSetting& setting);
Rows supported_plate(const CheckSetting& setting);
Rows tethered_balloon(const CheckSetting& setting);
Rows overhanging_cloth(const CheckSetting& setting);
Rows peirce_strips(const CheckSetting& setting);
Rows cusick_drape(const CheckSetting& setting);
Rows flag_flutter(const CheckSetting& setting);
Rows picture_frame(const CheckSetting& setting);

// time.cpp has the same physics at different rates.
Rows display_rate(const CheckSetting& setting);
Rows there_and_back(const CheckSetting& setting);
Rows overload(const CheckSetting& setting);
Rows gusts(const CheckSetting& setting);

// methods.cpp has order and stability of methods.
Rows orders(const CheckSetting& setting);
Rows stability(const CheckSetting& setting);

// bodies_free.cpp has rigid bodies that rotate freely.
Rows turning_over(const CheckSetting& setting);
Rows free_precession(const CheckSetting& setting);
Rows sleeping_top(const CheckSetting& setting);
Rows isolated_bodies(const CheckSetting& setting);

// tears.cpp has cloth that tears, and surfaces that must not cross.
Rows torn_sheets(const CheckSetting& setting);
Rows surfaces_that_never_cross(const CheckSetting& setting);

// trusses.cpp has structures of hooks.
Rows trusses(const CheckSetting& setting);

// impact.cpp has impacts of bodies.
Rows bouncing_ball(const CheckSetting& setting);
Rows bouncing_box(const CheckSetting& setting);
Rows two_body_impact(const CheckSetting& setting);
Rows oblique_impact(const CheckSetting& setting);
Rows newtons_cradle(const CheckSetting& setting);

// bodies_friction.cpp has sliding, sticking, rolling and toppling bodies.
Rows yo_yo(const CheckSetting& setting);
Rows slide_to_roll(const CheckSetting& setting);
Rows box_on_slope(const CheckSetting& setting);
Rows stopping_distance(const CheckSetting& setting);
Rows toppling_box(const CheckSetting& setting);
Rows rolling_down(const CheckSetting& setting);
Rows rolling_test(const CheckSetting& setting);
Rows loop_the_loop(const CheckSetting& setting);
Rows painleve_rod(const CheckSetting& setting);
Rows leaning_ladder(const CheckSetting& setting);
Rows resisted_balls(const CheckSetting& setting);

// couplings.cpp has ropes, bodies and hooks that act on each other.
Rows pendulum_on_cart(const CheckSetting& setting);
Rows four_cords(const CheckSetting& setting);
Rows bead_on_cord(const CheckSetting& setting);
Rows chain_then_rope(const CheckSetting& setting);

// modes.cpp has chains and springs that oscillate.
Rows hanging_chain_modes(const CheckSetting& setting);
Rows falling_folded_chain(const CheckSetting& setting);
Rows swinging_spring(const CheckSetting& setting);

// spin.cpp has tops, crossed shafts, rolling balls, wobbling discs and stacked blocks.
Rows steady_precession(const CheckSetting& setting);
Rows hookes_joint(const CheckSetting& setting);
Rows half_ball_hit(const CheckSetting& setting);
Rows ball_on_turntable(const CheckSetting& setting);
Rows eulers_disk(const CheckSetting& setting);
Rows overhanging_blocks(const CheckSetting& setting);

// rattleback.cpp has a body that reverses its spin.
Rows rattleback(const CheckSetting& setting);

// silo.cpp has balls in a bin.
Rows silo(const CheckSetting& setting);

// stacks.cpp has stacks, cards and dominoes.
Rows stack_force(const CheckSetting& setting);
Rows tall_stacks(const CheckSetting& setting);
Rows heavy_tops(const CheckSetting& setting);
Rows card_house(const CheckSetting& setting);
Rows domino_scaling(const CheckSetting& setting);

// edges.cpp has edges, tips and seams of meshes, and fast bodies.
Rows fast_bodies(const CheckSetting& setting);
Rows degenerate_pairs(const CheckSetting& setting);
Rows seams_in_floors(const CheckSetting& setting);

// joints.cpp has hooks between bodies.
Rows swinging_bar(const CheckSetting& setting);
Rows mechanisms(const CheckSetting& setting);
Rows loaded_chain(const CheckSetting& setting);
Rows hook_limits(const CheckSetting& setting);
Rows hook_motors(const CheckSetting& setting);
Rows hook_springs(const CheckSetting& setting);

// rollback.cpp has bodies in the laboratory.
Rows rollback(const CheckSetting& setting);
Rows bodies_by_rk4(const CheckSetting& setting);

// machines.cpp has machines of ropes, drums and bodies.
Rows winch(const CheckSetting& setting);
Rows braked_drum(const CheckSetting& setting);
Rows elevator(const CheckSetting& setting);
Rows driven_rope(const CheckSetting& setting);
Rows tackle(const CheckSetting& setting);
Rows unrolling_drum(const CheckSetting& setting);
Rows carousel(const CheckSetting& setting);
Rows bodies_on_rods(const CheckSetting& setting);

// soft_couplings.cpp has bodies and ropes with cloth and jelly.
Rows load_in_hammock(const CheckSetting& setting);
Rows sheet_on_ropes(const CheckSetting& setting);
Rows plate_on_jelly(const CheckSetting& setting);
Rows floating_jelly(const CheckSetting& setting);
Rows jelly_on_rope(const CheckSetting& setting);
Rows free_rooms(const CheckSetting& setting);
Rows caught_ball(const CheckSetting& setting);

// arch.cpp has arches of blocks.
Rows stone_arch(const CheckSetting& setting);

}  // namespace hooke::check

#include "hooke/lab.h"
#include "hooke/math.h"

#include "validation/cases.h"
#include "validation/check.h"
#include "validation/rig.h"

#include <cmath>
#include <exception>
#include <limits>

namespace hooke::check {

namespace {

// These are reasons why a case is not turned.
constexpr const char* kOnlyInPlane = "balanced in a plane: any rounding across it grows, as it does in truth";
constexpr const char* kGustsOfPlaces = "gusts belong to places of the world";
constexpr const char* kOfLaboratory = "of the laboratory, whose worlds are not turned";

/// These are V1 to V24: points, springs, ropes and pendulums.
std::vector<CheckCase> cases_of_points_and_ropes() {
  return {
      {"V1", "Free fall", free_fall, 1.0 / 60},
      {"V2", "Fall with linear drag", linear_drag, 1.0 / 60},
      {"V3", "Fall with quadratic drag", quadratic_drag, 1.0 / 60},
      {"V4", "Mass on a spring", simple_oscillator, 1.0 / 600},
      {"V5", "Damped oscillator", damped_oscillator, 1.0 / 60},
      {"V6", "Hanging spring with its own weight", hanging_weight, 5e-4, 1.0 / 60},
      {"V7", "Springs in series and in parallel", series_and_parallel, 1e-4, 1.0 / 60},
      {"V8", "Normal modes of a chain", chain_modes, 1.0 / 120},
      {"V9", "Wave speeds of a string", wave_speeds, 1e-3},
      {"V10", "Modes of a hanging chain", hanging_chain_modes},
      {"V11", "Catenary", catenary, 8e-5, 1e-3},
      {"V12", "Elastic catenary", elastic_catenary, 4e-4, 1e-3},
      {"V13", "Fall of a folded chain", falling_folded_chain},
      {"V14", "Rope over a drum: capstan", capstan},
      {"V15", "Atwood's machine", atwood},
      {"V16", "Heavy load on a light rope", heavy_load},
      {"V17", "Pendulum of any amplitude", pendulum_amplitude, 5e-4},
      {"V18", "Double pendulum", double_pendulum, 5e-4},
      {"V19", "Conical and spherical pendulum", conical_pendulum, 5e-4},
      {"V20", "Inverted pendulum on a shaken pivot", inverted_pendulum, 1e-3},
      {"V21", "Swinging spring", swinging_spring},
      {"V22", "Bead on a cycloid", cycloid},
      {"V23", "Kepler orbit", kepler_orbit, 0.01},
      {"V24", "Charge in a magnetic field", charge_in_magnetic_field, 1.0 / 60},
  };
}

/// These are V25 to V61: rigid bodies that rotate, collide, slide, roll and stand.
std::vector<CheckCase> cases_of_bodies() {
  return {
      {"V25", "Turning over (Dzhanibekov)", turning_over},
      {"V26", "Free precession of a symmetric top", free_precession},
      {"V27", "Steady precession of a heavy top", steady_precession},
      {"V28", "Sleeping top", sleeping_top},
      {"V29", "Isolated bodies", isolated_bodies},
      {"V30", "Four-bar linkage and slider-crank", mechanisms},
      {"V31", "Hooke's joint", hookes_joint},
      {"V32", "Yo-yo", yo_yo},
      {"V33", "Bouncing ball", bouncing_ball},
      {"V34", "Bouncing box", bouncing_box},
      {"V35", "Hit on a line", two_body_impact},
      {"V36", "Oblique hit", oblique_impact},
      {"V37", "Newton's cradle", newtons_cradle},
      {"V38", "From sliding to rolling", slide_to_roll},
      {"V39", "Half-ball hit", half_ball_hit},
      {"V40", "Box on a slope", box_on_slope},
      {"V41", "Stopping distance", stopping_distance},
      {"V42", "Toppling", toppling_box},
      {"V43", "Rolling down", rolling_down},
      {"V44", "Plate on balls", rolling_test},
      {"V45", "Ball on a turntable", ball_on_turntable},
      {"V46", "Loop", loop_the_loop},
      {"V47", "Euler's disk", eulers_disk},
      {"V48", "Rattleback", rattleback},
      {"V49", "Painleve's rod", painleve_rod},
      {"V50", "Ladder", leaning_ladder, 0, 0, kOnlyInPlane},
      {"V51", "House of cards", card_house},
      {"V52", "Arch of stones", stone_arch},
      {"V53", "Overhanging blocks", overhanging_blocks},
      {"V54", "Force under a stack", stack_force},
      {"V55", "Tall stacks", tall_stacks},
      {"V56", "Heavy tops", heavy_tops},
      {"V57", "Silo and slope", silo},
      {"V58", "Fast bodies", fast_bodies},
      {"V59", "Pairs without a clear normal", degenerate_pairs},
      {"V60", "Seams in floors", seams_in_floors},
      {"V61", "Dominoes at any scale", domino_scaling},
  };
}

/// These are V62 to V79: rods, jelly and cloth.
std::vector<CheckCase> cases_of_soft_matter() {
  return {
      {"V62", "Cantilevers", cantilevers},
      {"V63", "Elastica", elastica},
      {"V64", "Column under its own weight", heavy_column},
      {"V65", "Columns that buckle", euler_columns},
      {"V66", "Rods bent and twisted evenly", bent_and_twisted},
      {"V67", "Torsion of a round wire", torsion},
      {"V68", "Rod that is twisted out", twisted_rod},
      {"V69", "Link of a cable thrown into a loop", link_of_loop},
      {"V70", "Bar of jelly under its own weight", hanging_bar},
      {"V71", "Pulled bar of jelly", pulled_bar},
      {"V72", "Plate on four edges", supported_plate},
      {"V73", "Patch test of tetrahedra", patch_test},
      {"V74", "Balloon", balloon},
      {"V75", "Drape of a disc", cusick_drape},
      {"V76", "Picture frame", picture_frame, 0, 0, kOnlyInPlane},
      {"V77", "Flag in steady wind", flag_flutter},
      {"V78", "Tears", torn_sheets},
      {"V79", "Surfaces that never cross", surfaces_that_never_cross},
  };
}

/// These are V81 to V96: water and air, how the step affects an answer, and structures.
std::vector<CheckCase> cases_of_surroundings_and_time() {
  return {
      {"V81", "Floating bodies", floating_bodies_in_water},
      {"V83", "Bodies in air", bodies_in_air},
      {"V86", "Any display rate", display_rate, 2e-4, 1.0 / 60},
      {"V87", "There and back", there_and_back},
      {"V91", "Order by halving the step", orders, 1.0 / 60},
      {"V92", "Overload", overload, 2e-4, 1.0 / 60},
      {"V94", "The paper's limits of stability", stability, 1.0 / 60},
      {"V95", "Truss", trusses},
      {"V96", "Strips of cloth under their own weight", peirce_strips},
  };
}

/// These are I1 to I23: what the engine itself promises.
std::vector<CheckCase> cases_of_promises() {
  return {
      {"I1", "Rope extension at any resolution", resolution_of_rope},
      {"I2", "Any stiffness at 60 Hz", any_stiffness},
      {"I3", "Pendulum from the horizontal", pendulum_right_angle},
      {"I4", "Spinning dumbbell", dumbbell},
      {"I5", "Gusts at any frame rate", gusts, 0, 0, kGustsOfPlaces},
      {"I7", "Crane", crane},
      {"I8", "Folded rope, 10000 : 1", folded_rope},
      {"I10", "Sliding block", sliding_block},
      {"I11", "Swinging bar", swinging_bar},
      {"I12", "Loaded chain of bodies", loaded_chain},
      {"I13", "Limits of hooks", hook_limits},
      {"I14", "Motors of hooks", hook_motors},
      {"I15", "Springs of hooks", hook_springs},
      {"I16", "Resistance to rolling and spinning", resisted_balls},
      {"I17", "Wave in a bar of jelly", jelly_wave},
      {"I18", "Load that swings on a light rope", swinging_load},
      {"I19", "Table on four ropes", table_on_ropes},
      {"I20", "Rollback in the laboratory", rollback, 0, 0, kOfLaboratory},
      {"I21", "Bodies in the laboratory", bodies_by_rk4, 0, 0, kOfLaboratory},
      {"I22", "Magnetic dipoles", magnetic_dipoles},
      {"I23", "Overhanging cloth", overhanging_cloth},
  };
}

/// These are C1 to C20, T74 and T79: matter of different kinds that acts on each other.
std::vector<CheckCase> cases_of_couplings() {
  return {
      {"C1", "Pendulum on a cart", pendulum_on_cart},
      {"C2", "Weight on four cords", four_cords},
      {"C3", "Bead on a cord", bead_on_cord},
      {"C4", "Chain, rope, load", chain_then_rope},
      {"C5", "Winch", winch},
      {"C6", "Braked drum", braked_drum},
      {"C7", "Rope over a drum that turns", driven_rope},
      {"C8", "Tackle", tackle},
      {"C9", "Drum that unrolls", unrolling_drum},
      {"C10", "Carousel", carousel},
      {"C11", "Bodies on rods", bodies_on_rods},
      {"C12", "Load in a hammock", load_in_hammock},
      {"C13", "Sheet on four ropes", sheet_on_ropes},
      {"C14", "Plate on jelly", plate_on_jelly},
      {"C15", "Floating jelly", floating_jelly},
      {"C16", "Jelly on a rope", jelly_on_rope},
      {"C17", "Ball and sheet", caught_ball},
      {"C18", "Balloon on a rope", tethered_balloon},
      {"C19", "Free and mixed", free_rooms},
      {"C20", "Elevator", elevator},
      {"T74", "Cubes pushed by 10 kN", pushed_cubes},
      {"T79", "Rod bent into a circle", bent_to_circle, 0, 0, kOnlyInPlane},
  };
}

}  // namespace

double CheckRow::error() const {
  const double difference = std::abs(achieved - expected);
  return measure == Measure::kAbsolute ? difference : difference / std::abs(expected);
}

const std::vector<CheckCase>& check_cases() {
  static const std::vector<CheckCase> cases = [] {
    std::vector<CheckCase> all;
    for (const auto group : {cases_of_points_and_ropes, cases_of_bodies, cases_of_soft_matter,
                             cases_of_surroundings_and_time, cases_of_promises, cases_of_couplings}) {
      const std::vector<CheckCase> some = group();
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }();
  return cases;
}

namespace {

CheckRow failed_row(const std::exception& failure) {
  return {.title = std::string("could not run: ") + failure.what(),
          .achieved = std::numeric_limits<double>::quiet_NaN()};
}

/// Methods by tolerance choose steps of their own, so they count as those without a limit of stability.
double laboratory_dt(const CheckCase& check, const std::string& stepper) {
  const auto info = lab::find_stepper(stepper);
  const bool unlimited = info && std::isinf(info.value().imaginary_limit);
  return unlimited && check.implicit_dt > 0 ? check.implicit_dt : check.laboratory_dt;
}

}  // namespace

std::vector<CheckRow> run_case(const CheckCase& check, const CheckSetting& setting) {
  std::vector<CheckRow> rows;
  CheckSetting own = setting;
  if (setting.laboratory()) own.dt = laboratory_dt(check, setting.stepper);
  try {
    rows = check.run(own);
  } catch (const Failure& failure) {
    rows = {failed_row(failure)};
    rows.back().failure = failure.code;
  } catch (const std::exception& failure) {
    rows = {failed_row(failure)};
  }
  for (CheckRow& row : rows) {
    if (!(row.dt > 0)) row.dt = own.dt;
    if (row.substeps == 0) row.substeps = setting.laboratory() ? 1 : setting.substeps;
    if (!setting.laboratory()) continue;
    if (row.goal > 0) row.tolerance = row.goal;
    row.solver = setting.stepper;
  }
  return rows;
}

const char* precision_name() {
  return sizeof(Real) == sizeof(double) ? "double" : "float";
}

}  // namespace hooke::check

/// Has the scenes of ground_truth.h. Each holds one object, and nothing that is without a law of force.

#include "validation/ground_truth.h"
#include "validation/rig.h"

#include <cmath>
#include <utility>

namespace hooke::check {

namespace {

World make_world(int substeps, WorldDesc desc = {}) {
  desc.substeps = substeps;
  return must(World::create(desc));
}

template <class IdType>
TruthStage stage_of(World world, IdType id) {
  const auto count = static_cast<std::uint32_t>(world.positions(id).size());
  return {.world = std::move(world),
          .positions = [id](const World& w) { return copy_points(w.positions(id)); },
          .last = point(id, count - 1)};
}

TruthStage with_particles(World world, const ParticlesDesc& desc) {
  const ParticlesId id = must(world.add_particles(desc));
  return stage_of(std::move(world), id);
}

TruthStage with_rope(World world, const RopeDesc& desc) {
  const RopeId id = must(world.add_rope(desc));
  return stage_of(std::move(world), id);
}

TruthStage with_cloth(World world, const ClothDesc& desc) {
  const ClothId id = must(world.add_cloth(desc));
  return stage_of(std::move(world), id);
}

TruthStage pendulum_stage(int substeps) {
  return with_particles(make_world(substeps), {.particles = {{}, {.position = {1, 0, 0}}},
                                               .springs = {{.a = 0, .b = 1, .stiffness = real(1e4)}},
                                               .pins = {{}}});
}

TruthStage double_pendulum_stage(int substeps) {
  return with_particles(
      make_world(substeps),
      {.particles = {{}, {.position = {1, 0, 0}}, {.position = {2, 0, 0}}},
       .springs = {{.a = 0, .b = 1, .stiffness = real(1e4)}, {.a = 1, .b = 2, .stiffness = real(1e4)}},
       .pins = {{}}});
}

TruthStage shaken_pendulum_stage(int substeps) {
  const MotionDesc shake{.kind = MotionDesc::Kind::kSine,
                         .amplitude = {real(0.2), real(0.1), real(0)},
                         .frequency_hz = real(0.7)};
  return with_particles(make_world(substeps),
                        {.particles = {{}, {.position = {0, -1, 0}}},
                         .springs = {{.a = 0, .b = 1, .stiffness = real(100), .damping = real(0.5)}},
                         .pins = {{.point = 0, .motion = shake}}});
}

TruthStage damped_oscillator_stage(int substeps) {
  return with_particles(
      make_world(substeps, weightless()),
      {.particles = {{}, {.position = {1.2, 0, 0}}},
       .springs = {{.a = 0, .b = 1, .stiffness = real(100), .damping = real(1), .rest_length = real(1)}},
       .pins = {{}}});
}

TruthStage hanging_rope_stage(int substeps) {
  return with_rope(make_world(substeps), {.direction = {real(0), real(-1), real(0)},
                                          .total_mass = real(0.5),
                                          .stiffness = real(50),
                                          .drag_coefficient = real(0)});
}

TruthStage stiff_rope_stage(int substeps) {
  return with_rope(make_world(substeps), {.direction = {real(1), real(0), real(0)},
                                          .stiffness = real(1e4),
                                          .inner_friction = real(2),
                                          .drag_coefficient = real(0)});
}

TruthStage soft_cloth_stage(int substeps) {
  return with_cloth(make_world(substeps), {.columns = 9,
                                           .rows = 9,
                                           .row_direction = {real(0), real(0), real(1)},
                                           .stretch_stiffness = real(200),
                                           .shear_stiffness = real(50),
                                           .damping = real(0.05),
                                           .drag_coefficient = real(0),
                                           .lift_coefficient = real(0),
                                           .pins = {{.point = 0}, {.point = 8}}});
}

TruthStage flag(int substeps) {
  WorldDesc desc;
  desc.wind.velocity = {real(4), real(0), real(2)};
  return with_cloth(make_world(substeps, desc), {.columns = 7,
                                                 .rows = 5,
                                                 .width = real(0.6),
                                                 .height = real(0.4),
                                                 .stretch_stiffness = real(500),
                                                 .shear_stiffness = real(100),
                                                 .damping = real(0.05),
                                                 .pins = {{.point = 0}, {.point = 28}}});
}

TruthStage planet_stage(int substeps) {
  World world = make_world(substeps, weightless());
  must(world.add_field({.kind = FieldDesc::Kind::kInverseSquare, .strength = 1}));
  return with_particles(std::move(world),
                        {.particles = {{.position = {0.4, 0, 0}, .velocity = {real(0), real(2), real(0)}}}});
}

TruthStage charge_stage(int substeps) {
  World world = make_world(substeps, weightless());
  must(world.add_field({.kind = FieldDesc::Kind::kMagnetic, .vector = {real(0), real(4), real(0)}}));
  return with_particles(std::move(world),
                        {.particles = {{.velocity = {real(1), real(0), real(0)}, .charge = real(1)}}});
}

}  // namespace

const std::vector<TruthScene>& ground_truth_scenes() {
  static const std::vector<TruthScene> scenes = {
      {"pendulum, k = 1e4 N/m, from the horizontal",
       "It falls g t h / 2 too far, as velocities move before positions: 0.1 cm after 0.1 s with "
       "h = 2 ms. Later that is a shift of the swing in time, which comes and goes with the "
       "speed.",
       pendulum_stage},
      {"double pendulum, k = 1e4 N/m, from the horizontal",
       "As the pendulum. Laid straight it is not yet chaotic in 3 s: the exact solution does not "
       "enlarge a displacement.",
       double_pendulum_stage},
      {"pendulum on a shaken pivot",
       "An implicit step brakes a spring by c + k h / 2 instead of c, here by a fifth more.",
       shaken_pendulum_stage},
      {"damped oscillator, zeta = 0.05",
       "The damping ratio is larger by omega h / 2, 0.06 instead of 0.05, as in case V5; it "
       "decays with the motion.",
       damped_oscillator_stage},
      {"hanging rope, K = 50 N/m, let go unstretched",
       "The rope jumps back and goes slack. Implicit steps damp the waves in it, and slack it is "
       "sensitive.",
       hanging_rope_stage},
      {"rope, K = 1e4 N/m, from the horizontal",
       "Chaos: its free end whips, and enlarges a displacement ten thousand times. After 1 s no "
       "step of this size is near; what both keep is in the figures of case I2 and not in the "
       "places of points.",
       stiff_rope_stage},
      {"soft cloth on two corners",
       "At first it falls by more than 3 with half the step: rows that share a point are solved one after "
       "the other, which gives each a compliance of about h^2 / m. Later the exact solution is sensitive, "
       "too.",
       soft_cloth_stage},
      {"small flag in an even wind",
       "Large from the first pictures on, and not of first order later: the forces of the air meet a light "
       "cloth, and then it flutters out of phase. Which part does what has not been taken apart.",
       flag},
      {"planet, e = 0.6",
       "It runs ahead along the right orbit, linearly in time: energy and axis stay, as in case "
       "V23.",
       planet_stage},
      {"charge in a magnetic field",
       "The velocity is turned exactly and the place follows it: the right circle, shifted by "
       "less than v h = 0.2 cm, for ever.",
       charge_stage},
  };
  return scenes;
}

}  // namespace hooke::check

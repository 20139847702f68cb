#include "fuzz/descs.h"

namespace hooke::fuzz {

namespace {

/// Over three powers of ten.
Real scaled(Random& random, double middle) {
  return static_cast<Real>(middle * random.pick<double>({0.03, 0.1, 0.3, 1, 3, 10, 30}));
}

std::vector<PinDesc> make_pins(Random& random, std::size_t points, Taste taste) {
  std::vector<PinDesc> pins;
  if (random.chance(0.4)) return pins;
  const int count = random.integer(1, 2);
  for (int i = 0; i < count; ++i) {
    const std::uint32_t point = i == 0 ? 0 : 1 + random.index(points - 1);
    pins.push_back({point, taste.may_drive && random.chance(0.3) ? make_motion(random) : MotionDesc{}});
  }
  return pins;
}

std::vector<LoadDesc> make_loads(Random& random, std::size_t points) {
  if (random.chance(0.7)) return {};
  return {{random.index(points), scaled(random, 0.3)}};
}

void make_bendy(Random& random, RopeDesc& rope, Taste taste) {
  rope.bend_stiffness = scaled(random, 1e-3);
  rope.bend_damping = random.real(0, 0.05);
  if (random.chance(0.4)) rope.twist_stiffness = scaled(random, 1e-3);
  if (taste.may_drive && random.chance(0.3)) rope.twist = random.real(-6, 6);
}

}  // namespace

WorldDesc make_world(Random& random, Taste taste) {
  WorldDesc desc;
  if (random.chance(0.15)) desc.gravity = {};
  if (random.chance(0.1)) desc.gravity = random.vector(20);
  if (!taste.may_drive) desc.gravity = {0, random.chance(0.1) ? Real(0) : Real(-9.81), 0};
  desc.substeps = random.pick<int>({1, 2, 4, 8, 8, 8, 12});
  desc.particle_substeps = random.pick<int>({1, 1, 1, 2, 3});
  desc.bias_sweeps = random.pick<int>({1, 1, 2});
  desc.sleeping = random.chance(0.8);
  if (taste.may_drive && random.chance(0.4)) desc.wind = make_wind(random);
  if (random.chance(0.2)) desc.wind.air_density = Real(0);
  return desc;
}

WindDesc make_wind(Random& random) {
  WindDesc wind;
  wind.velocity = random.vector(10);
  wind.gust = random.real(0, 1);
  wind.side_gust = random.real(0, 1);
  if (random.chance(0.2)) wind.gusts = WindDesc::Gusts::kPaper;
  return wind;
}

MotionDesc make_motion(Random& random) {
  MotionDesc motion;
  motion.kind = random.pick<MotionDesc::Kind>({MotionDesc::Kind::kStill, MotionDesc::Kind::kConstantVelocity,
                                               MotionDesc::Kind::kSine, MotionDesc::Kind::kKeyframes});
  motion.velocity = random.vector(1);
  motion.amplitude = random.vector(0.3);
  motion.frequency_hz = random.real(0, 3);
  motion.phase = random.real(-3, 3);
  double time = 0;
  const int frames = random.integer(1, 3);
  for (int i = 0; i < frames; ++i) {
    motion.keyframes.push_back(
        {time, i == 0 ? Vec3{} : random.vector(0.5)});  // a jump is as fast as it likes
    time += random.between(0.2, 1);
  }
  return motion;
}

ContactDesc make_contact(Random& random) {
  ContactDesc contact;
  contact.friction = random.real(0, 1);
  if (random.chance(0.2)) contact.static_friction = contact.friction + random.real(0, 0.5);
  if (random.chance(0.3)) contact.restitution = random.real(0, 1);
  if (random.chance(0.2)) contact.rolling_friction = random.real(0, 0.05);
  if (random.chance(0.2)) contact.spinning_friction = random.real(0, 0.05);
  return contact;
}

Shape make_simple_shape(Random& random) {
  const Real radius = random.real(0.05, 0.5);
  const Real half = random.real(0.05, 0.5);
  switch (random.below(5)) {
    case 0:
      return Shape::sphere(radius);
    case 1:
      return Shape::capsule(radius, half);
    case 2:
      return Shape::cylinder(radius, half);
    case 3:
      return Shape::cone(radius, half);
    default:
      return Shape::box({radius, half, random.real(0.02, 0.5)});
  }
}

BodyDesc make_body(Random& random, DVec3 place, const Meshes& meshes, Taste taste) {
  BodyDesc body;
  body.kind = random.chance(0.8) ? BodyKind::kDynamic : BodyKind::kStatic;
  body.shape = make_simple_shape(random);
  if (!meshes.solid.empty() && random.chance(0.25)) {
    const MeshId mesh = random.one_of(meshes.solid);
    body.shape = random.chance(0.5) ? Shape::hull_of(mesh) : Shape::of_mesh(mesh);
  }
  if (random.chance(0.15)) {
    body.shape = Shape::compound();
    const int parts = random.integer(1, 3);
    for (int i = 0; i < parts; ++i) {
      body.parts.push_back({.shape = make_simple_shape(random),
                            .position = random.vector(0.4),
                            .rotation = random.turn(),
                            .density = scaled(random, 1000),
                            .contact = make_contact(random)});
    }
  }
  body.position = place;
  body.rotation = random.turn();
  if (random.chance(0.5)) body.velocity = random.vector(4);
  if (random.chance(0.3)) body.angular_velocity = random.vector(8);
  body.density = scaled(random, 500);
  if (random.chance(0.2)) body.mass = scaled(random, 1);
  if (random.chance(0.2)) body.linear_damping = random.real(0, 2);
  if (random.chance(0.2)) body.angular_damping = random.real(0, 2);
  if (random.chance(0.2)) body.drag_coefficient = random.real(0, 1);
  body.contact = make_contact(random);
  body.bullet = random.chance(0.1);
  body.can_sleep = random.chance(0.9);
  body.sensor = random.chance(0.05);
  body.reports_contacts = random.chance(0.2);
  if (random.chance(0.2)) body.hit_speed = random.real(0, 2);
  if (random.chance(0.1)) body.filter = {.category = 1, .mask = 0xFFFFFFFF, .group = random.integer(-2, 2)};
  if (!taste.may_drive) return body;
  if (random.chance(0.1)) {
    body.kind = BodyKind::kKinematic;
    body.motion = make_motion(random);
  }
  if (random.chance(0.1)) body.gravity_scale = random.real(-1, 2);
  if (random.chance(0.1)) body.magnus_coefficient = random.real(0, 1);
  if (random.chance(0.1)) body.dipole_moment = random.vector(5);
  if (random.chance(0.1)) body.contact.surface_velocity = random.vector(1);
  return body;
}

RopeDesc make_rope(Random& random, DVec3 place, Taste taste) {
  RopeDesc rope;
  rope.hook_point = place;
  rope.direction = random.vector(1) + Vec3{0, Real(0.01), 0};
  rope.masses = random.integer(2, 24);
  rope.length_at_rest = random.real(0.2, 1.2);
  rope.total_mass = scaled(random, 0.3);
  if (random.chance(0.5)) rope.stiffness = scaled(random, 1e4);
  if (random.chance(0.3)) rope.inner_friction = scaled(random, 0.3);
  if (random.chance(0.3)) rope.air_friction = random.real(0, 1);
  if (random.chance(0.3)) rope.extension_max = random.real(0.01, 0.3);
  if (random.chance(0.2)) rope.strength = random.real(0.1, 500);
  if (random.chance(0.2)) rope.stiffness_of = RopeDesc::StiffnessOf::kSegment;
  if (random.chance(0.3)) make_bendy(random, rope, taste);
  rope.pins = make_pins(random, static_cast<std::size_t>(rope.masses), taste);
  rope.loads = make_loads(random, static_cast<std::size_t>(rope.masses));
  rope.radius = random.real(0.002, 0.03);
  if (random.chance(0.3)) rope.velocity = random.vector(2);
  rope.touches_ropes = random.chance(0.3);
  if (taste.may_drive && random.chance(0.1)) rope.repulsion_strength = random.real(0, 1e-5);
  if (taste.may_drive && random.chance(0.1)) rope.charge = random.real(-1, 1);
  rope.contact = make_contact(random);
  rope.touches_surfaces = random.chance(0.2);
  return rope;
}

ClothDesc make_cloth(Random& random, DVec3 place, const Meshes& meshes, Taste taste) {
  ClothDesc cloth;
  cloth.columns = random.integer(2, 8);
  cloth.rows = random.integer(2, 8);
  cloth.corner = place;
  cloth.width = random.real(0.2, 1);
  cloth.height = random.real(0.2, 1);
  if (random.chance(0.5)) cloth.row_direction = {0, 0, 1};
  std::size_t points = static_cast<std::size_t>(cloth.columns) * static_cast<std::size_t>(cloth.rows);
  if (!meshes.solid.empty() && random.chance(0.2)) {
    cloth.mesh = random.one_of(meshes.solid);
    cloth.position = place;
    cloth.rotation = random.turn();
    points = 6;
  }
  cloth.areal_density = scaled(random, 0.3);
  // More blows up what is light at any speed.
  if (cloth.mesh && random.chance(0.5))
    cloth.pressure = taste.may_drive ? cloth.areal_density * random.real(0, 1000) : Real(0);
  cloth.thickness = random.real(0.002, 0.03);
  cloth.stretch_stiffness = random.chance(0.2) ? kRigid : scaled(random, 3e3);
  cloth.shear_stiffness = random.chance(0.1) ? kRigid : scaled(random, 1e3);
  cloth.bend =
      random.pick<ClothDesc::Bend>({ClothDesc::Bend::kAngle, ClothDesc::Bend::kSpring, ClothDesc::Bend::kNone,
                                    ClothDesc::Bend::kIsometric, ClothDesc::Bend::kYarn});
  cloth.bend_stiffness = scaled(random, 1e-4);
  if (random.chance(0.5)) cloth.damping = random.real(0, 2);
  if (random.chance(0.3)) cloth.bend_damping = random.real(0, 0.1);
  if (random.chance(0.1)) cloth.yield_angle = random.real(0.2, 1);
  if (cloth.bend != ClothDesc::Bend::kAngle && cloth.bend != ClothDesc::Bend::kYarn)
    cloth.yield_angle = kRigid;
  if (random.chance(0.3)) cloth.extension_max = random.real(0.02, 0.3);
  cloth.tethers = random.chance(0.2);
  if (random.chance(0.3)) cloth.tear_strain = random.real(0.02, 0.5);
  cloth.pins = make_pins(random, points, taste);
  cloth.loads = make_loads(random, points);
  if (random.chance(0.3)) cloth.velocity = random.vector(2);
  cloth.contact = make_contact(random);
  return cloth;
}

SolidDesc make_solid(Random& random, DVec3 place, const Meshes& meshes) {
  SolidDesc solid;
  solid.cells = {random.integer(1, 3), random.integer(1, 3), random.integer(1, 3)};
  solid.size = {random.real(0.2, 0.8), random.real(0.2, 0.8), random.real(0.2, 0.8)};
  solid.position = place;
  solid.rotation = random.turn();
  if (!meshes.solid.empty() && random.chance(0.2)) {
    solid.mesh = random.one_of(meshes.solid);
    solid.cell = random.real(0.2, 0.4);
  }
  if (random.chance(0.3)) solid.elasticity = SolidDesc::Elasticity::kShapeMatching;
  solid.match_hz = random.chance(0.2) ? kRigid : random.real(1, 30);
  solid.match_damping_ratio = random.real(0, 1.5);
  solid.density = scaled(random, 500);
  solid.young_modulus = scaled(random, 3e4);
  solid.poisson_ratio = random.real(0, 0.499);
  solid.damping = random.real(0, 0.02);
  if (random.chance(0.1)) solid.yield_stress = scaled(random, 3e3);
  if (solid.elasticity == SolidDesc::Elasticity::kTetrahedra && random.chance(0.1))
    solid.strength = scaled(random, 3e3);
  if (random.chance(0.2)) solid.pins = {{0}};
  if (random.chance(0.3)) solid.velocity = random.vector(2);
  solid.contact = make_contact(random);
  return solid;
}

ParticlesDesc make_particles(Random& random, DVec3 place) {
  ParticlesDesc particles;
  const int count = random.integer(1, 10);
  for (int i = 0; i < count; ++i) {
    particles.particles.push_back({.position = place + random.place(0.5),
                                   .velocity = random.chance(0.3) ? random.vector(3) : Vec3{},
                                   .mass = scaled(random, 0.3),
                                   .radius = random.real(0.005, 0.05)});
  }
  for (int i = 0; i < count; ++i) {
    const std::uint32_t a = random.index(particles.particles.size());
    const std::uint32_t b = random.index(particles.particles.size());
    if (a == b || random.chance(0.3)) continue;
    particles.springs.push_back({a, b, random.chance(0.1) ? kRigid : scaled(random, 300),
                                 random.chance(0.5) ? random.real(0, 2) : Real(0)});
  }
  if (random.chance(0.3)) particles.direction = ParticlesDesc::Direction::kPredicted;
  if (random.chance(0.2)) particles.damping = ParticlesDesc::Damping::kIsotropic;
  if (random.chance(0.3)) particles.pins = {{random.index(particles.particles.size())}};
  particles.contact = make_contact(random);
  return particles;
}

FieldDesc make_field(Random& random, DVec3 place) {
  using Kind = FieldDesc::Kind;
  FieldDesc field;
  field.kind = random.pick<Kind>({Kind::kUniform, Kind::kInverseSquare, Kind::kMagnetic, Kind::kLiquid,
                                  Kind::kSuction, Kind::kVortex, Kind::kExplosion, Kind::kDipole});
  field.vector = random.vector(3) + Vec3{0, Real(0.1), 0};
  field.center = place;
  field.strength = random.between(-5, 10);
  field.reach = random.between(0.5, 5);
  field.falloff = random.integer(0, 3);
  field.height = random.between(-1, 2);
  field.density = random.between(0, 2000);
  field.drag = random.between(0, 3);
  field.time = random.between(0, 1);
  return field;
}

HookDesc make_hook(Random& random, DVec3 place, bool of_points, Taste taste) {
  HookDesc hook;
  hook.kind =
      of_points
          ? random.pick<HookKind>({HookKind::kBall, HookKind::kBall, HookKind::kDistance})
          : random.pick<HookKind>({HookKind::kBall, HookKind::kHinge, HookKind::kSlider, HookKind::kFixed,
                                   HookKind::kDistance, HookKind::kWheel, HookKind::kSixDegrees});
  hook.anchor = place;
  hook.axis = random.vector(1) + Vec3{0, Real(0.01), 0};
  if (hook.kind == HookKind::kDistance && random.chance(0.5)) hook.anchor_b = place + random.place(0.5);
  hook.collide = random.chance(0.3);
  if (random.chance(0.3)) hook.break_force = scaled(random, 100);
  if (random.chance(0.2)) hook.break_torque = scaled(random, 30);
  if (of_points) return hook;
  const bool limited =
      random.chance(0.3) && hook.kind != HookKind::kDistance && hook.kind != HookKind::kFixed;
  if (limited) hook.limits = {random.real(-1, 0), random.real(0, 1)};
  if (hook.kind == HookKind::kBall && random.chance(0.3)) hook.cone = random.real(0.1, 3);
  for (HookFreedom& freedom : hook.freedoms) freedom.locked = random.chance(0.5);
  if (!taste.may_drive) return hook;
  if (random.chance(0.3)) hook.motor = {random.real(-5, 5), scaled(random, 10)};
  if (random.chance(0.3)) hook.spring = {scaled(random, 100), random.real(0, 5), random.real(-0.3, 0.3)};
  return hook;
}

}  // namespace hooke::fuzz

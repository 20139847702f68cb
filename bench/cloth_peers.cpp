/// Compares scene "cloth" and a version with tethers with Bullet's soft body on the same list of points and
/// springs: the time of a step and how much the cloth stretches, in one run. It prints CSV:
///
///   engine,setting,ms_step_min,ms_step_median,mean_stretch,largest_stretch
///
/// The cloth has 100 x 100 points of 1 kg, spacing 2 cm, and two top corners held. Its 19 800 structural and
/// 19 602 shear springs are rigid, its 19 600 bend springs soft. It runs 600 steps of 1/60 s; stretch is that
/// of the structural springs after the last.

#include "hooke/hooke.h"

#include "cloth_list.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <algorithm>
#include <btBulletDynamicsCommon.h>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace hooke;

constexpr int kSteps = 600;
constexpr int kSide = 100;
constexpr double kSpacing = 0.02;

struct Times {
  double min = 0, median = 0;
};

Times time_steps(const std::function<void()>& step) {
  std::vector<double> ms;
  for (int i = 0; i < kSteps; ++i) {
    const auto start = std::chrono::steady_clock::now();
    step();
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(ms.begin(), ms.end());
  return {ms.front(), ms[ms.size() / 2]};
}

void print(const std::string& engine, const std::string& setting, Times times,
           const std::vector<DVec3>& points) {
  double sum = 0, largest = 0;
  int count = 0;
  const auto add = [&](std::size_t a, std::size_t b) {
    const double stretch = std::abs(length(points[a] - points[b]) / kSpacing - 1.0);
    sum += stretch;
    largest = std::max(largest, stretch);
    ++count;
  };
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t column = 0; column < kSide; ++column) {
      const std::size_t i = row * kSide + column;
      if (column + 1 < kSide) add(i, i + 1);
      if (row + 1 < kSide) add(i, i + kSide);
    }
  }
  std::printf("%s,%s,%.3f,%.3f,%.5f,%.4f\n", engine.c_str(), setting.c_str(), times.min, times.median,
              sum / count, largest);
}

void run_hooke(int substeps, bool tethers) {
  WorldDesc world_desc;
  world_desc.substeps = substeps;
  Result<World> created = World::create(world_desc);
  if (!created) return;
  World world = std::move(created).value();
  ClothDesc desc;
  desc.columns = desc.rows = kSide;
  desc.width = desc.height = static_cast<Real>(kSpacing * (kSide - 1));
  desc.total_mass = static_cast<Real>(kSide * kSide);
  desc.stretch_stiffness = desc.shear_stiffness = kRigid;
  desc.bend = ClothDesc::Bend::kSpring;
  desc.bend_stiffness = Real(1e4);
  desc.drag_coefficient = desc.lift_coefficient = Real(0);
  desc.pins = {{0}, {kSide - 1}};
  desc.tethers = tethers;
  const Result<ClothId> cloth = world.add_cloth(desc);
  if (!cloth) return;
  const Times times = time_steps([&] { world.step(Real(1) / Real(60)); });
  std::vector<DVec3> points;
  for (std::size_t i = 0; i < kSide * kSide; ++i) points.push_back(world.positions(cloth.value())[i]);
  print("hooke", std::to_string(substeps) + (tethers ? " substeps + tethers" : " substeps"), times, points);
}

void run_bullet(int iterations) {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broad_phase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world(&dispatcher, &broad_phase, &solver, &configuration);
  world.setGravity({0, btScalar(-9.81), 0});
  world.getWorldInfo().m_gravity = {0, btScalar(-9.81), 0};

  const bench::ClothList list = bench::cloth_100(kSide);
  std::vector<btVector3> points;
  std::vector<btScalar> masses;
  for (const auto& record : list.particles.position) {
    points.emplace_back(static_cast<btScalar>(record.x.x), static_cast<btScalar>(record.x.y),
                        static_cast<btScalar>(record.x.z));
  }
  for (const auto& record : list.particles.velocity) {
    masses.push_back(record.inverse_mass > Real(0) ? btScalar(1) : btScalar(0));
  }
  auto* cloth = new btSoftBody(&world.getWorldInfo(), kSide * kSide, points.data(), masses.data());
  btSoftBody::Material* rigid = cloth->appendMaterial();
  rigid->m_kLST = 1;
  btSoftBody::Material* soft = cloth->appendMaterial();
  soft->m_kLST = btScalar(0.1);
  for (int i = 0; i < list.springs.count(); ++i) {
    const bool bend = list.springs.kind[i] == state::SpringClass::kBend;
    cloth->appendLink(static_cast<int>(list.springs.particle_a[i]),
                      static_cast<int>(list.springs.particle_b[i]), bend ? soft : rigid);
  }
  cloth->m_cfg.piterations = iterations;
  cloth->m_cfg.collisions = 0;
  world.addSoftBody(cloth);
  const Times times = time_steps([&] { world.stepSimulation(btScalar(1) / 60, 0); });
  std::vector<DVec3> result;
  for (int i = 0; i < cloth->m_nodes.size(); ++i) {
    const btVector3& x = cloth->m_nodes[i].m_x;
    result.push_back({static_cast<double>(x.x()), static_cast<double>(x.y()), static_cast<double>(x.z())});
  }
  print("bullet", std::to_string(iterations) + " iterations", times, result);
  world.removeSoftBody(cloth);
  delete cloth;
}

}  // namespace

int main() {
  std::puts("engine,setting,ms_step_min,ms_step_median,mean_stretch,largest_stretch");
  for (const int substeps : {4, 5, 8, 16}) run_hooke(substeps, false);
  for (const int substeps : {2, 3, 4, 5, 8}) run_hooke(substeps, true);
  for (const int iterations : {5, 10, 20}) run_bullet(iterations);
  return 0;
}

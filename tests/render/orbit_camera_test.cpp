#include "render/orbit_camera.h"

#include <cmath>
#include <doctest/doctest.h>

using hooke::Vec3;
using hooke::render::Camera;
using hooke::render::OrbitCamera;

TEST_SUITE("render/orbit_camera") {
  TEST_CASE("an orbit camera starts where the camera was") {
    const Camera camera = {{3, 2, -5}, {0.5F, 1, 0}, {0, 1, 0}, 40};
    const Camera same = hooke::render::camera_of(hooke::render::make_orbit_camera(camera));
    CHECK(length(same.eye - camera.eye) < 1e-5F);
    CHECK(same.target == camera.target);
    CHECK(same.vertical_fov_deg == 40);
    const OrbitCamera degenerate = hooke::render::make_orbit_camera({{1, 1, 1}, {1, 1, 1}, {0, 1, 0}, 40});
    CHECK(degenerate.distance == 1);
  }

  TEST_CASE("turning keeps the distance and stops short of the poles") {
    OrbitCamera orbit = hooke::render::make_orbit_camera({{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 40});
    hooke::render::turn(orbit, 1.5708F, 0);
    CHECK(length(hooke::render::camera_of(orbit).eye - Vec3{4, 0, 0}) < 1e-3F);
    hooke::render::turn(orbit, 0, 100);
    const Vec3 eye = hooke::render::camera_of(orbit).eye;
    CHECK(length(eye) == doctest::Approx(4));
    CHECK(eye.y < 4);
    CHECK(eye.y > 3.99F);
  }

  TEST_CASE("panning by the picture's height moves the scene by what the picture shows") {
    OrbitCamera orbit = hooke::render::make_orbit_camera({{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 90});
    // At 90 degrees and 4 m the picture is 8 m high.
    hooke::render::pan(orbit, 0.5F, -0.25F);
    CHECK(length(orbit.target - Vec3{-4, 2, 0}) < 1e-4F);
  }

  TEST_CASE("zooming multiplies the distance within limits") {
    OrbitCamera orbit;
    hooke::render::zoom(orbit, 0.5F);
    CHECK(orbit.distance == doctest::Approx(2.5));
    hooke::render::zoom(orbit, 0);
    CHECK(orbit.distance > 0);
  }
}

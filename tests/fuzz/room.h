#pragma once

#include "hooke/scene_io.h"

#include "fuzz/random.h"
#include "scenes/scene_builder.h"

#include <string>

/// \file
/// Random rooms: a floor, four walls, and assemblies of bodies, hooks, ropes, cloths and jellies that stand
/// in cells of the floor, with more that falls on them. Nothing overlaps at the start. What a room holds is
/// what a game or a film would put there; masses differ by up to a thousand times.

namespace hooke::fuzz {

/// What an assembly is made with.
struct RoomMaker {
  Random random;                       ///< Of this assembly alone: others stay the same whatever it takes.
  test::SceneBuilder* room = nullptr;  ///< Counts places from the middle of the cell's floor.
  double light = 1;                    ///< Mass of what carries [kg].
  double heavy = 1;                    ///< Mass of what is carried [kg], up to a thousand times as much.
};

/// Adds a sphere, a capsule, a cylinder, a box or a hull of about `size`, turned anyhow.
std::string add_lump(RoomMaker& maker, DVec3 place, double size, double mass);

// Assemblies, each in its file by what carries: contacts, hooks, or what is soft.
void make_stack(RoomMaker& maker);
void make_pyramid(RoomMaker& maker);
void make_table(RoomMaker& maker);
void make_rollers(RoomMaker& maker);
void make_gripper(RoomMaker& maker);

void make_chain(RoomMaker& maker);
void make_arm(RoomMaker& maker);
void make_seesaw(RoomMaker& maker);
void make_springs(RoomMaker& maker);
void make_ragdoll(RoomMaker& maker);
void make_cart(RoomMaker& maker);
void make_ball_net(RoomMaker& maker);

void make_bridge(RoomMaker& maker);
void make_pulley(RoomMaker& maker);
void make_hanging_load(RoomMaker& maker);
void make_rope_net(RoomMaker& maker);
void make_hammock(RoomMaker& maker);
void make_covered_box(RoomMaker& maker);
void make_jelly(RoomMaker& maker);

/// Makes a room. The same numbers make the same room on every machine.
[[nodiscard]] Scene make_room(Random& random);
/// Makes a room of so many cells, whose scene runs for `seconds` [s].
[[nodiscard]] Scene make_room(Random& random, int columns, int rows, double seconds);

}  // namespace hooke::fuzz

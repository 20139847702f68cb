#pragma once

#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <string_view>

/// \file
/// Shows what a World knows besides where things are: what presses where, how fast things move, what pulls,
/// what rests. World::debug_draw hands it out as lines, points, triangles and texts, which a program draws
/// with a renderer of its own.

namespace hooke {

/// What a shape of a debug picture tells of.
enum class DebugSubject : std::uint8_t {
  kContacts,    ///< Where bodies, points and elements press on each other, with normals and forces.
  kVelocities,  ///< Velocities of centers of mass and of points.
  kBounds,      ///< Boxes along the axes, around each shape of a body and around each deformable.
  kLoads,       ///< Tensions of ropes, strains of cloths, solids and springs, as colors.
  kHooks,       ///< Places of hooks, gaps, and the axes of the first end.
  kSleep,       ///< Which dynamic bodies sleep.
  kRoutes,      ///< Which way contacts and hooks are solved, as lines between centers of mass.
};

/// A color as a paint program shows it (sRGB), each share from 0 to 1.
struct DebugColor {
  float r = 1;                                                         ///< Red.
  float g = 1;                                                         ///< Green.
  float b = 1;                                                         ///< Blue.
  friend constexpr bool operator==(DebugColor, DebugColor) = default;  ///< Whether all shares are equal.
};

/// The color of a load: blue at -1, the largest pressure, over white at 0 to red at 1, the largest pull.
/// Shares beyond count as -1 or 1; NaN is black. There are 129 colors in all, so that triangles of one color
/// can be drawn together.
[[nodiscard]] DebugColor load_color(double share);

/// Receives the shapes of a debug picture. Places are in the world [m]. The calls come in an order that is
/// the same for equal worlds. They may read the World, and must not change it.
class DebugDraw {
 public:
  /// Destroys the receiver.
  virtual ~DebugDraw() = default;
  /// Draws a line.
  virtual void line(DebugSubject subject, DVec3 from, DVec3 to, DebugColor color) = 0;
  /// Draws a point.
  virtual void point(DebugSubject subject, DVec3 place, DebugColor color) = 0;
  /// Draws a triangle, which is seen from both sides.
  virtual void triangle(DebugSubject subject, const std::array<DVec3, 3>& corners, DebugColor color) = 0;
  /// Writes a text of ASCII beside a place. It is valid during the call.
  virtual void text(DebugSubject subject, DVec3 place, std::string_view text, DebugColor color) = 0;
};

/// What is drawn, and how large.
struct DebugDrawDesc {
  bool contacts = true;     ///< DebugSubject::kContacts.
  bool velocities = false;  ///< DebugSubject::kVelocities.
  bool bounds = false;      ///< DebugSubject::kBounds.
  bool loads = false;       ///< DebugSubject::kLoads.
  bool hooks = false;       ///< DebugSubject::kHooks.
  bool sleep = false;       ///< DebugSubject::kSleep.
  bool routes = false;      ///< DebugSubject::kRoutes.
  /// Whether forces of contacts and hooks, speeds, the largest load of each object and "asleep" are written.
  bool texts = false;
  double meters_per_newton = 1e-3;  ///< Length of the arrow of a force [m/N]. [0, 1e6]
  double seconds = 0.1;             ///< The arrow of a velocity is the way in this time [s]. [0, 1e6]
  double axis_length = 0.1;  ///< Length of the axes of hooks and of the normals of contacts [m]. [0, 1e6]
  double full_tension = 0;   ///< Tension of full red [N], not negative; 0: the largest there is.
  double full_strain = 0;    ///< Strain of full red, not negative; 0: the largest there is.
};

/// What a debug picture has drawn: its legend.
struct DebugDrawLegend {
  double full_tension = 0;  ///< Tension of full red, and thrust of full blue [N]; 0 if nothing pulls.
  double full_strain = 0;   ///< Strain of full red; the same, pressed together, is full blue.
  double tension = 0;       ///< The largest tension or thrust of a segment of a rope [N].
  /// The largest strain by size: a principal strain of a triangle of cloth or of a tetrahedron, or the
  /// extension of a spring over its length.
  double strain = 0;
  double force = 0;            ///< The largest force along the normal of a contact [N].
  double speed = 0;            ///< The largest speed that was drawn [m/s].
  std::uint32_t contacts = 0;  ///< How many contacts were drawn.
  std::uint32_t asleep = 0;    ///< How many dynamic bodies sleep, if kSleep was drawn.
};

/// A way of solving and its color, for a legend of DebugSubject::kRoutes.
struct DebugRoute {
  std::string_view name = {};  ///< As debug_routes_of_contacts and debug_routes_of_hooks list them.
  DebugColor color = {};       ///< Color of its lines.
};

/// The ways in which contacts are solved: soft, direct, coupled.
[[nodiscard]] std::array<DebugRoute, 3> debug_routes_of_contacts();
/// The ways in which hooks are solved: tree, approximate tree, loop, block, iterative, coupled.
[[nodiscard]] std::array<DebugRoute, 6> debug_routes_of_hooks();

}  // namespace hooke

#include "hooke/scene_io.h"

namespace hooke {

namespace {

constexpr const char* kEmpty = R"({
  // A scene of nothing yet. Units are SI: meters, kilograms, seconds, newtons; y points up.
  "version": 1,
  "title": "Empty",
  "seconds": 10,

  "materials": {
    "ground": {"color": [0.35, 0.38, 0.35], "friction": 0.6}
  },

  "bodies": [
    {"name": "ground", "material": "ground", "shape": {"half_space": {}}}
  ],

  // Add "ropes", "cloths", "particles", "fields" here.

  "camera": {"eye": [2, 1.5, 4], "target": [0, 1, 0]}
}
)";

constexpr const char* kRope = R"({
  // A rope that hangs from a hook and swings. Units are SI; y points up.
  "version": 1,
  "title": "Rope",
  "seconds": 10,

  "materials": {
    "ground": {"color": [0.35, 0.38, 0.35], "friction": 0.6},
    "hemp": {"color": [0.62, 0.48, 0.28], "shininess": 8, "friction": 0.7}
  },

  "bodies": [
    {"name": "ground", "material": "ground", "shape": {"half_space": {}}}
  ],

  "ropes": [
    {
      "name": "rope",
      "material": "hemp",
      "hook_point": [0, 2.5, 0],
      "direction": [-1, 0, 0],      // laid out flat to the left, so that it swings down
      "length_at_rest": 1.5,        // [m]
      "total_mass": 0.3,            // [kg]
      "masses": 32,                 // number of points; the rope is as stiff with 8 or 800
      "stiffness": "rigid",         // or a number [N/m]
      "air_friction": 0.02,         // [N s/m]
      "radius": 0.012,              // [m]
      "loads": [{"point": "last", "mass": 0.5}]
    }
  ],

  "camera": {"eye": [0.5, 1.8, 4.5], "target": [0, 1.5, 0]},

  // Figures that `hooke run` holds the scene to.
  "expect": [
    {"quantity": "largest_stretch", "op": "<", "value": 0.01}
  ]
}
)";

constexpr const char* kFlag = R"({
  // A flag on a pole in gusty wind. Units are SI; y points up.
  "version": 1,
  "title": "Flag",
  "seconds": 10,

  "world": {
    "wind": {
      "velocity": [6, 0, 0],        // mean wind [m/s]
      "gust": 0.5,                  // it varies by half of that along its direction
      "side_gust": 0.2              // and by a fifth across
    }
  },

  "materials": {
    "ground": {"color": [0.35, 0.38, 0.35], "friction": 0.6},
    "steel": {"color": [0.7, 0.72, 0.75], "shininess": 80, "friction": 0.3},
    "silk": {"color": [0.75, 0.1, 0.12], "shininess": 40, "friction": 0.3}
  },

  "bodies": [
    {"name": "ground", "material": "ground", "shape": {"half_space": {}}},
    {"name": "pole", "material": "steel", "shape": {"box": {"half_extents": [0.02, 1.5, 0.02]}},
     "position": [-0.03, 1.5, 0], "collides": false}
  ],

  "cloths": [
    {
      "name": "flag",
      "material": "silk",
      "columns": 31, "rows": 21,    // points; point 0 is at the corner
      "corner": [0, 3, 0],
      "width": 1.5, "height": 1,    // [m]
      "areal_density": 0.1,         // [kg/m^2]
      "tethers": true,              // silk does not stretch
      "pins": [{"column": 0}]       // the edge at the pole
    }
  ],

  "camera": {"eye": [0.8, 2, 4.5], "target": [0.6, 2, 0]},

  // Figures that `hooke run` holds the scene to.
  "expect": [
    {"quantity": "lowest", "of": "flag", "op": ">", "value": 0.5}
  ]
}
)";

}  // namespace

std::optional<std::string> starter_scene(std::string_view kind) {
  if (kind == "empty") return kEmpty;
  if (kind == "rope") return kRope;
  if (kind == "flag") return kFlag;
  return std::nullopt;
}

}  // namespace hooke

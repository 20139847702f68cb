#include "hooke/scene_io.h"

#include <doctest/doctest.h>

namespace {

struct BadScene {
  const char* text;
  std::vector<const char*> lines;  ///< Without the name of the file.
};

const BadScene kBadScenes[] = {
    {R"()", {"1:1: not JSON: unexpected end of input; expected '[', '{', or a literal"}},
    {R"({)", {"1:2: not JSON: unexpected end of input; expected string literal"}},
    {R"({"version": 1,})",
     {"1:15: not JSON: unexpected '}'; expected string literal; a comma stands before it"}},
    {R"([])", {"1:1: is a list, must be an object"}},
    {R"(nul)", {"1:4: not JSON: invalid literal"}},
    {R"({"version": NaN})", {"1:13: not JSON: invalid literal"}},
    {R"({"version": 1e999})", {"1:13: '1e999' is too large for a number"}},
    {R"({"version": 2})", {"1:13: version: 2 is newer than this program, which reads version 1"}},
    {R"({})", {"1:1: needs 'version'"}},
    {R"({"version": 1} x)", {"1:16: not JSON: invalid literal; expected end of input"}},
    {"{\"version\": 1, \"title\": \"\xff\"}", {"1:26: not JSON: invalid string: ill-formed UTF-8 byte"}},
    {R"({"version": 1, "title": "abc)", {"1:29: not JSON: invalid string: missing closing quote"}},
    {R"({"version": 1 /* )", {"1:18: not JSON: invalid comment; missing closing '*/'; expected '}'"}},
    {R"({"version": 1, "version": 1})", {"1:16: version: this key is given twice"}},
    {R"({"version": 1, "dt": "1/60"})",
     {"1:22: dt: '1/60' is a string, must be a number (in s, without a unit)"}},
    {R"({"version": 1, "dt": 0})", {"1:22: dt: 0 is out of range, must be greater than 0 and at most 1"}},
    {R"({"version": 1, "dt": -1e-3})",
     {"1:22: dt: -1e-3 is out of range, must be greater than 0 and at most 1"}},
    {R"({"version": 1, "accuracy": {"max_error": 0}})",
     {"1:42: accuracy.max_error: 0 is out of range, must be greater than 0"}},
    {R"({"version": 1, "laboratory": {"rollback": "guess"}})",
     {"1:43: laboratory.rollback: 'guess' is not one of 'halving', 'backward', 'event', 'advancement'"}},
    {R"({"version": 1, "laboratory": {"epsilon": 0}})",
     {"1:42: laboratory.epsilon: 0 is out of range, must be 1e-12 to 1"}},
    {R"({"version": 1, "accuracy": {}})", {"1:28: accuracy: needs 'max_error'"}},
    {R"({"version": 1, "ropes": [{"stepper": ""}]})", {"1:38: ropes[0].stepper: must not be empty"}},
    {R"({"version": 1, "bodies": [{"shape": {"half_space": {}}, "stepper": "rk4"}]})",
     {"1:57: bodies[0].stepper: unknown key"}},
    {R"({"version": 1, "dt": null})", {"1:22: dt: is null, must be a number"}},
    {R"({"version": 1, "world": {"substeps": 2.5}})", {"1:38: world.substeps: must be a whole number"}},
    {R"({"version": 1, "world": {"gravity": [0, -9.81]}})",
     {"1:37: world.gravity: has 2 elements, must have 3"}},
    {R"({"version": 1, "world": {"gravity": [0, "-9.81 m/s2", 0]}})",
     {"1:41: world.gravity[1]: '-9.81 m/s2' is a string, must be a number (in m/s^2, without a unit)"}},
    {R"({"version": 1, "world": {"gravity": [0, 1e39, 0]}})",
     {"1:41: world.gravity[1]: is too large for a number of this precision"}},
    {R"({"version": 1, "world": {"wind": {"gusts": "weak"}}})",
     {"1:44: world.wind.gusts: 'weak' is not one of 'smooth', 'paper'"}},
    {R"({"version": 1, "ropes": {}})", {"1:25: ropes: is an object, must be a list"}},
    {R"({"version": 1, "ropes": [{"masses": 1}]})",
     {"1:37: ropes[0].masses: 1 is out of range, must be 2 to 65536"}},
    {R"({"version": 1, "ropes": [{"masses": 1000000000}]})",
     {"1:37: ropes[0].masses: 1000000000 is out of range, must be 2 to 65536"}},
    {R"({"version": 1, "ropes": [{"mases": 3}]})",
     {"1:27: ropes[0].mases: unknown key, did you mean 'masses'?"}},
    {R"({"version": 1, "ropes": [{"total_mass": "5 kg"}]})",
     {"1:41: ropes[0].total_mass: '5 kg' is a string, must be a number (in kg, without a unit)"}},
    {R"({"version": 1, "ropes": [{"stiffness": 0}]})",
     {R"(1:40: ropes[0].stiffness: 0 is out of range, must be greater than 0 or "rigid")"}},
    {R"({"version": 1, "ropes": [{"stiffness": "stiff"}]})",
     {R"(1:40: ropes[0].stiffness: 'stiff' is a string, must be a number or "rigid" (in N/m,)"
      R"( without a unit))"}},
    {R"({"version": 1, "ropes": [{"pins": [16]}]})",
     {"1:36: ropes[0].pins[0]: 16 is out of range, must be 0 to 15"}},
    {R"({"version": 1, "ropes": [{"pins": [{"row": 0}]}]})",
     {"1:44: ropes[0].pins[0].row: is for the grid of a cloth only"}},
    {R"({"version": 1, "ropes": [{"pins": [{"point": 0, "topmost": 1}]}]})",
     {"1:49: ropes[0].pins[0].topmost: cannot stand beside 'point'"}},
    {R"({"version": 1, "ropes": [{"pins": [{"motion": {}}]}]})",
     {"1:36: ropes[0].pins[0]: needs one of 'point', 'column', 'row', 'topmost'",
      "1:47: ropes[0].pins[0].motion: needs one of 'velocity', 'sine', 'keyframes'"}},
    {R"({"version": 1, "ropes": [{"pins": ["first"]}]})",
     {R"(1:36: ropes[0].pins[0]: 'first' is not an index or "last")"}},
    {R"({"version": 1, "ropes": [{"material": "sil"}], "materials": {"silk": {}}})",
     {"1:39: ropes[0].material: there is no material 'sil', did you mean 'silk'?"}},
    {R"({"version": 1, "ropes": [{"name": "a"}, {"name": "a"}]})",
     {"1:50: ropes[1].name: 'a' is already the name of ropes[0]"}},
    {R"({"version": 1, "ropes": [{"name": "a[0]"}]})",
     {"1:35: ropes[0].name: 'a[0]' has a character that a name must not have ([ ] . or control)"}},
    {R"({"version": 1, "cloths": [{"columns": 4096, "rows": 4096}]})",
     {"1:27: cloths[0]: with this object the scene has more than 1000000 points"}},
    {R"({"version": 1, "cloths": [{"mesh": "lantern"}]})",
     {"1:36: cloths[0].mesh: there is no mesh 'lantern'"}},
    {R"({"version": 1, "bodies": [{"name": "ball"}]})", {"1:27: bodies[0]: needs 'shape'"}},
    {R"({"version": 1, "bodies": [{"shape": {"ball": {}}}]})",
     {"1:37: bodies[0].shape: needs one of 'half_space', 'sphere', 'box', 'capsule', 'cylinder', "
      "'cone', 'mesh', 'hull', 'parts'",
      "1:38: bodies[0].shape.ball: unknown key, did you mean 'hull'?"}},
    {R"({"version": 1, "bodies": [{"shape": {"sphere": {"radius": -1}}}]})",
     {"1:59: bodies[0].shape.sphere.radius: -1 is out of range, must be greater than 0"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "rotation": [0, 0, 0, 0]}]})",
     {"1:62: bodies[0].rotation: a quaternion must not be zero"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "collides": 1}]})",
     {"1:62: bodies[0].collides: is a number, must be true or false"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "array": {"grid": [1000, 1000, 2]}}]})",
     {"1:27: bodies[0]: with this object the scene has more than 1000000 points"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "array": {"random": 2, "spacing": [1, 1, 1]}}]})",
     {"1:73: bodies[0].array.spacing: has no effect on a random array"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "array": {"list": [[0, 0, 0]], "spacing": [1, 1, 1]}}]})",
     {"1:81: bodies[0].array.spacing: has no effect on a list"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "array": {"list": []}}]})",
     {"1:68: bodies[0].array.list: has 0 elements, must have at least 1"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "array": {"grid": [1, 1, 1], "rotations": []}}]})",
     {"1:79: bodies[0].array.rotations: is for a list only"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "array": {"list": [[0, 0, 0], [1, 0, 0]],)"
     R"( "rotations": [[0, 0, 0, 1]]}}]})",
     {"1:59: bodies[0].array: there are 1 rotations for a list of 2"}},
    {R"({"version": 1, "ropes": [{"array": {"list": [[0, 0, 0]], "rotations": [[0, 0, 0, 1]]}}]})",
     {"1:26: ropes[0]: only an array of bodies has 'rotations'"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "kind": "moving"}]})",
     {"1:58: bodies[0].kind: 'moving' is not one of 'static', 'kinematic', 'dynamic'"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "density": -1}]})",
     {"1:61: bodies[0].density: -1 is out of range, must be greater than 0"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "mass": 0}]})",
     {"1:58: bodies[0].mass: 0 is out of range, must be greater than 0"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "linear_damping": -1, "angular_damping": -2}]})",
     {"1:68: bodies[0].linear_damping: -1 is out of range, must be at least 0",
      "1:91: bodies[0].angular_damping: -2 is out of range, must be at least 0"}},
    {R"({"version": 1, "bodies": [{"shape": {"box": {}}, "mask": -1}]})",
     {"1:58: bodies[0].mask: -1 is out of range, must be 0 to 4294967295"}},
    {R"({"version": 1, "bodies": [{"shape": {"cone": {"half_height": 0}}}]})",
     {"1:62: bodies[0].shape.cone.half_height: 0 is out of range, must be greater than 0"}},
    {R"({"version": 1, "bodies": [{"shape": {"hull": "rok"}}], "meshes": {"rock": {"file": "rock.obj"}}})",
     {"1:46: bodies[0].shape.hull: there is no mesh 'rok', did you mean 'rock'?"}},
    {R"({"version": 1, "bodies": [{"shape": {"parts": []}}]})",
     {"1:47: bodies[0].shape.parts: has 0 elements, must have at least 1"}},
    {R"({"version": 1, "bodies": [{"shape": {"parts": [{"shape": {"parts": []}}]}}]})",
     {"1:58: bodies[0].shape.parts[0].shape: needs one of 'half_space', 'sphere', 'box', 'capsule', "
      "'cylinder', 'cone', 'mesh', 'hull'",
      "1:59: bodies[0].shape.parts[0].shape.parts: unknown key"}},
    {R"({"version": 1, "bodies": [{"shape": {"parts": [{"shape": {"hull": "rock"}, "material": "coton"}]}}]})",
     {"1:67: bodies[0].shape.parts[0].shape.hull: there is no mesh 'rock'",
      "1:88: bodies[0].shape.parts[0].material: there is no material 'coton', did you mean 'cotton'?"}},
    {R"({"version": 1, "bodies": [{"shape": {"parts": [{"shape": {"box": {}}, "density": 0}, {}]}}]})",
     {"1:82: bodies[0].shape.parts[0].density: 0 is out of range, must be greater than 0",
      "1:86: bodies[0].shape.parts[1]: needs 'shape'"}},
    {R"({"version": 1, "bodies": [{"shape": {"parts": [{"shape": {"box": {}}}, {"shape": {"box": {}}}]},)"
     R"( "array": {"grid": [1000, 501, 1]}}]})",
     {"1:27: bodies[0]: with this object the scene has more than 1000000 points"}},
    {R"({"version": 1, "materials": {"ice": {"restitution": 2, "static_friction": -1, "rolling_friction": -1}}})",
     {"1:53: materials.ice.restitution: 2 is out of range, must be 0 to 1",
      "1:75: materials.ice.static_friction: -1 is out of range, must be 0 to 100",
      "1:99: materials.ice.rolling_friction: -1 is out of range, must be at least 0"}},
    {R"({"version": 1, "materials": {"ice": {}}, "material_pairs": [{"a": "ice", "b": "stel"}]})",
     {"1:79: material_pairs[0].b: there is no material 'stel', did you mean 'steel'?"}},
    {R"({"version": 1, "materials": {"ice": {}}, "material_pairs": [{"a": "ice"}]})",
     {"1:61: material_pairs[0]: needs 'b'"}},
    {R"({"version": 1, "world": {"contact_hz": 0, "bias_sweeps": 9}})",
     {"1:40: world.contact_hz: 0 is out of range, must be 0.1 to 1000",
      "1:58: world.bias_sweeps: 9 is out of range, must be 1 to 8"}},
    {R"({"version": 1, "ropes": [{"name": "r"}], "expect": [{"quantity": "tilt", "of": "r", "op": "<", "value": 1}]})",
     {"1:80: expect[0].of: 'r' is not a body"}},
    {R"({"version": 1, "expect": [{"quantity": "asleep", "of": "r", "op": "<", "value": 1}]})",
     {"1:56: expect[0].of: this quantity is measured on the whole world, without 'of'"}},
    {R"({"version": 1, "particles": [{}]})", {"1:30: particles[0]: needs 'particles'"}},
    {R"({"version": 1, "particles": [{"particles": []}]})",
     {"1:44: particles[0].particles: has 0 elements, must have at least 1"}},
    {R"({"version": 1, "particles": [{"particles": [{"position": [0, 0, 0]}],)"
     R"( "springs": [{"a": 0, "b": 1}]}]})",
     {"1:97: particles[0].springs[0].b: 1 is out of range, must be 0 to 0"}},
    {R"({"version": 1, "meshes": {"m": {}}})",
     {"1:32: meshes.m: needs either 'file' or 'vertices' and 'triangles'"}},
    {R"({"version": 1, "meshes": {"m": {"file": "../m.obj"}}})",
     {"1:41: meshes.m.file: '../m.obj' is outside of the scene's folder"}},
    {R"({"version": 1, "meshes": {"m": {"file": "/etc/passwd"}}})",
     {"1:41: meshes.m.file: '/etc/passwd' is outside of the scene's folder"}},
    {R"({"version": 1, "meshes": {"m": {"vertices": [[0, 0, 0]], "triangles": [[0, 1, 2]]}}})",
     {"1:32: meshes.m: a triangle has the corner 2, there are 1 vertices"}},
    {R"({"version": 1, "materials": {"m": {"color": [2, 0, 0]}}})",
     {"1:46: materials.m.color[0]: 2 is out of range, must be 0 to 1"}},
    {R"({"version": 1, "timeline": [{"at_step": -1, "remove": "x"}]})",
     {"1:41: timeline[0].at_step: -1 is out of range, must be 0 to 4294967295"}},
    {R"({"version": 1, "timeline": [{"at_step": 1, "remove": "x"}]})",
     {"1:54: timeline[0].remove: there is no object 'x'"}},
    {R"({"version": 1, "timeline": [{"at_step": 1}]})",
     {"1:29: timeline[0]: needs one of 'add', 'remove', 'motion', 'unpin', 'force', 'impulse', 'velocity', "
      "'motor', 'spring', 'steering', 'wind', 'gravity'"}},
    {R"({"version": 1, "bodies": [{"name": "b", "shape": {"box": {}}}],)"
     R"( "timeline": [{"at_step": 1, "impulse": {"object": "b", "impulse": [1, 0, 0]}}]})",
     {"1:115: timeline[0].impulse.object: 'b' is not dynamic: nothing pushes it"}},
    {R"({"version": 1, "bodies": [{"name": "b", "shape": {"box": {}}}],)"
     R"( "timeline": [{"at_step": 1, "velocity": {"object": "b", "velocity": [1, 0, 0]}}]})",
     {"1:116: timeline[0].velocity.object: 'b' is static: it never moves"}},
    {R"({"version": 1, "bodies": [{"name": "b", "kind": "dynamic", "shape": {"box": {}}}],)"
     R"( "timeline": [{"at_step": 1, "motion": {"object": "b"}}]})",
     {"1:133: timeline[0].motion.object: 'b' is not kinematic: only such a body moves as told"}},
    {R"({"version": 1, "bodies": [{"name": "b", "kind": "kinematic", "shape": {"box": {}}, )"
     R"("motion": {"velocity": [1, 0, 0]}}], "timeline": [)"
     R"({"at_step": 1, "velocity": {"object": "b", "velocity": [1, 0, 0]}}]})",
     {"1:172: timeline[0].velocity.object: 'b' moves by its 'motion', which gives its velocity"}},
    {R"({"version": 1, "ropes": [{"name": "r"}], "timeline": [{"at_step": 1, "force": {"object": "r",)"
     R"( "force": [1, 0, 0]}}]})",
     {"1:79: timeline[0].force: needs 'point': 'r' is no body"}},
    {R"({"version": 1, "ropes": [{"name": "r"}], "timeline": [{"at_step": 1, "motor": {"object": "r",)"
     R"( "max_force": 1}}]})",
     {"1:90: timeline[0].motor.object: 'r' is not a hook"}},
    {R"({"version": 1, "bodies": [{"name": "b", "kind": "dynamic", "shape": {"box": {}}}],)"
     R"( "hooks": [{"name": "h", "kind": "fixed", "b": "b", "anchor": [0, 0, 0]}],)"
     R"( "timeline": [{"at_step": 1, "motor": {"object": "h", "max_force": 1}}]})",
     {"1:206: timeline[0].motor.object: 'h' is a hook of a kind that has none"}},
    {R"({"version": 1, "bodies": [{"name": "b", "kind": "dynamic", "shape": {"box": {}}}],)"
     R"( "timeline": [{"at_step": 1, "velocity": {"object": "b"}}]})",
     {"1:124: timeline[0].velocity: needs 'velocity' or 'angular_velocity'"}},
    {R"({"version": 1, "camera": {"path": [{"time": 1, "eye": [0, 0, 0], "target": [0, 0, 1]},)"
     R"( {"time": 1, "eye": [0, 0, 0], "target": [0, 0, 1]}]}})",
     {"1:26: camera: the times of the path must increase; keyframe 1 does not"}},
    {R"({"version": 1, "lights": [{}, {}, {}, {}, {}, {}, {}, {}, {}]})",
     {"1:26: 'lights': a scene has at most 8, not 9"}},
    {R"({"version": 1, "lights": [{}, {"kind": "spot"}, {}]})",
     {"1:26: 'lights': their shadows need 13 maps, of which there are 12: six for a point light, one for any "
      "other; set 'shadows' of some to false"}},
    {R"({"version": 1, "lights": [{"kind": "spot", "outer_deg": 10}, {"direction": [0, 0, 0]}]})",
     {"1:27: lights[0]: 'inner_deg' must be less than 'outer_deg'",
      "1:62: lights[1]: 'direction' must not be zero"}},
    {R"({"version": 1, "sky": {"sun_direction": [0, 0, 0]}})",
     {"1:23: sky: 'sun_direction' must not be zero"}},
    {R"({"version": 1, "ropes": [{}], "expect": [{"quantity": "height", "of": "ropes[0]",)"
     R"( "op": "<", "value": 1}]})",
     {"1:42: expect[0]: this quantity needs 'point'"}},
    {R"({"version": 1, "ropes": [{}], "expect": [{"quantity": "height", "of": "ropes[0]",)"
     R"( "point": 16, "op": "<", "value": 1}]})",
     {"1:92: expect[0].point: 16 is out of range, must be 0 to 15"}},
    {R"({"version": 1, "expect": [{"quantity": "tension", "op": "<", "value": 1}]})",
     {"1:27: expect[0]: this quantity needs 'of', the name of an object"}},
    {R"({"version": 1, "expect": [{"quantity": "weight", "op": "<", "value": 1}]})",
     {"1:40: expect[0].quantity: 'weight' is not one of 'x', 'y', 'z', 'height', 'speed', "
      "'angular_speed', 'tilt', 'extension', 'largest_stretch', 'mean_stretch', 'tension', 'twist', "
      "'lowest', 'highest', 'total_energy', 'kinetic_energy', "
      "'potential_energy', 'elastic_energy', 'momentum', 'penetration', 'contacts', 'asleep', 'force', "
      "'torque', 'angle', 'way', 'gap', 'broken', 'yielded', 'soft'"}},
    {R"({"version": 1, "hooks": [{"b": "x"}]})",
     {"1:26: hooks[0]: needs 'anchor', or a point of what it holds"}},
    {R"({"version": 1, "hooks": [{"b": "ball", "anchor": [0, 0, 0]}]})",
     {"1:32: hooks[0].b: there is no object 'ball'"}},
    {R"({"version": 1, "fields": [{"name": "g", "uniform": {"acceleration": [0, 1, 0]}}], "hooks": [{"b": "g", "anchor": [0, 0, 0]}]})",
     {"1:99: hooks[0].b: 'g' cannot be hooked"}},
    {R"({"version": 1, "ropes": [{"name": "rope"}], "hooks": [{"b": "rope", "b_point": 16}]})",
     {"1:80: hooks[0].b_point: 16 is out of range, must be 0 to 15"}},
    {R"({"version": 1, "bodies": [{"name": "ball", "shape": {"sphere": {}}}], "hooks": [{"b": "ball", "b_point": 0}]})",
     {"1:106: hooks[0].b_point: 'ball' is a body, which has no points"}},
    {R"({"version": 1, "ropes": [{"name": "rope"}], "hooks": [{"b": "rope.end", "b_point": 1}]})",
     {"1:84: hooks[0].b_point: 'rope.end' names a point already"}},
    {R"({"version": 1, "ropes": [{"name": "rope"}], "hooks": [{"b": "rop.end"}]})",
     {"1:61: hooks[0].b: there is no object 'rop', did you mean 'rope'?"}},
    {R"({"version": 1, "bodies": [{"name": "x", "kind": "dynamic", "shape": {"box": {}}, "fracture": {}}], "ropes": [{"name": "rope"}], "hooks": [{"a": "rope", "a_point": 1, "b": "x"}]})",
     {"1:172: hooks[0].b: 'x' is fractured: 'anchor' or one of its connection points chooses the cell"}},
    {R"({"version": 1, "bodies": [{"name": "x", "kind": "dynamic", "shape": {"box": {}}, "fracture": {}}], "ropes": [{"name": "x_glue"}]})",
     {"1:119: ropes[0].name: 'x_glue' is already the name of bodies[0]"}},
    {R"({"version": 1, "cloths": [{"name": "silk"}], "seams": [{"a": "silk", "b": "silk.left"}]})",
     {"1:62: seams[0].a: 'silk' names no edge, as 'silk.left', and there are no 'a_points'"}},
    {R"({"version": 1, "cloths": [{"name": "silk"}], "seams": [{"a": "silk.top", "b": "silk.left", "b_points": [0, 1]}]})",
     {"1:79: seams[0].b: 'silk.left' names an edge already"}},
    {R"({"version": 1, "cloths": [{"name": "silk"}], "seams": [{"a": "silk.top", "b": "silk", "b_points": [0, 4]}]})",
     {"1:103: seams[0].b_points[1]: 4 is out of range, must be 0 to 3"}},
    {R"({"version": 1, "ropes": [{"name": "rope"}], "seams": [{"a": "rope.top", "b": "silk.left"}]})",
     {"1:61: seams[0].a: 'rope' is neither a cloth nor a solid",
      "1:78: seams[0].b: there is no object 'silk'"}},
    {R"({"version": 1, "ropes": [{"connection_points": {"eye": "end"}}]})",
     {"1:56: ropes[0].connection_points.eye: 'end' is a string, must be a place [x, y, z] or the number of a "
      "point"}},
    {R"({"version": 1, "ropes": [{"connection_points": {"e.e": 1}}]})",
     {"1:56: ropes[0].connection_points.e.e: 'e.e' has a character that a name must not have ([ ] . or "
      "control)"}},
    {R"({"version": 1, "bodies": [{"name": "ball", "shape": {"sphere": {}}}],)"
     R"( "hooks": [{"kind": "joint", "b": "bal", "anchor": [0, 0, 0]}]})",
     {"1:90: hooks[0].kind: 'joint' is not one of 'ball', 'hinge', 'slider', 'fixed', 'distance', 'wheel', "
      "'six_degrees', 'rope_slide'"}},
    {R"({"version": 1, "bodies": [{"name": "ball", "shape": {"sphere": {}}}],)"
     R"( "hooks": [{"a": "bal", "b": "ball", "anchor": [0, 0, 0]}]})",
     {"1:87: hooks[0].a: there is no object 'bal', did you mean 'ball'?"}},
    {R"({"version": 1, "hooks": [{"b": "x", "anchor": [0, 0, 0], "cone": -1}]})",
     {"1:66: hooks[0].cone: -1 is out of range, must be greater than 0 and at most 3.15"}},
    {R"({"version": 1, "hooks": [{"b": "x", "anchor": [0, 0, 0], "spring": {"stiffness": -2}}]})",
     {"1:82: hooks[0].spring.stiffness: -2 is out of range, must be at least 0"}},
    {R"({"version": 1, "hooks": [{"b": "x", "anchor": [0, 0, 0], "break_force": 0}]})",
     {R"(1:73: hooks[0].break_force: 0 is out of range, must be greater than 0 or "rigid")"}},
    {R"({"version": 1, "hooks": [{"b": "x", "anchor": [0, 0, 0], "freedoms": [{}]}]})",
     {"1:70: hooks[0].freedoms: has 1 element, must have 6"}},
    {R"({"version": 1, "bodies": [{"name": "link", "shape": {"sphere": {}}, "array": {"grid": [1, 3, 1]}}],)"
     R"( "hooks": [{"b": "link", "anchor": [0, 0, 0]}]})",
     {"1:117: hooks[0].b: 'link' is an array, name one of its objects as 'link[0]'"}},
    {R"({"version": 1, "bodies": [{"name": "link", "shape": {"sphere": {}}, "array": {"grid": [1, 3, 1]}}],)"
     R"( "hooks": [{"a": "link", "b": "link[1]", "anchor": [0, 0, 0], "array": {"grid": [1, 3, 1]}}]})",
     {"1:130: hooks[0].b: 'link[1]' is one of 3 objects, the hooks need 4"}},
    {R"({"version": 1, "ropes": [{"name": "rope"}],)"
     R"( "expect": [{"quantity": "force", "of": "rope", "op": "<", "value": 1}]})",
     {"1:84: expect[0].of: 'rope' is not a hook"}},
    {"\xEF\xBB\xBF{\"version\": 1, \"title\": \"\xC3\xA9\xC3\xA9\", \"x\": 1}", {"1:31: x: unknown key"}},
};

}  // namespace

TEST_SUITE("io/scene_errors") {
  TEST_CASE("every mistake is reported with its place, its path and a reason") {
    for (const BadScene& bad : kBadScenes) {
      CAPTURE(std::string(bad.text));
      const auto loaded = hooke::parse_scene(bad.text, "demo.json");
      CHECK_FALSE(loaded);
      REQUIRE(loaded.errors.size() == bad.lines.size());
      for (std::size_t i = 0; i < bad.lines.size(); ++i) {
        CHECK(hooke::to_line(loaded.errors[i]) == "demo.json:" + std::string(bad.lines[i]));
      }
    }
  }

  TEST_CASE("all mistakes of a file come at once, in its order") {
    const auto loaded = hooke::parse_scene(R"({
  "version": 1,
  "gravity": [0, -9.81, 0],
  "materials": {"silk": {"opacity": 2}},
  "ropes": [
    {"name": "rope", "material": "slik", "masses": 33.5},
    {"total_mass": "1 kg", "array": {"grid": [2, 0, 2]}}
  ],
  "expect": [{"quantity": "speed", "of": "roep", "point": 3, "op": "<", "value": 1}]
})",
                                           "demo.json");
    std::string lines;
    for (const hooke::Error& error : loaded.errors) lines += hooke::to_line(error) + "\n";
    CHECK(lines ==
          R"(demo.json:3:3: gravity: unknown key
demo.json:4:37: materials.silk.opacity: 2 is out of range, must be 0 to 1
demo.json:6:34: ropes[0].material: there is no material 'slik', did you mean 'silk'?
demo.json:6:52: ropes[0].masses: must be a whole number
demo.json:7:20: ropes[1].total_mass: '1 kg' is a string, must be a number (in kg, without a unit)
demo.json:7:50: ropes[1].array.grid[1]: 0 is out of range, must be 1 to 1000000
demo.json:9:42: expect[0].of: there is no object 'roep', did you mean 'rope'?
)");
  }

  TEST_CASE("a file of mistakes gives a hundred of them") {
    std::string text = "{\"version\": 1, \"ropes\": [";
    for (int i = 0; i < 5000; ++i) text += R"({"masses": 1},)";
    text.back() = ']';
    const auto loaded = hooke::parse_scene(text + "}", "demo.json");
    CHECK(loaded.errors.size() == 100);
  }
}

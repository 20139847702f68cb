#include "io/motion/motion_names.h"
#include "io/motion/motion_write.h"

#include <algorithm>
#include <filesystem>

namespace hooke::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* kBodies = "bodies.glb";

/// The script finds the objects by a property, as Blender shortens names and numbers them anew.
constexpr const char* kScript =
    R"PY("""Loads the recorded motion beside this file into the scene that is open in Blender.

Run it in Blender's text editor, or from a shell:

    blender --python import_in_blender.py
    blender --background --python import_in_blender.py -- motion.blend

The second form saves a file. Bodies come with keyframes; the points of ropes, cloths and solids come from
the .pc2 files, which must stay where they are.
"""
import pathlib
import sys

import bpy
import numpy

# The importer of Blender 3.4 asks for a name that numpy 1.24 has no more; Debian 12 has these two.
if "bool" not in vars(numpy):
    numpy.bool = bool

FRAMES = @FRAMES@
FRAMES_PER_SECOND = @RATE@


def folder_of_this_script():
    if bpy.context.space_data is not None and getattr(bpy.context.space_data, "text", None):
        path = bpy.context.space_data.text.filepath
        if path:
            return pathlib.Path(bpy.path.abspath(path)).resolve().parent
    return pathlib.Path(__file__).resolve().parent


def set_time(scene):
    """Frame 0 is the beginning; the importer of .glb files places keyframes by the scene's rate."""
    scene.render.fps = max(1, round(FRAMES_PER_SECOND))
    scene.render.fps_base = scene.render.fps / FRAMES_PER_SECOND
    scene.frame_start = 0
    scene.frame_end = FRAMES - 1


def attach_cache(found, path):
    """The caches have z up, as Blender's meshes have, so that the modifier has nothing to turn."""
    with open(path, "rb") as cache:
        header = cache.read(32)
    points = int.from_bytes(header[16:20], "little")
    if header[:12] != b"POINTCACHE2\0" or points != len(found.data.vertices):
        raise RuntimeError(f"{path.name} has {points} points, and '{found.name}' {len(found.data.vertices)}")
    modifier = found.modifiers.new("motion", "MESH_CACHE")
    modifier.cache_format = "PC2"
    modifier.filepath = str(path)
    modifier.forward_axis = "POS_Y"
    modifier.up_axis = "POS_Z"
    modifier.interpolation = "LINEAR"
    modifier.time_mode = "FRAME"
    modifier.play_mode = "SCENE"
    modifier.frame_start = 0


def main():
    folder = folder_of_this_script()
    set_time(bpy.context.scene)
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=str(folder / "bodies.glb"))
    count = 0
    for found in set(bpy.data.objects) - before:
        if "point_cache" in found:
            attach_cache(found, folder / found["point_cache"])
            count += 1
    bpy.context.scene.frame_set(0)
    print(f"loaded {len(set(bpy.data.objects) - before)} objects, {count} with point caches, {FRAMES} frames")
    if "--" in sys.argv[:-1]:
        bpy.ops.wm.save_as_mainfile(filepath=str(pathlib.Path(sys.argv[sys.argv.index("--") + 1]).resolve()))


main()
)PY";

std::string filled(std::string text, const std::string& mark, const std::string& value) {
  return text.replace(text.find(mark), mark.size(), value);
}

Result<void> write_script(const MotionJob& job, const std::string& path) {
  std::array<char, 40> rate = {};
  std::snprintf(rate.data(), rate.size(), "%.9g", job.data.frames_per_second);
  OutputSink sink(path);
  sink.put(
      filled(filled(kScript, "@FRAMES@", std::to_string(job.data.frames.size())), "@RATE@", rate.data()));
  return sink.finish(job.summary);
}

/// Writes every frame of an object of points: PC2 has a header of 32 bytes and then, frame after frame, three
/// floats for each vertex. Where the object is not present its nearest frame stands. z points up, as programs
/// that read this format have it; they bring meshes of .glb files into that frame, too.
Result<void> write_cache(const MotionJob& job, std::size_t object, const std::string& path) {
  const MotionData& data = job.data;
  const MotionTrack& track = data.tracks[object];
  OutputSink sink(path);
  sink.put(std::string_view("POINTCACHE2\0", 12));
  sink.put_value(std::int32_t{1});  // version
  sink.put_value(static_cast<std::int32_t>(data.mesh_of(object).vertices.size()));
  sink.put_value(0.0f);  // first frame
  sink.put_value(1.0f);  // frames from sample to sample
  sink.put_value(static_cast<std::int32_t>(data.frames.size()));
  for (std::size_t frame = 0; frame < data.frames.size(); ++frame) {
    std::vector<Vec3> points = data.points(object, std::clamp(frame, track.first, track.end - 1));
    for (Vec3& p : points) p = {p.x, -p.z, p.y};
    sink.put(std::as_bytes(std::span(points)));
    if (sink.error()) break;
  }
  return sink.finish(job.summary);
}

}  // namespace

Result<void> write_point_caches(const MotionJob& job) {
  static_assert(sizeof(Vec3) == 3 * sizeof(float), "point caches hold floats");
  const MotionData& data = job.data;
  const fs::path folder(job.path);
  NameBook names(NameStyle::kFile);
  std::vector<std::string> caches(data.objects.size());
  for (std::size_t i = 0; i < data.objects.size(); ++i) {
    if (data.objects[i].kind != MotionObject::Kind::kPoints || !data.is_seen(i)) continue;
    caches[i] = names.take(data.objects[i].name, "object") + ".pc2";
    if (auto done = write_cache(job, i, (folder / caches[i]).string()); !done) return done;
    job.show(0.8 * static_cast<double>(i + 1) / static_cast<double>(data.objects.size()));
  }
  if (auto done = write_script(job, (folder / "import_in_blender.py").string()); !done) return done;
  const MotionJob bodies = {data, (folder / kBodies).string(), job.options, job.summary};
  return write_glb_motion(bodies, GlbContent::kBodiesMove, caches);
}

}  // namespace hooke::io

"""Runs in Blender after an import: writes the vertices of each object at five frames, in the world, to FILE.json."""

import json
import sys

import bpy


def vertices(found, graph):
    points = []
    for each in [found, *sorted(found.children, key=lambda child: child.name)]:
        if each.type != "MESH" or not any(each.matrix_world.to_scale()):
            continue
        evaluated = each.evaluated_get(graph)
        if not any(abs(x) > 1e-9 for x in evaluated.matrix_world.to_scale()):
            continue  # not there yet, or gone
        points += [tuple(evaluated.matrix_world @ vertex.co) for vertex in evaluated.to_mesh().vertices]
    return points


scene = bpy.context.scene
last = scene.frame_end
frames = {}
for frame in (0, last // 4, last // 2, 3 * last // 4, last):
    scene.frame_set(frame)
    graph = bpy.context.evaluated_depsgraph_get()
    frames[frame] = {found.name: vertices(found, graph) for found in bpy.data.objects if found.parent is None}
with open(sys.argv[sys.argv.index("--") + 1] + ".json", "w", encoding="utf-8") as file:
    json.dump(frames, file)

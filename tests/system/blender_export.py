"""Opens what `plisse export` wrote in Blender and says how far it is from what the files hold.

blender -b --factory-startup -P blender_export.py -- FOLDER REPORT.json

FOLDER has mesh.obj, mesh.glb, mesh.ply of one frame, cache.obj with cache.pc2 and cache.mdd, and frame_1.obj,
frame_2.obj, … with the geometry of the caches' frames. The OBJ files are read here as text, by nobody's
importer.
"""
import glob
import json
import math
import os
import sys

import bpy
import numpy
from mathutils import Vector

if not hasattr(numpy, "bool"):  # Blender 3.4's glTF reader still asks for it; Debian 12's numpy has dropped it
    numpy.bool = bool

folder, report = sys.argv[sys.argv.index("--") + 1:]


def read_obj(path):
    places, normals, uvs, corners = [], [], [], []
    for line in open(path):
        word, *rest = line.split()
        if word == "v":
            places.append(Vector(map(float, rest)))
        elif word == "vn":
            normals.append(Vector(map(float, rest)))
        elif word == "vt":
            uvs.append(Vector(map(float, rest)))
        elif word == "f":
            for corner in rest:
                corners.append([int(i) - 1 if i else -1 for i in corner.split("/")])
    return places, normals, uvs, corners


def y_up(v):
    """Blender's z up back to y up."""
    return Vector((v.x, v.z, -v.y))


def imported(operator, path):
    bpy.ops.object.select_all(action="DESELECT")
    before = set(bpy.data.objects)
    operator(filepath=path)
    (one,) = [o for o in bpy.data.objects if o not in before and o.type == "MESH"]
    return one


def compare(found, turned, truth):
    """Largest distance of places, of uv, and angle of normals, corner by corner."""
    places, normals, uvs, corners = truth
    mesh = found.data
    mesh.calc_normals_split()
    matrix = found.matrix_world
    upright = matrix.to_3x3()
    uv_layer = mesh.uv_layers.active.data if mesh.uv_layers.active else None
    assert len(mesh.loops) == len(corners), (len(mesh.loops), len(corners))
    result = {"vertices": len(mesh.vertices), "place": 0, "uv": 0 if uv_layer else None, "angle_deg": 0}
    for loop, (place, uv, normal) in zip(mesh.loops, corners):
        x, n = matrix @ mesh.vertices[loop.vertex_index].co, upright @ loop.normal
        if turned:
            x, n = y_up(x), y_up(n)
        result["place"] = max(result["place"], (x - places[place]).length)
        cosine = max(-1, min(1, n.normalized().dot(normals[normal].normalized())))
        result["angle_deg"] = max(result["angle_deg"], math.degrees(math.acos(cosine)))
        if uv_layer:
            result["uv"] = max(result["uv"], (uv_layer[loop.index].uv - uvs[uv]).length)
    return result


results = {}
truth = read_obj(os.path.join(folder, "mesh.obj"))
results["obj"] = compare(imported(bpy.ops.wm.obj_import, os.path.join(folder, "mesh.obj")), True, truth)
results["glb"] = compare(imported(bpy.ops.import_scene.gltf, os.path.join(folder, "mesh.glb")), True, truth)
# Blender's PLY reader turns nothing and makes normals of its own.
results["ply"] = compare(imported(bpy.ops.import_mesh.ply, os.path.join(folder, "mesh.ply")), False, truth)

frames = sorted(glob.glob(os.path.join(folder, "frame_*.obj")))
for kind in ("pc2", "mdd"):
    moved = imported(bpy.ops.wm.obj_import, os.path.join(folder, "cache.obj"))
    modifier = moved.modifiers.new("cache", "MESH_CACHE")
    modifier.cache_format = kind.upper()
    modifier.filepath = os.path.join(folder, "cache." + kind)
    modifier.play_mode = "CUSTOM"
    largest = 0
    for index, path in enumerate(frames):
        modifier.eval_frame = index
        graph = bpy.context.evaluated_depsgraph_get()
        graph.update()
        mesh = moved.evaluated_get(graph).data
        places = read_obj(path)[0]
        assert len(mesh.vertices) == len(places)
        for vertex, place in zip(mesh.vertices, places):
            largest = max(largest, (y_up(moved.matrix_world @ vertex.co) - place).length)
    results[kind] = {"frames": len(frames), "place": largest}
low = [min(p[i] for p in truth[0]) for i in range(3)]
high = [max(p[i] for p in truth[0]) for i in range(3)]
results["diagonal"] = math.dist(low, high)
json.dump(results, open(report, "w"))

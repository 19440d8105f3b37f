"""Renders the coarse mesh wearing the baked normal map, and the displaced mesh, both in Cycles on the CPU, and says how far
apart their normals are.

blender -b --factory-startup -P blender_bake.py -- FOLDER REPORT.json

FOLDER has coarse.obj, fine.obj and normal.png. Pictures of the normals: worn.exr (with the map), fine.exr, bare.exr (the
coarse mesh alone).
"""
import json
import math
import os
import sys

import bpy

folder, report = sys.argv[sys.argv.index("--") + 1:]
scene = bpy.context.scene
for one in list(bpy.data.objects):
    bpy.data.objects.remove(one)
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.use_denoising = False
scene.render.resolution_x = scene.render.resolution_y = 128
scene.render.film_transparent = True
scene.view_settings.view_transform = "Raw"


def imported(name):
    bpy.ops.object.select_all(action="DESELECT")
    bpy.ops.wm.obj_import(filepath=os.path.join(folder, name))
    return bpy.context.selected_objects[0]


def wear(one, with_map):
    """A material that shows the normal as a colour."""
    material = bpy.data.materials.new("wear")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    normal = nodes.new("ShaderNodeNewGeometry").outputs["Normal"]
    if with_map:
        picture = nodes.new("ShaderNodeTexImage")
        picture.image = bpy.data.images.load(os.path.join(folder, "normal.png"))
        picture.image.colorspace_settings.name = "Non-Color"
        map_node = nodes.new("ShaderNodeNormalMap")
        map_node.uv_map = one.data.uv_layers.active.name
        links.new(picture.outputs["Color"], map_node.inputs["Color"])
        normal = map_node.outputs["Normal"]
    half = nodes.new("ShaderNodeVectorMath")
    half.operation = "MULTIPLY_ADD"
    half.inputs[1].default_value = half.inputs[2].default_value = (0.5, 0.5, 0.5)
    shader = nodes.new("ShaderNodeEmission")
    links.new(normal, half.inputs[0])
    links.new(half.outputs[0], shader.inputs["Color"])
    links.new(shader.outputs[0], output.inputs["Surface"])
    one.data.materials.clear()
    one.data.materials.append(material)
    for polygon in one.data.polygons:
        polygon.material_index = 0


coarse, fine = imported("coarse.obj"), imported("fine.obj")
places = [coarse.matrix_world @ v.co for v in coarse.data.vertices]
low = [min(p[i] for p in places) for i in range(3)]
high = [max(p[i] for p in places) for i in range(3)]
centre = [(a + b) / 2 for a, b in zip(low, high)]
size = math.dist(low, high)
camera = bpy.data.cameras.new("camera")
camera.type = "ORTHO"
camera.ortho_scale = 0.8 * size
eye = bpy.data.objects.new("camera", camera)
eye.location = (centre[0], centre[1] - 3 * size, centre[2])
eye.rotation_euler = (math.pi / 2, 0, 0)  # along +y, z up
camera.clip_end = 10 * size
scene.collection.objects.link(eye)
scene.camera = eye


def render(one, name, with_map):
    coarse.hide_render, fine.hide_render = one is not coarse, one is not fine
    wear(one, with_map)
    scene.cycles.samples = 4
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = os.path.join(folder, name)
    bpy.ops.render.render(write_still=True)
    return scene.render.filepath


def normals(path):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    values = list(image.pixels)
    found = []
    for i in range(0, len(values), 4):
        n = [2 * c - 1 for c in values[i:i + 3]]
        length = math.hypot(*n)
        found.append([c / length for c in n] if values[i + 3] > 0.999 and length > 0.5 else None)
    return found


def mean_angle(a, b):
    angles = [math.degrees(math.acos(max(-1, min(1, sum(x * y for x, y in zip(m, n))))))
              for m, n in zip(a, b) if m and n]
    return sum(angles) / len(angles), len(angles)


truth = normals(render(fine, "fine.exr", False))
bare = normals(render(coarse, "bare.exr", False))
worn = normals(render(coarse, "worn.exr", True))
angle, pixels = mean_angle(worn, truth)
json.dump({"pixels": pixels, "worn_deg": angle, "bare_deg": mean_angle(bare, truth)[0]}, open(report, "w"))

# SPDX-License-Identifier: Apache-2.0
"""Renders a Blender scene as input for relievo-author: colour pictures, and depth pictures of 16 bits in millimetres.

    blender -b scene.blend -P relievo_depth.py -- FOLDER [MM_PER_UNIT]

FOLDER gets color-0001.png, depth-0001.png, .. for the frames that the scene renders, counted from 1. MM_PER_UNIT is the size of
one unit of the scene in mm, by default 1000 (metres). Depth is measured along the camera's axis; 0 marks the sky and everything
beyond 65 m. At the end the script prints the relievo-author command for the film. For Blender 3 and 4.
"""
import os
import sys

import bpy

LARGEST_CODE = 65535


def arguments():
    if bpy.app.version >= (5,):
        sys.exit("relievo_depth.py: Blender 5 has another compositor; use Blender 3 or 4")
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if not 1 <= len(words) <= 2:
        sys.exit("relievo_depth.py: blender -b scene.blend -P relievo_depth.py -- FOLDER [MM_PER_UNIT]")
    return os.path.abspath(words[0]), float(words[1]) if len(words) == 2 else 1000.0


def add(tree, kind, operation=None, value=None):
    node = tree.nodes.new(kind)
    if operation:
        node.operation = operation
    if value is not None:
        node.inputs[1].default_value = value
    return node


def file_output(tree, folder, name, mode, bits):
    node = tree.nodes.new("CompositorNodeOutputFile")
    node.base_path = folder
    node.format.file_format = "PNG"
    node.format.color_mode = mode
    node.format.color_depth = bits
    node.file_slots[0].path = name
    return node


def set_up(scene, folder, mm_per_unit):
    scene.view_layers[0].use_pass_z = True
    scene.use_nodes = True
    scene.render.use_compositing = True
    tree = scene.node_tree
    tree.nodes.clear()
    layers = tree.nodes.new("CompositorNodeRLayers")

    color = file_output(tree, folder, "rendered-color-####", "RGB", "8")
    tree.links.new(layers.outputs["Image"], color.inputs[0])

    # Code = distance in mm, scaled to 16 bits; distances beyond the range become 0.
    scaled = add(tree, "CompositorNodeMath", "MULTIPLY", mm_per_unit / LARGEST_CODE)
    near_enough = add(tree, "CompositorNodeMath", "LESS_THAN", 1.0)
    code = add(tree, "CompositorNodeMath", "MULTIPLY")
    depth = file_output(tree, folder, "rendered-depth-####", "BW", "16")
    # Raw data: no view transform, no gamma.
    if hasattr(depth, "save_as_render"):
        depth.save_as_render = False
    if hasattr(depth.format, "color_management"):
        depth.format.color_management = "OVERRIDE"
        depth.format.linear_colorspace_settings.name = "Non-Color"
    tree.links.new(layers.outputs["Depth"], scaled.inputs[0])
    tree.links.new(scaled.outputs[0], near_enough.inputs[0])
    tree.links.new(scaled.outputs[0], code.inputs[0])
    tree.links.new(near_enough.outputs[0], code.inputs[1])
    tree.links.new(code.outputs[0], depth.inputs[0])


def main():
    folder, mm_per_unit = arguments()
    os.makedirs(folder, exist_ok=True)
    scene = bpy.context.scene
    set_up(scene, folder, mm_per_unit)
    # Frame by frame, because rendering an animation would also write the scene's own output.
    for number, frame in enumerate(range(scene.frame_start, scene.frame_end + 1, scene.frame_step), 1):
        scene.frame_set(frame)
        bpy.ops.render.render()
        for name in ("color", "depth"):  # Blender's names have the frame's number, and relievo-author takes no gaps
            os.replace(f"{folder}/rendered-{name}-{frame:04d}.png", f"{folder}/{name}-{number:04d}.png")
    rate = scene.render.fps / scene.render.fps_base / scene.frame_step
    print(f"relievo-author --color {folder}/color-%04d.png --depth {folder}/depth-%04d.png --fps {rate:g} "
          f"--calibration unit=1,invalid=0 -o film.mkv")


main()

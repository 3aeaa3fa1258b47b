"""Brings surfaces with atlases into Blender (3.4 or later), textured:

    blender --python scripts/import_atlas.py -- OUT/geometry/NAME.*.ply

The surfaces are those of `ebru export --atlas`. Blender's own PLY importer skips the atlas coordinates of faces. Of several surfaces each
shows in its own frame. Besides the UV map `atlas` they have the attributes `colour` and `velocity` (world units per second, which
the motion blur of Cycles takes).
"""

import pathlib
import re
import sys

import bpy
import numpy as np

TYPES = {"float": "<f4", "int": "<i4", "uchar": "u1"}
LISTS = {"vertex_indices": 3, "texcoord": 6}


def read_ply(path):
    """@return (vertices, faces), numpy arrays with the fields that the header names"""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    elements = []
    for line in header.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            elements.append((int(words[2]), []))
        elif words[0] == "property" and words[1] == "list":
            fields = elements[-1][1]
            fields += [(words[-1] + "_count", "u1"), (words[-1], TYPES[words[3]], LISTS[words[-1]])]
        elif words[0] == "property":
            elements[-1][1].append((words[-1], TYPES[words[1]]))
    arrays, at = [], 0
    for count, fields in elements:
        arrays.append(np.frombuffer(body, np.dtype(fields), count, at))
        at += arrays[-1].nbytes
    if "texcoord" not in arrays[1].dtype.names:
        sys.exit(f"{path}: faces: got no texcoord, expected a surface of `ebru export --atlas`; export it with --atlas")
    return arrays


def columns(array, *names):
    return np.stack([array[name] for name in names], axis=1)


def make_mesh(path):
    vertices, faces = read_ply(path)
    mesh = bpy.data.meshes.new(path.stem)
    mesh.from_pydata(columns(vertices, "x", "y", "z").tolist(), [], faces["vertex_indices"].tolist())
    mesh.uv_layers.new(name="atlas").data.foreach_set("uv", faces["texcoord"].ravel())
    colours = np.ones((len(vertices), 4), np.float32)
    colours[:, :3] = columns(vertices, "red", "green", "blue") / 255
    mesh.color_attributes.new("colour", "BYTE_COLOR", "POINT").data.foreach_set("color_srgb", colours.ravel())
    velocity = mesh.attributes.new("velocity", "FLOAT_VECTOR", "POINT")
    velocity.data.foreach_set("vector", columns(vertices, "vx", "vy", "vz").ravel())
    mesh.polygons.foreach_set("use_smooth", np.ones(len(faces), bool))
    mesh.normals_split_custom_set_from_vertices(columns(vertices, "nx", "ny", "nz").tolist())
    if bpy.app.version < (4, 1):  # Later ones always show custom normals.
        mesh.use_auto_smooth = True
    mesh.materials.append(make_material(path))
    return mesh


def make_material(path):
    material = bpy.data.materials.new(path.stem)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    picture = nodes.new("ShaderNodeTexImage")
    picture.image = bpy.data.images.load(str(path.with_suffix(".atlas.exr").resolve()))
    picture.image.colorspace_settings.name = "Linear" if bpy.app.version < (4, 0) else "Linear Rec.709"
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    links.new(picture.outputs["Color"], shader.inputs["Base Color"])
    links.new(picture.outputs["Alpha"], shader.inputs["Alpha"])
    return material


def show_only_in(thing, frame):
    for when, hidden in ((frame - 1, True), (frame, False), (frame + 1, True)):
        for property in ("hide_viewport", "hide_render"):
            setattr(thing, property, hidden)
            thing.keyframe_insert(property, frame=when)


def main(paths):
    for path in paths:
        thing = bpy.data.objects.new(path.stem, make_mesh(path))
        bpy.context.scene.collection.objects.link(thing)
        if len(paths) > 1:
            show_only_in(thing, int(re.search(r"\.(\d+)$", path.stem).group(1)))


if __name__ == "__main__":
    names = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    if not names:
        sys.exit("import_atlas.py: surfaces: got none, expected PLY files after --; see the top of this script")
    main([pathlib.Path(name) for name in names])

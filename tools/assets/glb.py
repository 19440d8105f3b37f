"""A small animated model and its file: binary glTF 2.0 (Khronos), one skin, one clip.

Coordinates are metres, y up, right-handed; uv has v downward as glTF wants it. Numbers are rounded to 1e-7 before they
become floats, so that a last bit of the C library's sine does not change the file.
"""
import json
import struct

from linear import inverse, matrix, product

FLOAT, U8, U16 = 5126, 5121, 5123
ARRAY, INDICES = 34962, 34963


class Model:
    def __init__(self, name):
        self.name = name
        self.joints = []      # name, parent (index or None), translation, rotation: the bind pose
        self.materials = []   # name, png or None, base colour (linear), roughness
        self.meshes = []      # name, material, positions, normals, uvs, triangles, influences
        self.tracks = []      # joint, "translation" | "rotation" | "scale", times, values

    def joint(self, name, parent=None, translation=(0, 0, 0), rotation=(0, 0, 0, 1)):
        """In the parent's frame, as bound. Returns the joint's index."""
        self.joints.append((name, parent, translation, rotation))
        return len(self.joints) - 1

    def material(self, name, png=None, colour=(1, 1, 1), roughness=0.75):
        self.materials.append((name, png, colour, roughness))
        return len(self.materials) - 1

    def mesh(self, name, material, positions, normals, uvs, triangles, influences):
        """`triangles` are index triples; `influences` one list of (joint, weight) per vertex, at most four."""
        self.meshes.append((name, material, positions, normals, uvs, triangles, influences))

    def animate(self, joint, path, times, values):
        self.tracks.append((joint, path, times, values))

    def globals(self, locals_=None):
        """World matrices of the joints; `locals_` in place of the bind pose's."""
        result = []
        for index, (_, parent, translation, rotation) in enumerate(self.joints):
            local = locals_[index] if locals_ else matrix(translation, rotation)
            result.append(local if parent is None else product(result[parent], local))
        return result

    def encode(self):
        return Writer(self).bytes()


def rounded(values):
    return [round(float(v), 7) + 0.0 for v in values]


class Writer:
    def __init__(self, model):
        self.data = bytearray()
        self.views, self.accessors = [], []
        self.json = {'asset': {'version': '2.0', 'generator': 'plisse tools/make_assets'}, 'scene': 0}
        self.textures(model)
        self.hierarchy(model)
        self.animation(model)
        self.json.update(bufferViews=self.views, accessors=self.accessors,
                         buffers=[{'byteLength': len(self.data)}])

    def view(self, data, target=None):
        self.data.extend(b'\0' * (-len(self.data) % 4))
        view = {'buffer': 0, 'byteOffset': len(self.data), 'byteLength': len(data)}
        if target:
            view['target'] = target
        self.data.extend(data)
        self.views.append(view)
        return len(self.views) - 1

    def accessor(self, kind, component, rows, target=None, bounds=False):
        """`rows`: tuples, or plain numbers for SCALAR."""
        flat = [v for row in rows for v in row] if kind != 'SCALAR' else list(rows)
        letter = {FLOAT: 'f', U8: 'B', U16: 'H'}[component]
        if component == FLOAT:
            flat = rounded(flat)
        data = struct.pack(f'<{len(flat)}{letter}', *flat)
        entry = {'bufferView': self.view(data, target), 'componentType': component, 'count': len(rows), 'type': kind}
        if bounds:
            width = len(flat) // len(rows)
            stored = struct.unpack(f'<{len(flat)}{letter}', data)
            entry['min'] = [min(stored[i::width]) for i in range(width)]
            entry['max'] = [max(stored[i::width]) for i in range(width)]
        self.accessors.append(entry)
        return len(self.accessors) - 1

    def textures(self, model):
        images = []
        materials = []
        for name, png, colour, roughness in model.materials:
            surface = {'baseColorFactor': [*colour, 1], 'metallicFactor': 0, 'roughnessFactor': roughness}
            if png is not None:
                if png not in images:
                    images.append(png)
                surface['baseColorTexture'] = {'index': images.index(png)}
            materials.append({'name': name, 'doubleSided': True, 'pbrMetallicRoughness': surface})
        self.json['materials'] = materials
        if images:
            self.json['images'] = [{'mimeType': 'image/png', 'bufferView': self.view(png)} for png in images]
            self.json['samplers'] = [{'magFilter': 9729, 'minFilter': 9987, 'wrapS': 10497, 'wrapT': 10497}]
            self.json['textures'] = [{'source': i, 'sampler': 0} for i in range(len(images))]

    def hierarchy(self, model):
        nodes = []
        for name, _, translation, rotation in model.joints:
            nodes.append({'name': name, 'translation': rounded(translation), 'rotation': rounded(rotation)})
        for index, (_, parent, _, _) in enumerate(model.joints):
            if parent is not None:
                nodes[parent].setdefault('children', []).append(index)
        roots = [index for index, joint in enumerate(model.joints) if joint[1] is None]

        meshes = []
        for name, material, positions, normals, uvs, triangles, influences in model.meshes:
            most = max(len(row) for row in influences)
            assert most <= 4 and len(positions) < 65536, name
            filled = [sorted(row, key=lambda entry: -entry[1]) + [(0, 0.0)] * (4 - len(row)) for row in influences]
            attributes = {
                'POSITION': self.accessor('VEC3', FLOAT, positions, ARRAY, bounds=True),
                'NORMAL': self.accessor('VEC3', FLOAT, normals, ARRAY),
                'TEXCOORD_0': self.accessor('VEC2', FLOAT, uvs, ARRAY),
                'JOINTS_0': self.accessor('VEC4', U8, [[j for j, _ in row] for row in filled], ARRAY),
                'WEIGHTS_0': self.accessor('VEC4', FLOAT, [[w for _, w in row] for row in filled], ARRAY),
            }
            indices = self.accessor('SCALAR', U16, [v for triangle in triangles for v in triangle], INDICES)
            meshes.append({'name': name, 'primitives': [
                {'attributes': attributes, 'indices': indices, 'material': material, 'mode': 4}]})
            roots.append(len(nodes))
            nodes.append({'name': name, 'mesh': len(meshes) - 1, 'skin': 0})
        self.json.update(nodes=nodes, meshes=meshes, scenes=[{'name': model.name, 'nodes': roots}])

        offsets = [inverse(bound) for bound in model.globals()]
        by_columns = [[m[row][column] for column in range(4) for row in range(4)] for m in offsets]
        self.json['skins'] = [{'name': model.name, 'joints': list(range(len(model.joints))), 'skeleton': 0,
                               'inverseBindMatrices': self.accessor('MAT4', FLOAT, by_columns)}]

    def animation(self, model):
        samplers, channels, clocks = [], [], {}
        for joint, path, times, values in model.tracks:
            key = tuple(times)
            if key not in clocks:
                clocks[key] = self.accessor('SCALAR', FLOAT, times, bounds=True)
            kind = 'VEC4' if path == 'rotation' else 'VEC3'
            channels.append({'sampler': len(samplers), 'target': {'node': joint, 'path': path}})
            samplers.append({'input': clocks[key], 'output': self.accessor(kind, FLOAT, values),
                             'interpolation': 'LINEAR'})
        self.json['animations'] = [{'name': model.name, 'samplers': samplers, 'channels': channels}]

    def bytes(self):
        text = json.dumps(self.json, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        data = bytes(self.data) + b'\0' * (-len(self.data) % 4)
        size = 12 + 8 + len(text) + 8 + len(data)
        return (struct.pack('<4sII', b'glTF', 2, size) + struct.pack('<I4s', len(text), b'JSON') + text +
                struct.pack('<I4s', len(data), b'BIN\0') + data)

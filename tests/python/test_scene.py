#!/usr/bin/env python3
"""Pages for a browser, read by a second reader: counts, closed shapes and their volumes, places, motions, contacts and extra
fields agree with what Lua tells of blocks and contacts, after motion, cuts, joins and deletes; names of the model are
data; the content security policy allows the page's own script and style only."""
import base64
import hashlib
import html.parser
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ.get("TALUS_PROGRAM", ROOT / "build/release/talus")).resolve()

# What single precision leaves of a length, as a share of the model's size, with room for a few roundings.
EXACT = 1e-6
HOSTILE = '</script><img src=x onerror=alert(1)> "quoted\\" & \u00fc\n\u0001'
JOINT = HOSTILE[:-2]  # of which no letter controls anything

# Writes frames, and for each a table of what the fields tell.
MODEL = r"""
local talus = require "talus"
local prefix, told, hostile, joint = arg[1], assert(io.open(arg[2], "w")), arg[3], arg[4]

local function text_of(value)
    if type(value) == "table" then
        local parts = {}
        for key, one in pairs(value) do
            if type(key) == "string" then
                parts[#parts + 1] = string.format("%q: %s", key, text_of(one))
            end
        end
        for _, one in ipairs(value) do
            parts[#parts + 1] = text_of(one)
        end
        return (#value > 0 or next(value) == nil) and "[" .. table.concat(parts, ", ") .. "]" or "{" .. table.concat(parts, ", ") .. "}"
    elseif math.type(value) == "float" then
        return value ~= value and "NaN" or math.abs(value) == math.huge and "1e999" or string.format("%.17g", value)
    elseif type(value) == "string" then
        return '"' .. value:gsub('[%c"\\]', function(c) return string.format("\\u%04x", c:byte()) end) .. '"'
    end
    return tostring(value)
end

local function block_of(b)
    return { id = b.id, group = b.group, body = b.body, volume = b.volume, density = b.density, centroid = b.centroid,
        displacement = b.displacement, rotation = b.rotation, velocity = b.velocity, spin = b.angular_velocity,
        force = b.force, fixed = b.fixed, hidden = b.hidden, vertices = b.vertices, kinetic = b.kinetic_energy }
end

local function length_of(v)
    return (v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2) ^ 0.5
end

local function contact_of(c)
    return { id = c.id, a = c.blocks[1].id, b = c.blocks[2].id, joint = c.joint, area = c.area, normal = c.normal,
        point = c.point, gap = c.gap, normal_force = c.normal_force, shear_force = c.shear_force, state = c.state,
        slip = rawget(c.states, "slip") or length_of(c.shear_displacement) }
end

local function frame(m, options)
    m:write_html(prefix, options)
    local blocks, contacts = {}, {}
    for i, b in ipairs(m:blocks { hidden = "any" }) do
        blocks[i] = block_of(b)
    end
    for i, c in ipairs(m:contacts {}) do
        contacts[i] = contact_of(c)
    end
    local energy = m:energy()
    told:write(text_of { time = m.time, cycle = m.cycles, blocks = blocks, contacts = contacts, kinetic = energy.kinetic,
        damping = energy.damping, friction = energy.friction, refused = talus.report(m).refused_cuts,
        verdict = m:verdict(), hash = m:state_hash() }, "\n")
end

-- a slope of blocks far from zero, on a plane that is too steep for its friction
local far = { 412345.25, -98765.5, 1234 }
local m = talus.model { gravity = { 0, 0, -9.81 } }
m:generate("box", { min = far, max = { far[1] + 6, far[2] + 4, far[3] + 4 }, density = 2600 })
m:generate("joint", { joint = joint, dip = 40, dip_direction = 90, origin = { far[1] + 3, far[2], far[3] + 2 } })
m:generate("jointset", { joint = "K", dip = 80, dip_direction = 270, spacing = 1.5, origin = { far[1] + 3, far[2], far[3] + 2 } })
m:generate("jointset", { joint = "L", dip = 90, dip_direction = 10, spacing = 1.3, origin = { far[1] + 3, far[2] + 2, far[3] } })
m:blocks { below = { dip = 40, dip_direction = 90, origin = { far[1] + 3, far[2], far[3] + 1.9 } } }:set { group = hostile }
m:blocks { group = hostile }:fix()
m:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 25 })
m:joint("K", "slip_weakening", { kn = 1e8, ks = 5e7, friction = 25, residual_friction = 10, distance = 1e-3 })
m:damping("local", { alpha = 0.3 })
m:history { name = "largest", every = 50, value = function(one) return one:blocks():max("volume") end }
m:history { name = "pair", every = 50, value = function() return { 1.5, 2.5 } end }
m:history { name = "energy", every = 50, value = "kinetic" }
m:history { name = "way", every = 50, of = m:blocks { group = "rock" }, field = "displacement", take = "mean" }

local fields = { title = hostile, block_fields = { "kinetic_energy", odd = function(b) return b.id % 2 == 1 and b.id / 8 or nil end },
    contact_fields = { width = function(c) return c.area ^ 0.5 end, gap = "gap" } }
frame(m, fields)
m:cycle(300)
frame(m, fields)
m:cycle(200)
frame(m, fields)
m:blocks { id = m:blocks { group = "rock" }[1].id }:hide()
m:generate("joint", { joint = "new", dip = 70, dip_direction = 20, origin = { far[1] + 4, far[2] + 2, far[3] + 2 } })
m:generate("joint", { joint = "new", dip = 70, dip_direction = 20, origin = { far[1] + 4, far[2] + 2, far[3] + 2 + 1e-6 } }) -- refused
m:joint("L:1", "coulomb", { kn = 1e8, ks = 5e7, friction = 28 })
m:joint("new", "coulomb", { kn = 1e8, ks = 5e7, friction = 30 })
m:cycle(100)
frame(m, { contacts = false })
m:blocks { group = "rock", joint = "new" }:join()
m:blocks { id = m:blocks { group = "rock" }[2].id }:delete()
m:cycle(100)
frame(m, { contacts = "slipping", keyblocks = { friction = 20 } })
m:blocks():reset_displacement()
m:cycle(100)
frame(m, fields)
told:close()
"""

faults = []


def expect(good, what):
    if not good:
        faults.append(what)
    return good


class Page(html.parser.HTMLParser):
    """Elements of a page: their names, the frames, script, style, title and policy."""

    def __init__(self, text):
        super().__init__()
        self.names, self.frames, self.texts, self.policy, self.at = [], [], {}, "", None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.names.append(tag)
        self.at = tag
        if tag == "script" and given.get("type") == "text/talus":
            self.frames.append([given, ""])
            self.at = "frame"
        if given.get("http-equiv") == "Content-Security-Policy":
            self.policy = given["content"]

    def handle_endtag(self, tag):
        self.at = None

    def handle_data(self, data):
        if self.at == "frame":
            self.frames[-1][1] += data
        elif self.at:
            self.texts[self.at] = self.texts.get(self.at, "") + data


class Columns:
    """A payload, read column by column."""

    def __init__(self, payload):
        self.payload, self.at = payload, 0

    def take(self, form, count):
        size = struct.calcsize("<" + form)
        values = struct.unpack_from(f"<{count}{form}", self.payload, self.at)
        self.at += (count * size + 3) // 4 * 4
        return values

    def vectors(self, count, width=3):
        values = self.take("f", width * count)
        return [values[width * i:width * i + width] for i in range(count)]

    def end(self, what):
        expect(self.at == len(self.payload), f"{what}: {len(self.payload)} bytes, {self.at} of them read")


def chunks_of(data):
    at, chunks = 0, []
    while at < len(data):
        name, length = data[at:at + 4].decode("ascii"), struct.unpack_from("<I", data, at + 4)[0]
        chunks.append((name, data[at + 8:at + 8 + length]))
        at += 8 + (length + 3) // 4 * 4
    expect(at == len(data), "the last chunk is cut off")
    return chunks


def read_shapes(payload):
    c = Columns(payload)
    n, vertices, faces, corners = c.take("I", 4)
    ids, bodies, groups, vertex_counts, face_counts = (c.take("I", n) for _ in range(5))
    volumes, densities = c.take("f", n), c.take("f", n)
    centroids, vertex = c.vectors(n), c.vectors(vertices)
    joints, planes, sizes, loop = c.take("I", faces), c.take("I", faces), c.take("H", faces), c.take("H", corners)
    c.end("SHAP")
    shapes, v, f, k = {}, 0, 0, 0
    for i in range(n):
        polygons = []
        for size in sizes[f:f + face_counts[i]]:
            polygons.append(loop[k:k + size])
            k += size
        shapes[ids[i]] = {"body": bodies[i], "group": groups[i], "volume": volumes[i], "density": densities[i],
                          "centroid": centroids[i], "vertices": vertex[v:v + vertex_counts[i]], "faces": polygons,
                          "joints": joints[f:f + face_counts[i]], "planes": planes[f:f + face_counts[i]]}
        v, f = v + vertex_counts[i], f + face_counts[i]
    expect((v, f, k) == (vertices, faces, corners), "SHAP: counts of blocks do not add up")
    return shapes


def read_blocks(payload):
    c = Columns(payload)
    time, cycle = c.take("d", 2)
    n, = c.take("I", 1)
    ids = c.take("I", n)
    columns = {"place": c.vectors(n), "turn": c.vectors(n, 4)}
    for name in ("velocity", "displacement", "rotation", "spin"):
        columns[name] = c.vectors(n)
    columns["unbalanced"], columns["flags"] = c.take("f", n), c.take("B", n)
    c.end("FRAM")
    return time, cycle, [dict({"id": ids[i]}, **{name: column[i] for name, column in columns.items()}) for i in range(n)]


def read_contacts(payload):
    c = Columns(payload)
    n, polygons, corners = c.take("I", 3)
    columns = {name: c.take("I", n) for name in ("a", "b", "joint", "plane")}
    columns["id"] = [a << 32 | b for a, b in zip(columns["a"], columns["b"])]
    columns.update({name: c.vectors(n) for name in ("point", "normal", "force")})
    columns.update({name: c.take("f", n) for name in ("area", "gap", "slip", "used")})
    columns["state"] = c.take("B", n)
    owner, sizes, corner = c.take("I", polygons), c.take("I", polygons), c.vectors(corners)
    c.end("CONT")
    expect(sum(sizes) == corners and all(k < n for k in owner), "CONT: polygons do not fit")
    contacts = [dict({name: column[i] for name, column in columns.items()}, polygons=[]) for i in range(n)]
    at = 0
    for contact, size in zip(owner, sizes):
        contacts[contact]["polygons"].append(corner[at:at + size])
        at += size
    return contacts


class Reader:
    """What a reader knows after some frames."""

    def __init__(self):
        self.head, self.shapes, self.frames, self.refused, self.touches = None, {}, 0, [], []

    def read(self, data):
        frame = {"fields": [], "contacts": None, "keys": None, "news": []}
        for name, payload in chunks_of(data):
            if name == "HEAD":
                self.head = json.loads(payload.decode("utf-8"))
            elif name == "SHAP":
                self.shapes.update(read_shapes(payload))
            elif name == "GONE":
                for gone in struct.unpack_from(f"<{struct.unpack_from('<I', payload)[0]}I", payload, 4):
                    expect(self.shapes.pop(gone, None), f"GONE: block {gone} was not there")
            elif name == "REFU":
                c = Columns(payload)
                total, n = c.take("I", 2)
                columns = {of: c.take("I", n) for of in ("joint", "plane", "block")}
                columns.update({of: c.vectors(n) for of in ("normal", "point")})
                columns.update({of: c.take("f", n) for of in ("thickness", "limit")})
                c.end("REFU")
                self.refused = [{of: column[i] for of, column in columns.items()} for i in range(n)]
                expect(total >= n, f"REFU: {total} cuts, {n} of them told")
            elif name == "TOUC":
                c = Columns(payload)
                n, = c.take("I", 1)
                self.touches = list(zip(c.take("I", n), c.vectors(n)))
                c.end("TOUC")
                expect(all(body in self.shapes and abs(dot(normal, normal) - 1) < 1e-6 for body, normal in self.touches), "TOUC: unit normals of bodies that are there")
                expect([body for body, _normal in self.touches] == sorted(body for body, _normal in self.touches), "TOUC: the bodies do not ascend")
            elif name == "FRAM":
                frame["time"], frame["cycle"], frame["blocks"] = read_blocks(payload)
            elif name == "CONT":
                frame["contacts"] = read_contacts(payload)
            elif name == "LAWS":
                n, = struct.unpack_from("<I", payload)
                laws = struct.unpack_from(f"<{n}I", payload, 4)
                expect(n == len(frame["contacts"]), "LAWS: one for each contact")
                expect(all(0 < law < len(self.head["laws"]) for law in laws), "LAWS: each is in the head")
                for contact, law in zip(frame["contacts"], laws):
                    contact["law"] = self.head["laws"][law]
            elif name == "FIEL":
                of, number, n = struct.unpack_from("<III", payload)
                frame["fields"].append((of, number, struct.unpack_from(f"<{n}f", payload, 12)))
            elif name == "LINE":
                c = Columns(payload)
                frame["line"] = c.take("d", 8)
                frame["histories"] = c.take("d", c.take("I", 1)[0])
                c.end("LINE")
            elif name == "KEYS":
                c = Columns(payload)
                n, = c.take("I", 1)
                frame["keys"] = list(zip(c.take("I", n), c.take("I", n), c.take("f", n), c.vectors(n)))
                c.end("KEYS")
            elif name == "FIND":
                frame["finding"] = json.loads(payload.rstrip(b"\0"))
            elif expect(name == "DONE", f"a chunk {name}"):
                expect(struct.unpack("<I", payload)[0] == self.frames, "DONE: another number")
            if name in ("HEAD", "SHAP", "GONE", "REFU", "TOUC"):
                frame["news"].append(name)
        self.frames += 1
        expect([b["id"] for b in frame["blocks"]] == sorted(self.shapes), "the blocks of FRAM are not those of SHAP")
        return frame


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def add(a, b, scale=1.0):
    return tuple(x + scale * y for x, y in zip(a, b))


def turned(q, v):
    t = tuple(2 * x for x in cross(q[:3], v))
    return add(add(v, t, q[3]), cross(q[:3], t))


def near(a, b, tolerance):
    if isinstance(a, (int, float)):
        return abs(a - b) <= tolerance or (math.isnan(a) and math.isnan(b))
    return len(a) == len(b) and all(abs(x - y) <= tolerance for x, y in zip(a, b))


def check_shape(shape, block):
    """Closed, every edge once each way, and of the block's volume about its centroid."""
    edges, volume, moment = set(), 0.0, (0.0, 0.0, 0.0)
    x = shape["vertices"]
    for loop in shape["faces"]:
        for a, b in zip(loop, loop[1:] + loop[:1]):
            expect((a, b) not in edges, f"block {block['id']}: an edge twice")
            edges.add((a, b))
        for b, c in zip(loop[1:], loop[2:]):
            part = dot(x[loop[0]], cross(x[b], x[c])) / 6
            volume += part
            moment = add(moment, add(add(x[loop[0]], x[b]), x[c]), part / 4)
    size = max(math.dist(a, b) for a in x for b in x)
    expect(all((b, a) in edges for a, b in edges), f"block {block['id']} is not closed")
    expect(near(volume, block["volume"], EXACT * size ** 3), f"block {block['id']}: volume {volume}, not {block['volume']}")
    expect(near(moment, (0, 0, 0), EXACT * size ** 4), f"block {block['id']}: its vertices are not about its centroid")
    expect(near(shape["volume"], block["volume"], EXACT * block["volume"]), "SHAP: volume")
    expect(near(shape["density"], block["density"], EXACT * block["density"]), "SHAP: density")


def check_block(head, shape, b, told, size):
    name = f"block {told['id']}"
    origin = head["origin"]
    expect(head["groups"][shape["group"]] == told["group"], f"{name}: group")
    expect(shape["body"] == told["body"], f"{name}: body")
    expect(near(add(b["place"], origin), told["centroid"], EXACT * size), f"{name}: place")
    expect(len(shape["vertices"]) == len(told["vertices"]), f"{name}: vertices")
    for mine, its in zip(shape["vertices"], told["vertices"]):
        expect(near(add(add(turned(b["turn"], mine), b["place"]), origin), its, EXACT * size), f"{name}: a vertex")
    for mine in ("velocity", "displacement", "spin"):
        expect(near(b[mine], told[mine], EXACT * (1 + math.hypot(*told[mine]))), f"{name}: {mine}")
    w, *axis = told["rotation"]
    angle = 2 * math.atan2(math.hypot(*axis), w)
    vector = [a * angle / math.hypot(*axis) if math.hypot(*axis) > 0 else 0.0 for a in axis]
    expect(near(b["rotation"], vector, EXACT), f"{name}: rotation {b['rotation']}, not {vector}")
    force = math.hypot(*told["force"])
    expect(near(b["unbalanced"], force, EXACT * force), f"{name}: unbalanced force")
    expect(b["flags"] == told["fixed"] + 2 * told["hidden"], f"{name}: flags")
    check_shape(shape, told)


STATES = ("elastic", "slipping", "open", "failed")


def check_contact(head, c, told, size):
    name = f"contact {told['id']}"
    expect((c["id"], c["a"], c["b"]) == (told["id"], told["a"], told["b"]), f"{name}: ids")
    joint = head["joints"][c["joint"]]
    expect((f"{joint}:{c['plane']}" if joint else "") == told["joint"], f"{name}: joint {joint}:{c['plane']}, not {told['joint']}")
    laws = [text for text, holds in (("coulomb: joint 'L:1'", told["joint"] == "L:1"), ("coulomb: joint 'new'", joint == "new"),
                                     ("slip_weakening: joint 'K'", joint == "K"), ("coulomb: joint '*'", True)) if holds and text in head["laws"]]
    expect(c["law"] == laws[0], f"{name}: law {c['law']}, not {laws[0]}")
    expect(near(add(c["point"], head["origin"]), told["point"], EXACT * size), f"{name}: point")
    expect(near(c["normal"], told["normal"], EXACT), f"{name}: normal")
    force = add(told["shear_force"], told["normal"], told["normal_force"])
    expect(near(c["force"], force, EXACT * (1 + math.hypot(*force))), f"{name}: force")
    expect(near(c["area"], told["area"], EXACT * told["area"]), f"{name}: area")
    expect(near(c["gap"], told["gap"], EXACT * abs(told["gap"])), f"{name}: gap")
    expect(near(c["slip"], told["slip"], EXACT * abs(told["slip"])), f"{name}: slip {c['slip']}, not {told['slip']}")
    expect(STATES[c["state"]] == told["state"], f"{name}: state")
    # of the shear at the points, which is no less than their sum; all of what a Coulomb joint bears slips
    least = math.hypot(*told["shear_force"]) / max(told["normal_force"] * math.tan(math.radians(25)), 1e-9)
    expect(math.isnan(c["used"]) or -1e-6 < c["used"] < 1 + 1e-5, f"{name}: {c['used']} of the strength is used")
    if told["joint"] == "" and told["normal_force"] > 0 and least > 0:
        expect(c["used"] > least * (1 - 1e-5), f"{name}: {c['used']} of the strength is used, at least {least}")
    check_polygons(name, c, told, size)


def check_polygons(name, c, told, size):
    """A patch is one polygon of the contact's area, square to its normal; a field contact has those of its surface."""
    if not c["polygons"] and told["area"] < 1e-6 * size * size:
        return  # what touched that little when the forces were found may have parted in the step
    expect(c["polygons"], f"{name}: no polygon")
    whole = (0.0, 0.0, 0.0)
    for polygon in c["polygons"]:
        expect(len(polygon) >= 3, f"{name}: a polygon of {len(polygon)} corners")
        for b, d in zip(polygon[1:], polygon[2:]):
            whole = add(whole, cross(add(b, polygon[0], -1), add(d, polygon[0], -1)), 0.5)
        expect(min(math.dist(corner, c["point"]) for corner in polygon) < size / 10, f"{name}: a polygon far from it")
    expect(dot(whole, c["normal"]) > 0, f"{name}: its polygons are clockwise")
    if len(c["polygons"]) == 1:
        # points stand while their faces move by a sixteenth of the least closure
        rim = sum(math.dist(b, d) for b, d in zip(polygon, polygon[1:] + polygon[:1]))
        slack = 1e-3 * told["area"] + rim * (abs(told["gap"]) / 16 + 1e-6 * size)
        expect(near(dot(whole, c["normal"]), told["area"], slack),
               f"{name}: a polygon of {dot(whole, c['normal'])} m2, not {told['area']}")


def check_fields(head, frame, told):
    names = {(of, number): head["fields"][number] for of, number, _ in frame["fields"]}
    expect(len(names) == len(head["fields"]), "a field has no chunk, or two")
    for of, number, values in frame["fields"]:
        field = head["fields"][number]
        expect(field["of"] == ("blocks", "contacts")[of], f"field {field}: of another thing")
        rows = told["contacts" if of else "blocks"]
        wanted = {"kinetic_energy": lambda row: row["kinetic"], "odd": lambda row: row["id"] / 8 if row["id"] % 2 else math.nan,
                  "width": lambda row: math.sqrt(row["area"]), "gap": lambda row: row["gap"]}[field["name"]]
        expect(field["unit"] == {"kinetic_energy": "J", "gap": "m"}.get(field["name"], ""), f"field {field}: unit")
        expect(len(values) == len(rows) and all(near(v, wanted(row), EXACT * abs(wanted(row)) if wanted(row) == wanted(row) else 0)
                                                for v, row in zip(values, rows)), f"field {field['name']}: values")


def check_frame(number, reader, frame, told):
    head, blocks = reader.head, told["blocks"]
    corners = [v for b in blocks for v in b["vertices"]]
    size = max(math.dist(corners[0], v) for v in corners) + max(math.dist(head["origin"], v) for v in corners)
    expect(size < 200, f"the origin {head['origin']} is far from the model")
    expect((frame["time"], frame["cycle"]) == (told["time"], told["cycle"]), f"frame {number}: time")
    expect(len(frame["blocks"]) == len(blocks), f"frame {number}: {len(frame['blocks'])} blocks, not {len(blocks)}")
    for b, its in zip(frame["blocks"], blocks):
        check_block(head, reader.shapes[b["id"]], b, its, size)
    expect(frame["line"][:2] == (told["time"], told["cycle"]), f"frame {number}: LINE")
    expect((frame["line"][2] > 0) == (number > 0), f"frame {number}: time step")
    expect(frame["line"][5:] == (told["kinetic"], told["damping"], told["friction"]), f"frame {number}: energies")
    wanted = told["contacts"]
    if number == 3:
        expect(frame["contacts"] is None and not frame["fields"], "contacts = false has contacts")
        return
    if number == 4:
        wanted = [c for c in wanted if c["state"] == "slipping"]
        expect(0 < len(wanted) < len(told["contacts"]), "the model should have contacts that slip and others")
        expect(frame["keys"] and all(1 <= mode <= 3 or factor != factor for _, mode, factor, _ in frame["keys"]), f"KEYS: {frame['keys']}")
    else:
        check_fields(head, frame, told)
    expect(len(frame["contacts"]) == len(wanted), f"frame {number}: {len(frame['contacts'])} contacts, not {len(wanted)}")
    for c, its in zip(frame["contacts"], wanted):
        check_contact(head, c, its, size)


def check_page(page, folder_text):
    """Names are data, and only the page's own script and style may run."""
    expect("img" not in page.names and "<img" not in folder_text, "a name of the model became part of the page")
    expect(page.texts["title"] == HOSTILE, f"title {page.texts['title']!r}")
    for name in ("script", "style"):
        digest = base64.b64encode(hashlib.sha256(page.texts[name].encode()).digest()).decode()
        expect(f"{name}-src 'sha256-{digest}'" in page.policy, f"the policy does not allow the {name}")
    for rule in ("default-src 'none'", "connect-src 'none'", "img-src data: blob:"):
        expect(rule in page.policy, f"the policy has no {rule}")
    expect("unsafe" not in page.policy and "*" not in page.policy, "the policy is weak")
    expect(page.names.count("script") == 1 + len(page.frames), "more scripts than one")


def check_refused(number, reader, told):
    expect(len(reader.refused) == len(told) and (number < 3 or told), f"frame {number}: {len(reader.refused)} refused cuts instead of {len(told)}")
    for got, cut in zip(reader.refused, told):
        place = [p + o for p, o in zip(got["point"], reader.head["origin"])]
        expect(f'{reader.head["joints"][got["joint"]]}:{got["plane"]}' == cut["joint"] and got["block"] == cut["block"] and near(got["normal"], cut["normal"], EXACT)
               and near(place, cut["point"], 1e-5) and near(got["thickness"], cut["thickness"], EXACT * cut["limit"])
               and near(got["limit"], cut["limit"], EXACT * cut["limit"]), f"frame {number}: a refused cut is {got} instead of {cut}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        at = pathlib.Path(folder)
        (at / "model.lua").write_text(MODEL, encoding="utf-8")
        environment = dict(os.environ)
        environment.pop("TALUS_PLUGIN_PATH", None)
        done = subprocess.run([PROGRAM, "--quiet", at / "model.lua", at / "page", at / "told", HOSTILE, JOINT], env=environment,
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            print(done.stdout + done.stderr)
            return 1
        text = (at / "page.html").read_text(encoding="utf-8")
        told = [json.loads(line) for line in (at / "told").read_text(encoding="utf-8").splitlines()]
    page, reader, news = Page(text), Reader(), []
    expect(len(page.frames) == len(told), f"{len(page.frames)} frames, not {len(told)}")
    for number, (given, packed) in enumerate(page.frames):
        data = zlib.decompress(base64.b64decode(packed, validate=True))
        frame = reader.read(data)
        news.append(frame["news"])
        largest = max(math.hypot(*b["displacement"]) for b in told[number]["blocks"])
        expect(int(given["data-frame"]) == number and int(given["data-bytes"]) == len(data), f"frame {number}: number or length")
        expect(float(given["data-time"]) == frame["time"] and int(given["data-cycle"]) == frame["cycle"], f"frame {number}: attributes")
        expect(near(float(given["data-largest"]), largest, 1e-9 * largest), f"frame {number}: largest displacement")
        expect(given["data-model"] == str(int(bool(frame["news"]))), f"frame {number}: whether it has news of the model")
        check_frame(number, reader, frame, told[number])
        verdict, finding = told[number]["verdict"], frame["finding"]
        for name in ("standing", "text", "stage", "moved", "contacts", "slipping"):
            expect(finding[name] == verdict[name], f"frame {number}: {name} of the finding is {finding[name]}, not {verdict[name]}")
        expect(near(finding["closed"], verdict["closed"], 1e-9 * verdict["closed"]), f"frame {number}: closed {finding['closed']}")
        expect(finding["hash"] == told[number]["hash"], f"frame {number}: state hash")
        frictions = [None, 25, 25] + ([None, 30] if number > 2 else [25])  # of L, one plane has another one
        expect(reader.head["friction"] == frictions, f"frame {number}: frictions {reader.head['friction']}")
        check_refused(number, reader, told[number]["refused"])
        if number in (0, 5):
            names = [(h["name"], h["unit"]) for h in reader.head["histories"]]
            expect(names == [("largest", ""), ("pair 1", ""), ("pair 2", ""), ("energy", "J"), ("way 1", "m"), ("way 2", "m"), ("way 3", "m")],
                   f"names of histories: {names}")
            expect(frame["histories"][1:3] == (1.5, 2.5), "values of histories")
    expect(news[:3] == [["HEAD", "SHAP", "TOUC"], ["TOUC"], ["TOUC"]], f"what is new in the first frames: {news}")
    expect("SHAP" in news[3] and "GONE" in news[3] and "GONE" in news[4], f"what is new after cuts: {news}")
    expect(JOINT in reader.head["joints"] and HOSTILE in reader.head["groups"], "names in HEAD")
    check_page(page, text)
    for fault in faults[:20]:
        print(fault)
    print(f"scene: {len(page.frames)} frames, {len(reader.shapes)} blocks, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

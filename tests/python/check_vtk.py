"""Reads the frames tests/unit/test_vtk.c wrote back with VTK and checks what is in them.

Usage: check_vtk.py FOLDER. FOLDER/expected.txt tells what the writer put in.
"""
import json
import math
import pathlib
import sys

import vtk

VOLUME_TOLERANCE = 1e-6  # relative; the writer loses no digits, the sum here loses a few
UNIT_TOLERANCE = 1e-12   # of unit vectors
SINGLE = 2.0 ** -23      # relative; arrays in single precision
STRETCH = 1e-3           # of areas: a segment is laid anew when its sides have stretched by so much

BLOCK_ARRAYS = {"displacement_size": 1, "block_id": 1, "group": 1, "body": 1, "volume": 1, "velocity": 3, "fixed": 1,
                "hidden": 1, "density": 1, "mass": 1, "displacement": 3, "rotation": 3,
                "unbalanced_force": 3}
BLOCK_POINT_ARRAYS = {"displacement": 3, "explode": 3}
CONTACT_ARRAYS = {"normal_force": 1, "shear_force": 3, "normal_stress": 1, "shear_stress": 1,
                  "state": 1, "joint": 1, "plane": 1, "law": 1, "area": 1, "normal": 3, "gap": 1,
                  "contact_id": 1, "block_a": 1, "block_b": 1}
JOINT_ARRAYS = {"joint": 1, "plane": 1, "law": 1, "block_id": 1, "block_b": 1, "contact_id": 1, "state": 1,
                "normal_stress": 1, "shear_stress": 1, "normal_force": 1, "shear_force": 3,
                "shear_displacement": 3, "slip": 1, "area": 1}
SECTION_ARRAYS = {"block_id": 1, "group": 1, "body": 1, "hidden": 1, "displacement": 3,
                  "displacement_in_plane": 3}
SECTION_POINT_ARRAYS = {"displacement": 3, "displacement_in_plane": 3}
ZONE_ARRAYS = {"mean": 1, "block_id": 1, "group": 1, "solid": 1, "cluster": 1, "stress": 6, "principal": 3,
               "deviator": 1, "state": 1, "plastic": 1}
ZONE_POINT_ARRAYS = {"displacement": 3, "velocity": 3, "force": 3, "fixed": 1}

checks = failures = 0


def check(condition, sentence):
    global checks, failures
    checks += 1
    if not condition:
        failures += 1
        print(f"check_vtk.py: {sentence}")
    return condition


def read(path, reader_class):
    """A data set as a plain reader gives it: VTK reports errors as events, not as exceptions."""
    errors = []
    reader = reader_class()
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(1))
    reader.SetFileName(str(path))
    reader.Update()
    check(not errors, f"{path.name}: the reader reports an error")
    check("Version 3.0" in path.open("rb").readline().decode(), f"{path.name}: header is not 3.0")
    check(reader.GetFileType() == 2, f"{path.name}: not binary")
    return reader.GetOutput()


def check_arrays(name, attributes, wanted, tuples):
    for array_name, components in wanted.items():
        array = attributes.GetArray(array_name)
        if check(array is not None, f"{name}: no array {array_name}"):
            check(array.GetNumberOfComponents() == components,
                  f"{name}: {array_name} has {array.GetNumberOfComponents()} components")
            check(array.GetNumberOfTuples() == tuples,
                  f"{name}: {array_name} has {array.GetNumberOfTuples()} of {tuples} values")
            values = [array.GetComponent(i, k) for i in range(array.GetNumberOfTuples())
                      for k in range(array.GetNumberOfComponents())]
            check(all(map(math.isfinite, values)), f"{name}: {array_name} is not finite")


def names_of(data, field):
    array = data.GetFieldData().GetAbstractArray(field)
    return [array.GetValue(i) for i in range(array.GetNumberOfValues())] if array else []


def scalar(data, field):
    return data.GetFieldData().GetArray(field).GetComponent(0, 0)


def face_loops(data, cell):
    """Vertex indices of each face, from the cell's face stream."""
    stream = vtk.vtkIdList()
    data.GetFaceStream(cell, stream)
    ids = [stream.GetId(i) for i in range(stream.GetNumberOfIds())]
    loops, at = [], 1
    for _ in range(ids[0]):
        loops.append(ids[at + 1:at + 1 + ids[at]])
        at += 1 + ids[at]
    return loops


def enclosed_volume(data, loops):
    """Divergence theorem: a sixth of the triple products over a fan of each face."""
    origin = data.GetPoint(loops[0][0])
    total = 0.0
    for loop in loops:
        a, *rest = [[p - o for p, o in zip(data.GetPoint(i), origin)] for i in loop]
        for b, c in zip(rest, rest[1:]):
            total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                      + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return total / 6


def check_cells(name, data):
    """Every cell closed and facing outward, of the volume its array says, sharing no vertex."""
    total, used = 0.0, set()
    volumes = data.GetCellData().GetArray("volume")
    for cell in range(data.GetNumberOfCells()):
        check(data.GetCellType(cell) == vtk.VTK_POLYHEDRON, f"{name}: cell {cell} is no polyhedron")
        loops = face_loops(data, cell)
        edges = [edge for loop in loops for edge in zip(loop, loop[1:] + loop[:1])]
        check(len(edges) == len(set(edges)) and all((b, a) in edges for a, b in edges),
              f"{name}: cell {cell} is not closed")
        vertices = {i for loop in loops for i in loop}
        check(not vertices & used, f"{name}: cell {cell} shares vertices")
        used |= vertices
        said, found = volumes.GetValue(cell), enclosed_volume(data, loops)
        check(abs(found - said) <= VOLUME_TOLERANCE * abs(said),
              f"{name}: cell {cell} encloses {found}, its array says {said}")
        total += found
    check(len(used) == data.GetNumberOfPoints(), f"{name}: points that belong to no cell")
    return total


def check_blocks(path, expected):
    data = read(path, vtk.vtkUnstructuredGridReader)
    blocks = int(expected["blocks"])
    check(data.GetNumberOfCells() == blocks,
          f"{path.name}: {data.GetNumberOfCells()} cells, expected {blocks}")
    check_arrays(path.name, data.GetCellData(), BLOCK_ARRAYS, blocks)
    check_arrays(path.name, data.GetPointData(), BLOCK_POINT_ARRAYS, data.GetNumberOfPoints())
    total = check_cells(path.name, data)
    wanted = float(expected["volume"])
    check(abs(total - wanted) <= VOLUME_TOLERANCE * wanted, f"{path.name}: volume {total}, not {wanted}")
    groups = names_of(data, "group_names")
    number = int(data.GetCellData().GetArray("group").GetValue(0))
    check(number < len(groups) and groups[number] == expected["group"],
          f"{path.name}: group {number} of {groups}")
    check(data.GetPointData().GetVectors() is not None, f"{path.name}: no vectors to warp by")
    return data


def check_explode(name, data):
    """Weighted by volume, the vectors away from the centre cancel; blocks apart differ."""
    cells, explode = data.GetCellData(), data.GetPointData().GetArray("explode")
    sums, vectors, total = [0.0] * 3, set(), 0.0
    for cell in range(data.GetNumberOfCells()):
        ids = {i for loop in face_loops(data, cell) for i in loop}
        own = {tuple(explode.GetTuple(i)) for i in ids}
        check(len(own) == 1, f"{name}: explode differs within cell {cell}")
        vectors |= own
        volume = cells.GetArray("volume").GetValue(cell)
        total += volume * math.hypot(*max(own))
        sums = [s + volume * e for s, e in zip(sums, own.pop())]
    check(all(abs(s) < SINGLE * total for s in sums), f"{name}: explode vectors sum to {sums}")
    check(len(vectors) == data.GetNumberOfCells(), f"{name}: blocks explode together")


def law_of(joint, laws):
    """Place of the law of a joint's contacts, by what the list says that each is for."""
    return laws.index("coulomb_tensile: joint 'oblique'" if joint == "oblique" else "elastic: joint '*'")


def check_contacts(path, expected):
    data = read(path, vtk.vtkPolyDataReader)
    count = int(expected["contacts"])
    check(data.GetNumberOfPoints() == data.GetNumberOfVerts() == count > 0,
          f"{path.name}: {data.GetNumberOfPoints()} points, {data.GetNumberOfVerts()} vertices, "
          f"expected {count}")
    points = data.GetPointData()
    check_arrays(path.name, points, CONTACT_ARRAYS, count)
    names = names_of(data, "joint_names")
    check(names == ["", "east", "north", "up", "oblique"], f"{path.name}: joint names {names}")
    laws = names_of(data, "law_names")
    for i in range(count):
        normal = points.GetArray("normal").GetTuple(i)
        check(abs(math.hypot(*normal) - 1) < UNIT_TOLERANCE, f"{path.name}: normal {normal}")
        check(points.GetArray("state").GetValue(i) in (0, 1, 2, 3), f"{path.name}: state")
        check(0 <= points.GetArray("joint").GetValue(i) < len(names), f"{path.name}: joint")
        check(points.GetArray("law").GetValue(i) == law_of(names[points.GetArray("joint").GetValue(i)], laws), f"{path.name}: law")
        check(points.GetArray("block_a").GetValue(i) < points.GetArray("block_b").GetValue(i),
              f"{path.name}: contact {i} does not order its blocks")
    check_states(path.name, points, names, count)
    joints = {int(points.GetArray("joint").GetValue(i)) for i in range(count)}
    check(joints >= {1, 2, 3, 4}, f"{path.name}: contacts of joints {joints} only")
    return data


def check_states(name, points, names, count):
    """States of laws: bonds hold where the joint is bonded, NaN where its law has no such state."""
    bond = points.GetArray("bond")
    if not check(bond is not None and bond.GetNumberOfTuples() == count, f"{name}: no array bond"):
        return
    for i in range(count):
        bonded = names[int(points.GetArray("joint").GetValue(i))] == "oblique"
        value = bond.GetValue(i)
        check(value == 1 if bonded else math.isnan(value), f"{name}: bond {value} of contact {i}")


def check_joints(path, contacts):
    """Every flush contact is shown once, by a polygon of its area and state that faces its normal."""
    data = read(path, vtk.vtkPolyDataReader)
    name, cells, polygons = path.name, data.GetCellData(), data.GetNumberOfPolys()
    check(polygons > 0, f"{name}: no polygons")
    check_arrays(name, cells, JOINT_ARRAYS, polygons)
    check({int(cells.GetArray("joint").GetValue(i)) for i in range(polygons)} == {1, 2, 3, 4},
          f"{name}: not all joints have faces")
    points = contacts.GetPointData()
    of_contact = {int(points.GetArray("contact_id").GetValue(i)): i
                  for i in range(contacts.GetNumberOfPoints())}
    shown = []
    for cell in range(polygons):
        contact = int(cells.GetArray("contact_id").GetValue(cell))
        if contact == 0:
            check(cells.GetArray("state").GetValue(cell) == 4, f"{name}: state without a contact")
            check(cells.GetArray("block_b").GetValue(cell) == 0, f"{name}: block without a contact")
            continue
        shown.append(contact)
        row = of_contact[contact]
        normal = points.GetArray("normal").GetTuple(row)
        area = points.GetArray("area").GetValue(row)
        # VTK keeps points in single precision
        check(abs(polygon_area(data, cell, normal) - area) <= 1e-5 * area,
              f"{name}: area of polygon {cell}")
        for array in ("state", "joint", "normal_force", "shear_stress"):
            value = points.GetArray(array).GetValue(row)
            check(abs(cells.GetArray(array).GetValue(cell) - value) <= SINGLE * abs(value),
                  f"{name}: {array} of polygon {cell}")
        slip = cells.GetArray("shear_displacement").GetTuple(cell)
        size = cells.GetArray("slip").GetValue(cell)
        check(abs(math.hypot(*slip) - size) <= 2 * SINGLE * size,
              f"{name}: slip of polygon {cell}")
    check(sorted(shown) == sorted(of_contact), f"{name}: contacts shown {shown}")
    check(cells.GetArray("bond") is not None, f"{name}: no states of laws")


def polygon_area(data, cell, normal):
    """Signed by the normal: polygons run counter-clockwise as seen from above the plane."""
    corners = vtk.vtkIdList()
    data.GetCellPoints(cell, corners)
    points = [data.GetPoint(corners.GetId(i)) for i in range(corners.GetNumberOfIds())]
    check(len(points) >= 3, f"polygon {cell} has {len(points)} corners")
    total = 0.0
    for b, c in zip(points[1:], points[2:]):
        u, v = ([x - o for x, o in zip(p, points[0])] for p in (b, c))
        total += normal[0] * (u[1] * v[2] - u[2] * v[1]) + normal[1] * (
            u[2] * v[0] - u[0] * v[2]) + normal[2] * (u[0] * v[1] - u[1] * v[0])
    return total / 2


def check_section(path, dip, direction, area, tolerance=1e-12):
    """Polygons in the plane that add up to the area; displacements in it have no part across."""
    data = read(path, vtk.vtkPolyDataReader)
    name = path.name
    dip, direction = math.radians(dip), math.radians(direction)
    normal = (math.sin(dip) * math.sin(direction), math.sin(dip) * math.cos(direction),
              math.cos(dip))
    check_arrays(name, data.GetCellData(), SECTION_ARRAYS, data.GetNumberOfPolys())
    check_arrays(name, data.GetPointData(), SECTION_POINT_ARRAYS, data.GetNumberOfPoints())
    areas = [polygon_area(data, i, normal) for i in range(data.GetNumberOfPolys())]
    check(all(a > 0 for a in areas), f"{name}: polygons turned over")
    check(abs(sum(areas) - area) <= tolerance * area, f"{name}: area {sum(areas)}, not {area}")
    ids = {int(data.GetCellData().GetArray("block_id").GetValue(i)) for i in range(len(areas))}
    check(len(ids) == len(areas), f"{name}: a block has more than one polygon")
    heights = [sum(n * x for n, x in zip(normal, data.GetPoint(i)))
               for i in range(data.GetNumberOfPoints())]
    check(max(heights) - min(heights) < 1e-12, f"{name}: points off the plane")
    for attributes in (data.GetPointData(), data.GetCellData()):
        whole = attributes.GetArray("displacement")
        flat = attributes.GetArray("displacement_in_plane")
        for i in range(whole.GetNumberOfTuples()):
            u, v = whole.GetTuple(i), flat.GetTuple(i)
            across = sum(a * n for a, n in zip(u, normal))
            check(all(abs(a - across * n - b) < 1e-15 for a, n, b in zip(u, normal, v)),
                  f"{name}: displacement in the plane")
    return data


def check_sections(folder):
    times = check_series(folder, "cut", "section", 2)
    check(times[0] == 0 and times[1] > 0, f"sections: times {times}")
    check_series(folder, "cut", "blocks", 1)
    still = check_section(folder / "cut_section_000000.vtk", 90, 90, 6)
    later = check_section(folder / "cut_section_000001.vtk", 90, 90, 6, tolerance=1e-6)
    check(moved(still) == 0 and moved(later) > 0, "sections: displacements")
    check_section(folder / "along_section_000000.vtk", 90, 90, 6)
    # VTK keeps points in single precision
    check_section(folder / "steep_section_000000.vtk", 50, 320, steep_area(), tolerance=1e-6)
    for name in ("outside", "empty"):
        data = read(folder / f"{name}_section_000000.vtk", vtk.vtkPolyDataReader)
        check(data.GetNumberOfCells() == 0, f"{name}: has a section")


def steep_area():
    """Of the section of the whole box by the plane, by VTK itself."""
    box, plane, cut = vtk.vtkCubeSource(), vtk.vtkPlane(), vtk.vtkCutter()
    box.SetBounds(0, 4, 0, 3, 0, 2)
    dip, direction = math.radians(50), math.radians(320)
    plane.SetNormal(math.sin(dip) * math.sin(direction), math.sin(dip) * math.cos(direction),
                    math.cos(dip))
    plane.SetOrigin(2, 1.5, 1)
    cut.SetInputConnection(box.GetOutputPort())
    cut.SetCutFunction(plane)
    cut.Update()
    points = [cut.GetOutput().GetPoint(i) for i in range(cut.GetOutput().GetNumberOfPoints())]
    n, o = plane.GetNormal(), plane.GetOrigin()
    side = [n[1], -n[0], 0.0]
    length = math.hypot(*side)
    side = [s / length for s in side]
    up = [n[1] * side[2] - n[2] * side[1], n[2] * side[0] - n[0] * side[2],
          n[0] * side[1] - n[1] * side[0]]
    flat = [(sum((x - c) * s for x, c, s in zip(p, o, side)),
             sum((x - c) * s for x, c, s in zip(p, o, up))) for p in points]
    flat.sort(key=lambda q: math.atan2(q[1], q[0]))
    return abs(sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(flat, flat[1:] + flat[:1]))) / 2


def check_series(folder, prefix, content, frames):
    path = folder / f"{prefix}_{content}.vtk.series"
    index = json.loads(path.read_text())
    check(index["file-series-version"] == "1.0", f"{path.name}: version")
    times = [f["time"] for f in index["files"]]
    check(len(times) == frames, f"{path.name}: {len(times)} frames, expected {frames}")
    check(times == sorted(set(times)), f"{path.name}: times do not ascend")
    for i, f in enumerate(index["files"]):
        check(f["name"] == f"{prefix}_{content}_{i:06d}.vtk", f"{path.name}: names {f['name']}")
        check((folder / f["name"]).exists(), f"{path.name}: {f['name']} does not exist")
    return times


def check_empty(folder):
    blocks = read(folder / "empty_blocks_000000.vtk", vtk.vtkUnstructuredGridReader)
    check(blocks.GetNumberOfCells() == 0 and blocks.GetNumberOfPoints() == 0, "empty: has blocks")
    check(scalar(blocks, "TIME") == 0, "empty: no TIME")
    for content in ("contacts", "joints"):
        data = read(folder / f"empty_{content}_000000.vtk", vtk.vtkPolyDataReader)
        check(data.GetNumberOfCells() == 0, f"empty: has {content}")


def tetrahedron(data, cell):
    """Its volume, positive where VTK's order of points is kept."""
    corners = vtk.vtkIdList()
    data.GetCellPoints(cell, corners)
    a, b, c, d = (data.GetPoint(corners.GetId(i)) for i in range(4))
    u, v, w = ([x - o for x, o in zip(p, a)] for p in (b, c, d))
    return (w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) + w[2] * (u[0] * v[1] - u[1] * v[0])) / 6


def check_invariants(name, cells, cell):
    """Mean, deviator and principal stresses are those of the stress; a zone that has yielded is told so."""
    xx, yy, zz, xy, yz, zx = cells.GetArray("stress").GetTuple(cell)
    high, middle, low = cells.GetArray("principal").GetTuple(cell)
    size = max(map(abs, (xx, yy, zz, xy, yz, zx, 1.0)))
    near = 8 * SINGLE * size
    check(high >= middle - near and middle >= low - near, f"{name}: principal stresses of zone {cell} do not descend")
    check(abs(high + middle + low - xx - yy - zz) < near, f"{name}: principal stresses of zone {cell} have another sum")
    squares = xx * xx + yy * yy + zz * zz + 2 * (xy * xy + yz * yz + zx * zx)
    check(abs(high ** 2 + middle ** 2 + low ** 2 - squares) < near * 3 * size, f"{name}: principal stresses of zone {cell} have another norm")
    check(abs(cells.GetArray("mean").GetValue(cell) - (xx + yy + zz) / 3) < near, f"{name}: mean stress of zone {cell}")
    j2 = squares / 2 - (xx + yy + zz) ** 2 / 6
    check(abs(cells.GetArray("deviator").GetValue(cell) ** 2 - 3 * j2) < near * 10 * size, f"{name}: deviator of zone {cell}")
    check((cells.GetArray("state").GetValue(cell) != 0) == (cells.GetArray("plastic").GetValue(cell) != 0), f"{name}: state of zone {cell}")


def check_segments(folder):
    """The column is in contact with the floor and what lies on it, by segments: their outlines make up the areas."""
    contacts, joints = (read(folder / f"zoned_{what}_000001.vtk", vtk.vtkPolyDataReader) for what in ("contacts", "joints"))
    points, cells = contacts.GetPointData(), joints.GetCellData()
    ids = [(points.GetArray("block_a").GetValue(i), points.GetArray("block_b").GetValue(i)) for i in range(contacts.GetNumberOfPoints())]
    check(ids == [(1, 2), (2, 3)], f"zones: contacts of {ids}")
    for i, pair in enumerate(ids):
        area, force, normal = points.GetArray("area").GetValue(i), points.GetArray("normal_force").GetValue(i), points.GetArray("normal").GetTuple(i)
        check(abs(area - 2) < 1e-3 and force > 1e4 and normal[2] > 0.999, f"zones: contact {pair} has an area of {area}, {force} N, normal {normal}")
        own = [cell for cell in range(joints.GetNumberOfPolys()) if cells.GetArray("contact_id").GetValue(cell) == points.GetArray("contact_id").GetValue(i)]
        whole = sum(polygon_area(joints, cell, normal) for cell in own)
        check(len(own) > 4 and abs(whole - area) < STRETCH * area, f"zones: {len(own)} segments of contact {pair} have {whole} m2, not {area}")


def cut_zones(data, axis, height):
    """The zones that a plane across an axis cuts, and the area in which it does, by VTK itself."""
    plane, cut, mass = vtk.vtkPlane(), vtk.vtkCutter(), vtk.vtkMassProperties()
    plane.SetNormal(*(float(k == axis) for k in range(3)))
    plane.SetOrigin(*(height * (k == axis) for k in range(3)))
    cut.SetInputData(data)
    cut.SetCutFunction(plane)
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(cut.GetOutputPort())
    mass.SetInputConnection(triangles.GetOutputPort())
    mass.Update()
    heights = [[data.GetPoint(data.GetCell(i).GetPointId(k))[axis] for k in range(4)] for i in range(data.GetNumberOfCells())]
    return [i for i, of in enumerate(heights) if min(of) < height < max(of)], mass.GetSurfaceArea()


def check_zone_section(path, data, axis, height, normal, rigid):
    """A polygon for each zone that is cut, with the zone's values, behind those of the rigid blocks."""
    section, name = read(path, vtk.vtkPolyDataReader), path.name
    zones, area = cut_zones(data, axis, height)
    cells, count = section.GetCellData(), section.GetNumberOfPolys()
    if not check(count == len(zones) + len(rigid) and len(zones) > 10, f"{name}: {count} polygons of {len(zones)} zones and {len(rigid)} blocks"):
        return
    ids = [int(cells.GetArray("block_id").GetValue(i)) for i in range(count)]
    check(ids == rigid + [2] * len(zones), f"{name}: blocks {ids}")
    areas = [polygon_area(section, i, normal) for i in range(count)]
    check(min(areas) > 0 and abs(sum(areas[len(rigid):]) - area) < 1e-5 * area, f"{name}: area {sum(areas[len(rigid):])}, not {area}")
    check(max(section.GetCell(i).GetNumberOfPoints() for i in range(len(rigid), count)) == 4, f"{name}: zones have no quadrangles")
    check(all(abs(section.GetPoint(i)[axis] - height) < 1e-6 for i in range(section.GetNumberOfPoints())), f"{name}: points off the plane")
    for array, width in {**ZONE_ARRAYS, "plastic_shear": 1}.items():
        of_zones, of_section = data.GetCellData().GetArray(array), cells.GetArray(array)
        if not check(of_section is not None and of_section.GetNumberOfComponents() == width, f"{name}: no array {array}"):
            continue
        same = all(of_zones.GetTuple(zone) == of_section.GetTuple(len(rigid) + i) for i, zone in enumerate(zones))
        check(same, f"{name}: {array} is not that of the zones")
        if array not in ("block_id", "group"):
            values = [value for i in range(len(rigid)) for value in of_section.GetTuple(i)]
            check(all(value == -1 or math.isnan(value) for value in values), f"{name}: {array} of rigid blocks {values}")
    if axis == 2:
        own = [cells.GetArray("displacement").GetTuple(i)[2] for i in range(count)]
        check(max(own) < 0 and moved(section) <= moved(data), f"{name}: displacements {own}")


def check_zones(folder):
    """The column of zones: its volume and stress, the names of solid and group, and its surface in the file of the blocks."""
    times = check_series(folder, "zoned", "zones", 2)
    check(check_series(folder, "zoned", "blocks", 2) == times, "zones: other times than blocks")
    expected = dict(line.split(" ", 1) for line in (folder / "zoned.txt").read_text().splitlines())
    first, data = (read(folder / f"zoned_zones_{i:06d}.vtk", vtk.vtkUnstructuredGridReader) for i in range(2))
    name, count, cells, points = "zoned_zones_000001.vtk", int(expected["zones"]), data.GetCellData(), data.GetPointData()
    check(data.GetNumberOfCells() == count > 50 and data.GetNumberOfPoints() == int(expected["points"]),
          f"{name}: {data.GetNumberOfCells()} cells, {data.GetNumberOfPoints()} points, expected {expected}")
    check_arrays(name, cells, {**ZONE_ARRAYS, "mine": 1, "plastic_shear": 1}, count)
    check_arrays(name, points, ZONE_POINT_ARRAYS, data.GetNumberOfPoints())
    check(first.GetCellData().GetArray("mine") is None and moved(first) == 0 and moved(data) > 0, "zones: the first frame")
    check(names_of(data, "solid_names") == ["rock"], f"{name}: solids {names_of(data, 'solid_names')}")
    check({cells.GetArray("block_id").GetValue(i) for i in range(count)} == {2}, f"{name}: blocks")
    clusters = [cells.GetArray("cluster").GetValue(i) for i in range(count)]
    check(sorted(set(clusters)) == list(range(max(clusters) + 1)) and max(map(clusters.count, clusters)) <= 10, f"{name}: clusters")
    check([cells.GetArray("mine").GetValue(i) for i in range(count)] == [0.5 * i for i in range(count)], f"{name}: added numbers")
    volume, sums, plastic = 0.0, [0.0] * 6, 0
    for cell in range(count):
        check(data.GetCellType(cell) == vtk.VTK_TETRA, f"{name}: cell {cell} is no tetrahedron")
        own = tetrahedron(data, cell)
        check(own > 0, f"{name}: zone {cell} is turned inside out")
        volume += own
        sums = [s + own * x for s, x in zip(sums, cells.GetArray("stress").GetTuple(cell))]
        plastic += cells.GetArray("plastic").GetValue(cell) != 0
        check_invariants(name, cells, cell)
    check(abs(volume - float(expected["volume"])) < 1e-5 * volume, f"{name}: volume {volume}, expected {expected['volume']}")
    wanted = [float(x) for x in expected["stress"].split()]
    check(all(abs(a - b) < 1e-5 * max(map(abs, wanted)) for a, b in zip(sums, wanted)), f"{name}: stress {sums}, expected {wanted}")
    check(0 < plastic == int(expected["plastic"]) < count, f"{name}: {plastic} zones have yielded, expected {expected['plastic']}")
    check_segments(folder)
    check_zone_section(folder / "zoned_level_section_000000.vtk", data, 2, 1.4, (0, 0, 1), [])
    check_zone_section(folder / "zoned_upright_section_000000.vtk", data, 1, 0.45, (0, 1, 0), [1, 3])
    blocks = read(folder / "zoned_blocks_000001.vtk", vtk.vtkUnstructuredGridReader)
    loops = face_loops(blocks, 1)
    edges = [edge for loop in loops for edge in zip(loop, loop[1:] + loop[:1])]
    check(len(edges) == len(set(edges)) and all((b, a) in edges for a, b in edges), "zones: the surface of the block is not closed")
    check(all(len(loop) == 3 for loop in loops) and len(loops) > 20, f"zones: the block has {len(loops)} faces")
    check(abs(enclosed_volume(blocks, loops) - volume) < 1e-5 * volume, "zones: the surface of the block encloses another volume")


def moved(data):
    array = data.GetPointData().GetArray("displacement")
    return max(abs(c) for i in range(array.GetNumberOfTuples()) for c in array.GetTuple(i))


def main():
    folder = pathlib.Path(sys.argv[1])
    lines = (folder / "expected.txt").read_text().splitlines()
    expected = dict(line.split(" ", 1) for line in lines)
    times = check_series(folder, "run", "blocks", 2)
    check(times[0] == 0 and times[1] > 0, f"times {times}")
    check(check_series(folder, "run", "contacts", 2) == times, "contacts: other times")
    check(check_series(folder, "run", "joints", 2) == times, "joints: other times")
    frames = [check_blocks(folder / f"run_blocks_{i:06d}.vtk", expected) for i in range(2)]
    for i, data in enumerate(frames):
        check(scalar(data, "TIME") == times[i], f"frame {i}: TIME")
        check_explode(f"frame {i}", data)
        contacts = check_contacts(folder / f"run_contacts_{i:06d}.vtk", expected)
        check_joints(folder / f"run_joints_{i:06d}.vtk", contacts)
    check(moved(frames[0]) == 0, "frame 0: displaced")
    check(moved(frames[1]) > 0, "frame 1: nothing has moved")
    check_series(folder, 'quote"b', "blocks", 1)
    check_series(folder / "new" / "folder", "a", "blocks", 2)
    check_empty(folder)
    check_sections(folder)
    check_zones(folder)
    print(f"check_vtk.py: {checks} checks, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

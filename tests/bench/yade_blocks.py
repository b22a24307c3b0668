# yade_blocks.py - the blocks of a block model (docs/block_model.md) in Yade's polyhedra, timed as Talus is.
#
#     BLOCKS=wall.json WORKLOAD="yade wall" SIZE=1000 STEPS=5 REPS=3 yade-double -n -x -j1 yade_blocks.py
#
# The normal stiffness KN (Pa/m on a face) becomes Yade's modulus 2 KN: its law takes the force from the
# volume of the overlap, with two moduli in series. Prints rows of CSV; a face contact is one whose overlap has
# more than FACE of volume (m3). Only Yade's public interface is used.
import json
import os
import sys
import time

from yade import polyhedra_utils, log

log.setDefaultLogLevel(1)


def setting(name, default):
    return type(default)(os.environ.get(name, default))


KN, DT, VERLET, FACE = setting("KN", 1e9), setting("DT", 2e-4), setting("VERLET", 0.01), 1e-6
DAMPING, STEPS, REPS = setting("DAMPING", 0.2), setting("STEPS", 5), setting("REPS", 3)
FREE, HELD = 1, 3  # groups: held blocks do not look at each other

with open(os.environ["BLOCKS"]) as file:
    blocks = json.load(file)["blocks"]
material = PolyhedraMat(density=blocks[0]["density"], young=2 * KN, poisson=0.5, frictionAngle=0.6)
O.materials.append(material)
for block in blocks:
    body = polyhedra_utils.polyhedra(material, v=[tuple(p) for p in block["vertices"]])
    held = bool(block.get("fixed"))
    body.mask = HELD if held else FREE
    if held:
        body.state.blockedDOFs = "xyzXYZ"
    O.bodies.append(body)
free = sum(1 for body in O.bodies if body.mask == FREE)

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Polyhedra_Aabb()], verletDist=VERLET, avoidSelfInteractionMask=2),
    InteractionLoop(
        [Ig2_Polyhedra_Polyhedra_PolyhedraGeom()],
        [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
        [Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()]),
    NewtonIntegrator(damping=DAMPING, gravity=(0, 0, -9.81)),
]
O.dt = DT
O.run(3, wait=True)

threads = int(os.environ.get("OMP_NUM_THREADS", "1"))
clock = time.process_time if threads == 1 else time.time
seconds = []
for _ in range(REPS):
    began = clock()
    O.run(STEPS, wait=True)
    seconds.append((clock() - began) / STEPS)
step = sorted(seconds)[len(seconds) // 2]
loaded = [i for i in O.interactions if i.isReal and i.phys.normalForce.norm() > 0]
faces = sum(1 for i in loaded if i.geom.penetrationVolume > FACE)
print("workload,size,blocks,contacts,face_contacts,threads,reuse,rate,unit,block_steps_per_s")
print("%s,%s,%d,%d,%d,%d,,%.5g,contacts/s,%.5g" % (os.environ["WORKLOAD"], os.environ["SIZE"], free, len(loaded),
      faces, threads, len(loaded) / step, free / step))
sys.stdout.flush()

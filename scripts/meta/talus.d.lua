---@meta talus

-- Talus for the Lua language server: every function, option and field, with units.
-- Written by scripts/tools/meta.lua from what `talus help` prints; do not edit.

--- {x, y, z}
---@alias talus.Vector number[]

--- Components left out are 0.
---@class (exact) talus.Tensor
---@field xx? number
---@field yy? number
---@field zz? number
---@field xy? number
---@field yz? number
---@field zx? number

---@class talus
---@field version string
local talus = {}

--- Prints what `talus help TOPIC` prints: the overview, a function or a plugin.
---@param topic? string
function talus.help(topic) end

--- Rough joints: hyperbolic closure, and friction from roughness and wall strength that slip wears down.
---@class (exact) talus.law.BartonBandis
---@field jrc number in [0, 30]: joint roughness coefficient of the length lab_length
---@field jcs number Pa, > 0: joint wall compressive strength of the length lab_length
---@field phi_r number deg, in [0, 70): residual angle of friction
---@field lab_length? number m, > 0, default 0.1: length L0 of the specimen of jrc and jcs
---@field length? number m, > 0: length L of the joint between crossings, in metres whatever the other units, for the peak's slip is an empirical formula; not given: lab_length
---@field kni? number Pa/m, > 0: normal stiffness of the unloaded joint
---@field kn? number Pa/m, > 0: normal stiffness of the unloaded joint
---@field vm number m, > 0: largest closure, from the unloaded joint
---@field ks number Pa/m, > 0: shear stiffness where nothing slips
---@field linear_from? number Pa, > 0: normal stress beyond which closure is linear; a smaller one allows a longer time step; not given: the wall strength of the joint's length
---@field reduction? number > 0, default 1: the shear strength is divided by it
---@field dilation? boolean default true: whether slip opens the joint

--- A bond that softens and breaks in tension and shear (mixed mode), with friction on what is broken.
---@class (exact) talus.law.Cohesive
---@field kn number Pa/m, > 0: normal stiffness of the joint
---@field ks number Pa/m, > 0: shear stiffness of the joint
---@field tension number Pa, > 0: tensile strength of the bond
---@field cohesion number Pa, > 0: shear strength of the bond
---@field energy_tension? number J/m2, > 0: work of fracture in tension, more than tension^2 / (2 kn)
---@field gi? number J/m2, > 0: work of fracture in tension, more than tension^2 / (2 kn) (another name)
---@field energy_shear? number J/m2, > 0: work of fracture in shear, more than cohesion^2 / (2 ks)
---@field gii? number J/m2, > 0: work of fracture in shear, more than cohesion^2 / (2 ks) (another name)
---@field friction? number deg, in [0, 90], default 0: angle of friction of what is broken; 90: no slip while it is pressed

--- A joint that yields from the first slip on, and whose friction wears down: for cyclic loading.
---@class (exact) talus.law.ContinuouslyYielding
---@field an number Pa^(1-en)/m, > 0: normal stiffness at a normal stress of 1 Pa
---@field en? number in [0, 1), default 0: exponent of the normal stress in it
---@field as number Pa^(1-es)/m, > 0: shear stiffness at a normal stress of 1 Pa
---@field es? number in [0, 1], default 0: exponent of the normal stress in it
---@field kn_max? number Pa/m, > 0: largest normal stiffness, for the time step; needed with en > 0
---@field ks_max? number Pa/m, > 0: largest shear stiffness, for the time step; needed with es > 0
---@field phi_i number deg, in (0, 90): angle of friction of the fresh joint
---@field phi? number deg, in (0, 90): angle of friction of the worn joint, at most phi_i
---@field friction? number deg, in (0, 90): angle of friction of the worn joint, at most phi_i (another name)
---@field roughness number m, > 0: slip R in which all but 1/e of the difference wears off
---@field softening? boolean default true: whether the stress falls after the strength that wears
---@field dilation? boolean default true: whether slip opens the joint

--- Coulomb friction with cohesion and dilation, and no tensile strength.
---@class (exact) talus.law.Coulomb
---@field kn number Pa/m, > 0: normal stiffness of the joint
---@field ks number Pa/m, > 0: shear stiffness of the joint
---@field friction? number deg, in [0, 90], default 0: angle of friction; 90: no slip while it is closed
---@field cohesion? number Pa, >= 0, default 0: shear strength at zero normal stress
---@field dilation? number deg, in [0, 90), default 0: angle of dilation: slip opens the joint; at most the friction
---@field dilation_limit? number m, >= 0: slip after which dilation ends

--- Coulomb friction with a bond that breaks in tension or shear and does not heal.
---@class (exact) talus.law.CoulombTensile
---@field kn number Pa/m, > 0: normal stiffness of the joint
---@field ks number Pa/m, > 0: shear stiffness of the joint
---@field friction? number deg, in [0, 90], default 0: angle of friction; 90: no slip while it is pressed
---@field cohesion? number Pa, >= 0, default 0: cohesion of the bond
---@field tension? number Pa, >= 0, default 0: tensile strength of the bond
---@field residual_friction? number deg, in [0, 90]: angle of friction after the bond is lost; not given: friction
---@field residual_cohesion? number Pa, >= 0, default 0: cohesion after the bond is lost
---@field residual_tension? number Pa, >= 0, default 0: tensile strength after the bond is lost
---@field dilation? number deg, in [0, 90), default 0: angle of dilation: slip opens the joint; at most the friction, whole and residual
---@field dilation_limit? number m, >= 0: slip after which dilation ends

--- Linear springs across the joint, without strength limits; carries tension.
---@class (exact) talus.law.Elastic
---@field kn number Pa/m, > 0: normal stiffness of the joint
---@field ks number Pa/m, > 0: shear stiffness of the joint

--- Friction that depends on the rate of slip and on a state of the surface that ages.
---@class (exact) talus.law.RateState
---@field kn number Pa/m, > 0: normal stiffness of the joint
---@field ks number Pa/m, > 0: shear stiffness of the joint
---@field mu0? number in (0, 10], default 0.6: coefficient of friction in steady slip at `velocity`
---@field a number in (0, 1]: direct effect of the rate
---@field b number in [0, 1]: effect of the state; b > a weakens with the rate
---@field distance? number m, > 0: slip D_c over which the state changes
---@field dc? number m, > 0: slip D_c over which the state changes (another name)
---@field velocity? number m/s, > 0, default 1e-06: reference rate V0
---@field v0? number m/s, > 0, default 1e-06: reference rate V0 (another name)
---@field damping? number Pa s/m, >= 0, default 0: viscous part eta: shear modulus over twice the speed of shear waves, where blocks do not radiate themselves
---@field theta? number s, > 0: state of a new contact; not given: distance / velocity, that of steady slip
---@field evolution? "aging"|"slip" default "aging": how the state changes: it also ages at rest, or with slip only

--- Friction and cohesion that fall with slip, and may heal where it ends.
---@class (exact) talus.law.SlipWeakening
---@field kn number Pa/m, > 0: normal stiffness of the joint
---@field ks number Pa/m, > 0: shear stiffness of the joint
---@field friction number deg, in [0, 90]: angle of friction before slip; 90: none while it is closed
---@field cohesion? number Pa, >= 0, default 0: cohesion before slip
---@field residual_friction? number deg, in [0, 90]: angle of friction after slip, at most friction; not given: friction
---@field residual_cohesion? number Pa, >= 0, default 0: cohesion after slip, at most cohesion
---@field distance number m, > 0: slip D_c over which the strength falls: all of it, or in the exponential form all but 1/e
---@field form? "linear"|"exponential" default "linear": how the strength falls with slip
---@field healing? "none"|"instant"|"time" default "none": whether strength comes back where slip has ended: never, at once, or in time
---@field healing_time? number s, > 0: for healing = "time": time in which all but 1/e of the lost strength comes back

--- Viscous damping that follows the rate of kinetic energy; vanishes at rest and in steady motion.
---@class (exact) talus.damping.Adaptive
---@field target? number in (0, 1), default 0.5: share of the rate of kinetic energy that damping absorbs
---@field start? number 1/s, > 0: first coefficient; not given: 0.01 / time step
---@field minimum? number 1/s, > 0: smallest coefficient; not given: 1e-8 / time step
---@field maximum? number 1/s, > 0: largest coefficient; not given: 1 / time step
---@field factor? number in (1, 10], default 1.1: largest change of the coefficient in one step

--- Local damping that also damps vibration about a steady motion; for slow sliding and flow.
---@class (exact) talus.damping.Combined
---@field alpha? number in [0, 1), default 0.8: share of the unbalanced force that opposes motion

--- Dashpots at contacts, in proportion to their stiffness; for impacts.
---@class (exact) talus.damping.Dashpot
---@field ratio number > 0: fraction of critical damping of a motion of the frequency
---@field frequency number Hz, > 0: of the block on its contact, of a wall, or of what else is to be damped

--- Stops all bodies whenever the kinetic energy of the model has been at its peak; the fastest way to an equilibrium of many blocks.
---@class (exact) talus.damping.Kinetic

--- Opposes motion by a share of the unbalanced force; for statics.
---@class (exact) talus.damping.Local
---@field alpha? number in [0, 1), default 0.8: share of the unbalanced force that opposes motion

--- No damping.
---@class (exact) talus.damping.None

--- A fraction of critical damping at two frequencies, by mass and by the stiffness of contacts.
---@class (exact) talus.damping.Rayleigh
---@field ratio number in [0, 1]: fraction of critical damping at both frequencies
---@field from number Hz, > 0: the lower frequency
---@field to number Hz, > 0: the higher frequency

--- Constant viscous damping of all velocities.
---@class (exact) talus.damping.Viscous
---@field alpha number 1/s, >= 0: damping coefficient

--- Creates the blocks of a block model in JSON.
---@class (exact) talus.generator.Blocks
---@field file string block model in JSON

--- Creates one block, an axis-aligned box.
---@class (exact) talus.generator.Box
---@field min talus.Vector m: lowest corner
---@field max talus.Vector m: highest corner
---@field density number kg/m3, > 0: density of the block
---@field group? string default "rock": group of the block

--- Cuts the visible blocks by a network of discs, drawn or of a file.
---@class (exact) talus.generator.Dfn
---@field joint string name of the joint set
---@field p32? number 1/m, > 0: intensity: area of discs in a volume, m2/m3; or give number, or file
---@field number? integer in [0, 1e+06], default 0: number of discs in the bounds grown by the largest radius; 0: by p32
---@field dip? number deg, in [0, 90]: mean dip below horizontal
---@field dip_direction? number deg, in [0, 360]: mean dip direction, clockwise from north (+y)
---@field fisher_k? number in (0, 1e+09]: concentration of the poles about the mean; all parallel without it
---@field poles? string table of measured planes with the columns dip and dip_direction, in the place of dip and dip_direction
---@field size? "power_law"|"lognormal"|"fixed" default "fixed": distribution of the radius
---@field exponent? number > 0: a of power_law: the density of radii is proportional to r^-(1 + a)
---@field size_mean? number m, > 0: mean radius of lognormal; the radius of fixed
---@field size_dev? number m, > 0: standard deviation of the radius of lognormal
---@field size_min? number m, > 0: smallest radius of power_law and lognormal
---@field size_max? number m, > 0: largest radius of power_law and lognormal
---@field file? string discs in the place of drawn ones: a table with x, y, z, dip, dip_direction, radius; or .fab of FracMan

--- Creates one block: a cylinder of flat sides.
---@class (exact) talus.generator.Drum
---@field center? talus.Vector m, default {0, 0, 0}: middle of the drum
---@field axis? talus.Vector default {0, 0, 1}: direction of its axis, of any length
---@field radius number m, > 0: from the axis to the corners
---@field height number m, > 0: along the axis
---@field sides? integer in [3, 1000], default 12: number of flat sides
---@field density number kg/m3, > 0: density of the block
---@field group? string default "rock": group of the block

--- Cuts the visible blocks in the path of a convex polygon.
---@class (exact) talus.generator.Fracture
---@field joint string name of the joint set the fracture belongs to
---@field vertices talus.Vector[] m: corners of a convex polygon in one plane, in order around it
---@field persistence? number in [0, 1], default 1: probability that a block in the fracture's path is cut

--- Creates blocks of the closed solids in a file: OBJ, STL, PLY, VTK, JSON of compas, or faces of 3DEC.
---@class (exact) talus.generator.Import
---@field file string file of solids: .obj, .stl, .ply, .vtk, .json or a data file of 3DEC
---@field scale? number > 0, default 1: factor on coordinates: 0.001 for millimetres
---@field translate? talus.Vector m, default {0, 0, 0}: added to the scaled coordinates
---@field weld? number m, >= 0: vertices of an object that are nearer are one; by the digits of the file and the sizes of objects unless given
---@field flat? number m, >= 0: corners of a face may be so far off its plane; by the digits of the file and the sizes of objects unless given
---@field split? boolean default true: divide solids that are not convex into joined convex blocks, or refuse them
---@field skip? boolean default false: leave out objects that are refused, and report them, or refuse the file
---@field density number kg/m3, > 0: density of the blocks
---@field group? string default "": group of the blocks; "": as the file names them, "rock" where it does not

--- Cuts the visible blocks by one plane.
---@class (exact) talus.generator.Joint
---@field joint string name of the joint set the plane belongs to
---@field dip number deg, in [0, 90]: dip below horizontal
---@field dip_direction number deg, in [0, 360]: dip direction, clockwise from north (+y)
---@field origin? talus.Vector m, default {0, 0, 0}: point on the plane
---@field persistence? number in [0, 1], default 1: probability that a block in the plane's path is cut
---@field radius? number m, > 0: of a disc about the origin in the place of the plane: a block is in its path when the disc meets its section

--- Cuts the visible blocks by a set of nearly parallel planes.
---@class (exact) talus.generator.Jointset
---@field joint string name of the joint set
---@field dip? number deg, in [0, 90]: mean dip below horizontal
---@field dip_dev? number deg, in [0, 90], default 0: deviation of the dip: largest, or standard when normal
---@field dip_direction? number deg, in [0, 360]: mean dip direction, clockwise from north (+y)
---@field dip_direction_dev? number deg, in [0, 180], default 0: deviation of the dip direction
---@field spacing number m, > 0: mean distance between planes
---@field spacing_dev? number m, >= 0, default 0: deviation of the spacing; less than the spacing, unless lognormal
---@field number? integer in [1, 10000], default 1: number of planes
---@field origin? talus.Vector m, default {0, 0, 0}: point the planes lie symmetrically about
---@field persistence? number in [0, 1], default 1: probability that a block in a plane's path is cut
---@field distribution? "uniform"|"normal"|"fisher" default "uniform": of the deviations: uniform within them, normal with them as standard deviations, or fisher about the mean pole
---@field fisher_k? number in (0, 1e+09]: concentration of the poles by fisher
---@field radius? number m, > 0: of discs in the place of planes: a block is in a disc's path when the disc meets its section
---@field spacing_distribution? "same"|"uniform"|"normal"|"exponential"|"lognormal" default "same": of the gaps: uniform within spacing_dev, normal, exponential with the mean spacing, or lognormal; same: as distribution, uniform with fisher
---@field poles? string table of measured planes with the columns dip and dip_direction, in the place of dip and dip_direction

--- Creates one convex block from its vertices.
---@class (exact) talus.generator.Polyhedron
---@field vertices talus.Vector[] m: corners of the block, in any order
---@field density number kg/m3, > 0: density of the block
---@field group? string default "rock": group of the block

--- Creates one body between two polygons.
---@class (exact) talus.generator.Prism
---@field base talus.Vector[] m: corners of a polygon, in order; with top a convex one
---@field top? talus.Vector[] m: corners of the other end, as many; or give axis
---@field axis? talus.Vector m: from the base to the other end; or give top
---@field density number kg/m3, > 0: density of the block
---@field group? string default "rock": group of the block

--- Creates one body of a section in a plane, moved across it: a slope, a dam, a wall.
---@class (exact) talus.generator.Profile
---@field section? number[][] corners of the section, in order, two numbers each
---@field points? number[][] corners of the section, in order, two numbers each (another name)
---@field plane? "xz"|"yz"|"xy"|"zx"|"zy"|"yx" default "xz": plane of the section: its letters say what the two numbers of a corner are
---@field from? number m, default 0: where the section begins on the axis across its plane
---@field to number m: where it ends there, > from
---@field density number kg/m3, > 0: density of the block
---@field group? string default "rock": group of the block

--- Divides the visible blocks by the ground, a grid or triangles of a file.
---@class (exact) talus.generator.Terrain
---@field file string heights of the ground: ESRI ASCII grid (.asc), or STL (.stl)
---@field scale? number > 0, default 1: factor on coordinates and heights: 0.001 for millimetres
---@field translate? talus.Vector m, default {0, 0, 0}: added to the scaled coordinates
---@field group? string default "air": group of what lies above the ground
---@field every? integer in [1, 1e+06], default 1: takes every n-th row and column of a grid, and the last

--- Creates one block from its four corners.
---@class (exact) talus.generator.Tetrahedron
---@field vertices talus.Vector[] m: the four corners, in any order
---@field density number kg/m3, > 0: density of the block
---@field group? string default "rock": group of the block

--- Cuts the visible blocks in the way of a tunnel along its surface.
---@class (exact) talus.generator.Tunnel
---@field face1? talus.Vector[] m: corners of one end, in order around it
---@field face2? talus.Vector[] m: corners of the other end, in the order of those of face1 they are connected with
---@field profile? number[][] instead of faces, with path: corners of the section in order, {to the right of the way, up}, from the path
---@field path? talus.Vector[] m: points that straight legs connect; closed where the last is the first
---@field group? string default "tunnel": group of what lies inside

--- Creates a slope with the wedge that two joints part from it.
---@class (exact) talus.generator.Wedge
---@field joint_a? string default "A": name of the joint A
---@field dip_a number deg, in [0, 90]: its dip below horizontal
---@field dip_direction_a number deg, in [0, 360]: its dip direction, clockwise from north (+y)
---@field joint_b? string default "B": name of the joint B
---@field dip_b number deg, in [0, 90]: its dip below horizontal
---@field dip_direction_b number deg, in [0, 360]: its dip direction, clockwise from north (+y)
---@field slope_dip number deg, in [0, 90]: dip of the slope face
---@field slope_dip_direction number deg, in [0, 360]: dip direction of the slope face
---@field upper_dip? number deg, in [0, 90], default 0: dip of the upper slope
---@field upper_dip_direction? number deg, in [0, 360]: dip direction of the upper slope; that of the face
---@field height number m, > 0: of the crest over the toe of the wedge, up the slope from it
---@field origin? talus.Vector m, default {0, 0, 0}: the toe: where the joints' line of intersection daylights
---@field margin? number m, > 0: rock beside, behind and below the wedge; half its height
---@field density number kg/m3, > 0: density of wedge and rock
---@field group? string default "wedge": group of the wedge
---@field rock_group? string default "rock": group of the rock

--- Creates the rock over a tunnel's roof with the wedge that three joints part from it.
---@class (exact) talus.generator.RoofWedge
---@field joint_a? string default "A": name of the joint A
---@field dip_a number deg, in [0, 90]: its dip below horizontal
---@field dip_direction_a number deg, in [0, 360]: its dip direction, clockwise from north (+y)
---@field joint_b? string default "B": name of the joint B
---@field dip_b number deg, in [0, 90]: its dip below horizontal
---@field dip_direction_b number deg, in [0, 360]: its dip direction, clockwise from north (+y)
---@field joint_c? string default "C": name of the joint C
---@field dip_c number deg, in [0, 90]: its dip below horizontal
---@field dip_direction_c number deg, in [0, 360]: its dip direction, clockwise from north (+y)
---@field trend? number deg, in [0, 360], default 0: of the tunnel's axis, clockwise from north (+y)
---@field span number m, > 0: width of the tunnel's flat roof, across its axis
---@field height? number m, > 0: of the apex over the roof; the largest that fits the span
---@field origin? talus.Vector m, default {0, 0, 0}: on the roof: the wedge's middle, along and across the tunnel
---@field margin? number m, > 0: rock beside, behind and below the wedge; half its height
---@field density number kg/m3, > 0: density of wedge and rock
---@field group? string default "wedge": group of the wedge
---@field rock_group? string default "rock": group of the rock

--- Creates a block of each convex region of a mesh of tetrahedra.
---@class (exact) talus.generator.Zones
---@field file string mesh of tetrahedra, legacy VTK or gmsh 2.2
---@field density number kg/m3, > 0: density of the blocks
---@field group? string default "rock": group of blocks whose regions have no name in the file

--- Serves the page to browsers on this machine, at 127.0.0.1.
---@class (exact) talus.screen.Browser
---@field port? integer in [0, 65535], default 0: port of 127.0.0.1; 0: any that is free, which the address tells

--- Drucker-Prager's cone with a cut-off of the mean stress.
---@class (exact) talus.solid.DruckerPrager
---@field young? number Pa, > 0: Young's modulus; with poisson
---@field poisson? number in (-1, 0.5): Poisson's ratio; with young
---@field nu? number in (-1, 0.5): Poisson's ratio; with young (another name)
---@field bulk? number Pa, > 0: bulk modulus; with shear, in the place of young and poisson
---@field shear? number Pa, > 0: shear modulus; with bulk
---@field cohesion number Pa, >= 0: cohesion
---@field friction number deg, in [0, 90): angle of friction
---@field dilation? number deg, in [0, 90), default 0: angle of dilation, at most that of friction
---@field tension? number Pa, >= 0: largest mean stress; no more than that of the apex, which it is when left out
---@field meridian? "outer"|"inner" default "outer": where cone and Mohr-Coulomb meet: in compression (outer) or extension (inner)

--- Isotropic and elastic.
---@class (exact) talus.solid.Elastic
---@field young? number Pa, > 0: Young's modulus; with poisson
---@field poisson? number in (-1, 0.5): Poisson's ratio; with young
---@field nu? number in (-1, 0.5): Poisson's ratio; with young (another name)
---@field bulk? number Pa, > 0: bulk modulus; with shear, in the place of young and poisson
---@field shear? number Pa, > 0: shear modulus; with bulk

--- Generalized Hoek-Brown criterion of 2002 with a tension cut-off.
---@class (exact) talus.solid.HoekBrown
---@field young? number Pa, > 0: Young's modulus; with poisson
---@field poisson? number in (-1, 0.5): Poisson's ratio; with young
---@field nu? number in (-1, 0.5): Poisson's ratio; with young (another name)
---@field bulk? number Pa, > 0: bulk modulus; with shear, in the place of young and poisson
---@field shear? number Pa, > 0: shear modulus; with bulk
---@field sigma_ci number Pa, > 0: uniaxial strength of the intact rock
---@field mb? number > 0: constant of the rock mass; with s, or gsi and mi in their place
---@field s? number in [0, 1]: constant of the rock mass, 1 of intact rock
---@field a? number in [0.5, 1]: exponent; with mb and s
---@field gsi? number in [0, 100]: geological strength index; with mi
---@field mi? number > 0: constant of the intact rock; with gsi
---@field disturbance? number in [0, 1]: factor D of blasting and relief; with gsi
---@field dilation? number deg, in [0, 90), default 0: angle of dilation, at most that of friction at the stress
---@field tension? number Pa, >= 0: tensile strength; no more than s sigma_ci / mb, which it is when left out

--- Mohr-Coulomb with a tension cut-off, and strength over plastic strain.
---@class (exact) talus.solid.MohrCoulomb
---@field young? number Pa, > 0: Young's modulus; with poisson
---@field poisson? number in (-1, 0.5): Poisson's ratio; with young
---@field nu? number in (-1, 0.5): Poisson's ratio; with young (another name)
---@field bulk? number Pa, > 0: bulk modulus; with shear, in the place of young and poisson
---@field shear? number Pa, > 0: shear modulus; with bulk
---@field cohesion? number Pa, >= 0: cohesion, where no table gives it
---@field friction? number deg, in [0, 90): angle of friction, where no table gives it
---@field dilation? number deg, in [0, 90), default 0: angle of dilation, at most that of friction
---@field tension? number Pa, >= 0: tensile strength; no more than cohesion / tan(friction), which it is when left out
---@field cohesion_table? number[][] cohesion over plastic shear: rows {plastic shear, cohesion}, straight between them
---@field friction_table? number[][] friction over plastic shear
---@field dilation_table? number[][] dilation over plastic shear
---@field tension_table? number[][] tensile strength over plastic tension
---@field table_extent? number m, > 0: extent of zones that the tables are for: in zones twice as large plastic strain counts twice, so that a crack takes the same energy; left out: tables hold for zones of any size

--- Elastic and layered: alike in all directions of a plane.
---@class (exact) talus.solid.Transverse
---@field young_plane number Pa, > 0: Young's modulus along the layers
---@field young_across number Pa, > 0: Young's modulus across the layers
---@field poisson_plane number in (-1, 1): Poisson's ratio within the layers
---@field poisson_across number in (-1, 1): strain along the layers by that across them, under a stress across them
---@field shear_across number Pa, > 0: shear modulus of shear along the layers
---@field dip? number deg, in [0, 90], default 0: dip of the layers at the beginning
---@field dip_direction? number deg, in [0, 360], default 0: dip direction of the layers at the beginning

--- Mohr-Coulomb with a weak plane of one attitude everywhere, as of schistosity.
---@class (exact) talus.solid.Ubiquitous
---@field young? number Pa, > 0: Young's modulus; with poisson
---@field poisson? number in (-1, 0.5): Poisson's ratio; with young
---@field nu? number in (-1, 0.5): Poisson's ratio; with young (another name)
---@field bulk? number Pa, > 0: bulk modulus; with shear, in the place of young and poisson
---@field shear? number Pa, > 0: shear modulus; with bulk
---@field cohesion? number Pa, >= 0: cohesion, where no table gives it
---@field friction? number deg, in [0, 90): angle of friction, where no table gives it
---@field dilation? number deg, in [0, 90), default 0: angle of dilation, at most that of friction
---@field tension? number Pa, >= 0: tensile strength; no more than cohesion / tan(friction), which it is when left out
---@field cohesion_table? number[][] cohesion over plastic shear: rows {plastic shear, cohesion}, straight between them
---@field friction_table? number[][] friction over plastic shear
---@field dilation_table? number[][] dilation over plastic shear
---@field tension_table? number[][] tensile strength over plastic tension
---@field table_extent? number m, > 0: extent of zones that the tables are for: in zones twice as large plastic strain counts twice, so that a crack takes the same energy; left out: tables hold for zones of any size
---@field joint_cohesion? number Pa, >= 0, default 0: cohesion of the weak plane
---@field joint_friction number deg, in [0, 90): angle of friction of the weak plane
---@field joint_dilation? number deg, in [0, 90), default 0: angle of dilation of the weak plane, at most that of its friction
---@field joint_tension? number Pa, >= 0: tensile strength of the weak plane; no more than its cohesion / tan(friction), which it is when left out
---@field dip? number deg, in [0, 90], default 0: dip of the weak plane at the beginning
---@field dip_direction? number deg, in [0, 360], default 0: dip direction of the weak plane at the beginning

--- A grouted steel bar with a plate, across joints.
---@class (exact) talus.element.Bolt
---@field from talus.Vector m: The mouth, where the plate is.
---@field to talus.Vector m: The far end.
---@field diameter? number m, in (0, 1e+09], default 0.025: Of the steel.
---@field young? number Pa, in (0, 1e+14], default 2e+11: Young's modulus of the steel.
---@field yield? number N, in (0, 1e+12], default 240000: Tension and compression at which the steel yields.
---@field rupture_strain? number in [0.0001, 1e+06], default 0.1: Strain at which the steel breaks.
---@field grout_stiffness? number N/m2, in (0, 1e+14], default 1000000000: Of the grout in shear, for each metre.
---@field grout_strength? number N/m, in [0, 1e+12], default 400000: Bond of the grout for each metre.
---@field grout_residual? number N/m, in [0, 1e+12]: What is left of the bond where it has slipped; without it, all.
---@field grout_friction? number deg, in [0, 90), default 0: Of the bond under the confining pressure.
---@field confining? number Pa, in [0, 1e+12], default 0: Pressure on the bar, for the friction of the bond.
---@field grouted_from? number in [0, 1], default 0: Part of the length where the grout begins.
---@field grouted_to? number in [0, 1], default 1: Part of the length where the grout ends.
---@field plate_stiffness? number N/m, in [0, 1e+14], default 50000000: Of the plate at the mouth; 0: there is none.
---@field plate_strength? number N, in [0, 1e+12], default 200000: Force at which the plate yields.
---@field pretension? number N, in [0, 1e+12], default 0: Pull at the mouth against the plate when installed.
---@field dowel_stiffness? number N/m, in [0, 1e+14], default 0: Of the dowel at each joint, across the bolt.
---@field dowel_strength? number N, in [0, 1e+12], default 0: Force that the dowel bears at most.
---@field dowel_rupture? number m, in (0, 1e+09], default 0.05: Displacement across the bolt that cuts the dowel.
---@field active_length? number m, in (0, 1e+09]: Length that turns where a joint shears; without it, two diameters.
---@field spacing? number m, in (0, 1e+09], default 0.1: Of the nodes, at most.

--- A bolt that is grouted at its far end only.
---@class (exact) talus.element.Anchor
---@field from talus.Vector m: The mouth, where the plate is.
---@field to talus.Vector m: The far end.
---@field diameter? number m, in (0, 1e+09], default 0.025: Of the steel.
---@field young? number Pa, in (0, 1e+14], default 2e+11: Young's modulus of the steel.
---@field yield? number N, in (0, 1e+12], default 240000: Tension and compression at which the steel yields.
---@field rupture_strain? number in [0.0001, 1e+06], default 0.1: Strain at which the steel breaks.
---@field grout_stiffness? number N/m2, in (0, 1e+14], default 1000000000: Of the grout in shear, for each metre.
---@field grout_strength? number N/m, in [0, 1e+12], default 400000: Bond of the grout for each metre.
---@field grout_residual? number N/m, in [0, 1e+12]: What is left of the bond where it has slipped; without it, all.
---@field grout_friction? number deg, in [0, 90), default 0: Of the bond under the confining pressure.
---@field confining? number Pa, in [0, 1e+12], default 0: Pressure on the bar, for the friction of the bond.
---@field grouted_from? number in [0, 1], default 0.8: Part of the length where the grout begins.
---@field grouted_to? number in [0, 1], default 1: Part of the length where the grout ends.
---@field plate_stiffness? number N/m, in [0, 1e+14], default 50000000: Of the plate at the mouth; 0: there is none.
---@field plate_strength? number N, in [0, 1e+12], default 200000: Force at which the plate yields.
---@field pretension? number N, in [0, 1e+12], default 0: Pull at the mouth against the plate when installed.
---@field dowel_stiffness? number N/m, in [0, 1e+14], default 0: Of the dowel at each joint, across the bolt.
---@field dowel_strength? number N, in [0, 1e+12], default 0: Force that the dowel bears at most.
---@field dowel_rupture? number m, in (0, 1e+09], default 0.05: Displacement across the bolt that cuts the dowel.
---@field active_length? number m, in (0, 1e+09]: Length that turns where a joint shears; without it, two diameters.
---@field spacing? number m, in (0, 1e+09], default 0.1: Of the nodes, at most.

--- Shotcrete on outer faces of blocks: a shell that a bond holds.
---@class (exact) talus.element.Liner
---@field facing? talus.Vector default {0, 0, 0}: Outer faces that look this way are lined; without it, all.
---@field within? number deg, in [0, 180], default 45: So far their normals may be from that.
---@field rock? string Group of the blocks that are lined; without it, all.
---@field faces? talus.Vector[] m: Points, one on each face that is lined; without it, all of those.
---@field thickness number m, in (0, 10]: Of the liner.
---@field young? number Pa, in [100000, 1e+13], default 2e+10: Young's modulus of the liner.
---@field poisson? number in [0, 0.5), default 0.2: Poisson's ratio of the liner.
---@field tension? number Pa, in [0, 1e+12], default 2000000: Tensile strength of the liner.
---@field bond_stiffness? number Pa/m, in [1000, 1e+15], default 1e+10: Of the bond, across it.
---@field bond_shear_stiffness? number Pa/m, in [1000, 1e+15]: Along it; without it, the same.
---@field bond_strength? number Pa, in [0, 1e+12], default 500000: Tension at which the bond fails.
---@field bond_shear_strength? number Pa, in [0, 1e+12]: Shear at which it fails; without it, the same.
---@field spacing? number m, in [0.0001, 1e+06]: Length of the sides of triangles, at most; without it, that over which the bond bears.

--- Outer faces of rigid blocks that let waves out: model:boundary.
---@class (exact) talus.element.Quiet
---@field faces string Numbers: block, face (from 0), area (m2), height (m) and density (kg/m3), of one face after the other.
---@field kn? number Pa/m, in (0, 1e+50]: Normal stiffness of the joints.
---@field ks? number Pa/m, in (0, 1e+50]: Shear stiffness of the joints.
---@field p_velocity? number m/s, in (0, 1e+50]: In the place of kn: of pressure waves in what was cut off.
---@field s_velocity? number m/s, in (0, 1e+50]: In the place of ks: of shear waves in what was cut off.
---@field input_x? string Incoming wave along x, numbers: time of its begin (s), time between samples (s), then displacement (m) and velocity (m/s) of each sample.
---@field input_y? string Incoming wave along y, likewise.
---@field input_z? string Incoming wave along z, likewise.

--- Vertical sides of rigid blocks that move as the ground far away: model:boundary.
---@class (exact) talus.element.FreeField
---@field faces string Numbers: block, face (from 0), area (m2), width (m), density (kg/m3) and held components (1 x, 2 y, 4 z, 8 rotation), of one face after the other.
---@field kn? number Pa/m, in (0, 1e+50]: Normal stiffness of the joints of the column.
---@field ks? number Pa/m, in (0, 1e+50]: Shear stiffness likewise.
---@field p_velocity? number m/s, in (0, 1e+50]: In the place of kn: of pressure waves in the column.
---@field s_velocity? number m/s, in (0, 1e+50]: In the place of ks: of shear waves.
---@field base_kn? number Pa/m, in (0, 1e+50]: Of a quiet base: as kn, of what was cut off below. Without it the lowest level is held.
---@field base_ks? number Pa/m, in (0, 1e+50]: Likewise, as ks.
---@field base_p_velocity? number m/s, in (0, 1e+50]: Likewise, as p_velocity.
---@field base_s_velocity? number m/s, in (0, 1e+50]: Likewise, as s_velocity.
---@field base_density? number kg/m3, in (0, 1e+50]: Likewise, density; that of the lowest level when left out.
---@field input_x? string Wave along x that comes in through a quiet base, numbers as of the kind quiet.
---@field input_y? string Likewise along y.
---@field input_z? string Likewise along z.
---@field alpha? number 1/s, in [0, 1e+50], default 0: Damping of the levels by their mass.
---@field beta? number s, in [0, 1e+50], default 0: Damping of the levels by their stiffness.

--- Waves that come in through quiet faces of deformable blocks: model:boundary.
---@class (exact) talus.element.Incoming
---@field nodes string Numbers: block, face (from 0), place (m), outward normal, area (m2) and impedances of pressure and shear waves (Pa s/m), of one gridpoint after the other.
---@field input_x? string Incoming wave along x, numbers as of the kind quiet.
---@field input_y? string Likewise along y.
---@field input_z? string Likewise along z.

--- A spring and a dashpot between two points, of blocks or of the ground.
---@class (exact) talus.element.Spring
---@field from talus.Vector m: One end: on the block that it lies in, or on the ground.
---@field to talus.Vector m: The other end.
---@field stiffness number N/m, in (0, 1e+50]: Stiffness.
---@field damping? number N s/m, in [0, 1e+50], default 0: Of the dashpot beside it.
---@field pretension? number N, in [-1e+50, 1e+50], default 0: Tension when installed; below 0 it presses.
---@field strength? number N, in [0, 1e+50]: Force at which the spring yields; without it, it never does.

--- Water that presses on the walls of joints: model:water.
---@class (exact) talus.element.Water
---@field source "table"|"uniform"|"field"|"none" "uniform", "field", "none": Where the pressure comes from.
---@field level? number m: Of a level table: its height z.
---@field dip? number deg, in [0, 90): Of a table that dips.
---@field dip_direction? number deg, in [-360, 360]: Of a table that dips.
---@field origin? talus.Vector m: A point of a table that dips.
---@field unit_weight? number N/m3, in (0, 1e+50], default 9810: Of the water under a table.
---@field factor? number in [0, 1e+06], default 1: Of the pressure under a table: the part that is not drained.
---@field pressure? number Pa, in [0, 1e+50]: Uniform pressure.
---@field drain_gap? number m, in (0, 1e+50], default 0.05: Mean opening beyond which a joint is dry.
---@field joints? string default "*": Joints, sets or planes of them, separated by commas.

--- Water that flows in joints: model:water("flow").
---@class (exact) talus.element.Flow
---@field aperture number m, in (0, 1]: Hydraulic aperture of walls that just touch.
---@field residual? number m, in (0, 1], default 2e-05: Least aperture, of a joint that is pressed.
---@field maximum? number m, in (0, 1], default 0.002: Largest aperture that counts.
---@field viscosity? number Pa s, in (0, 1e+50], default 0.001: Of the water.
---@field unit_weight? number N/m3, in (0, 1e+50], default 9810: Of the water.
---@field bulk? number Pa, in (0, 1e+50], default 2000000000: Bulk modulus of the water, where flow is not steady.
---@field initial_head? number m: Head at the beginning where flow is not steady; without it the pressure begins at 0.
---@field drain_gap? number m, in (0, 1e+50], default 0.05: Mean opening beyond which a joint is dry.
---@field apertures? string Other apertures, of joints, sets or planes: "A=1e-4,B:2=3e-4", m; the last that fits counts.
---@field joints? string default "*": Joints, sets or planes of them, separated by commas.
---@field heads? talus.Vector[] m: Three points a head: least and largest corner of a box, and {head, 0, 0}.
---@field drains? talus.Vector[] m: Three points a drain: both ends, and {radius, 0, 0}.
---@field every? integer in [0, 1e+09], default 0: Steps between two solutions; 0: 100 of steady flow, 1 of stored water. With n of stored water the time step is n times shorter where walls move.
---@field steady? boolean default true: Whether water is in balance, or also stored.

---@class (exact) talus.Model
---@field gravity talus.Vector acceleration of gravity {x, y, z}, m/s2; may be assigned
---@field rotation string "exact" or "paper"; may be assigned
---@field contact_points string "consistent" or "corners" (not of faces that meet another at less than 20 degrees); may be assigned
---@field reuse_geometry boolean true or false; may be assigned
---@field time number simulated time, s, and steps so far
---@field cycles integer simulated time, s, and steps so far
---@field mass_scaled boolean whether mass scaling is on
---@field dt number the step the next cycle will use, s
---@field threads integer as given when it was made
---@field seed integer as given when it was made
local Model = {}

---@class (exact) talus.Block
---@field id integer number of the block, never used again
---@field group string name of its group
---@field density number kg/m3: mass per volume
---@field volume number m3: volume of the block alone
---@field mass number kg: mass of the block alone
---@field inertia talus.Tensor kg m2: inertia of the block about its centroid, in the axes of the model
---@field centroid talus.Vector m: present place of the centroid
---@field displacement talus.Vector m: of the centroid, since creation or reset_displacement
---@field rotation number[] unit quaternion w, x, y, z of its body
---@field velocity talus.Vector m/s: of the centroid, half a step ago; of a deformable block the mean of its body
---@field angular_velocity talus.Vector rad/s: of its body; 0 of a deformable one
---@field force talus.Vector N: unbalanced force on its body
---@field moment talus.Vector N m: unbalanced moment about its body's centroid
---@field fixed boolean whether its body, or all its gridpoints, are held in every component
---@field held integer components of its body that are held: 1 x, 2 y, 4 z, 8 rotation, added up
---@field hidden boolean hidden blocks are not cut
---@field body integer id of its rigid body: the lowest id of its blocks
---@field speed number m/s: length of the velocity
---@field kinetic_energy number J: of the block alone; of a deformable body the share by its mass
---@field deformable boolean whether it has zones
---@field zones integer of its body
---@field gridpoints integer of its body
---@field stress talus.Tensor Pa: mean over its zones, by volume; nan of a rigid block
---@field strain talus.Tensor mean logarithmic strain of these zones; nan of a rigid block
---@field vertices talus.Vector[] vertices in their present place
---@field faces { vertices: integer[], normal: talus.Vector, joint: string? }[] faces: vertex numbers from 1, outward normal, name of the joint plane or nil
---@field neighbours talus.Block[] blocks it is in contact with
local Block = {}

--- A selection of blocks: a snapshot, in ascending order of id.
---@class (exact) talus.Blocks
---@field [integer] talus.Block
---@operator len: integer
local Blocks = {}

--- sum of a field of numbers; of a vector field a vector
---@param field string
---@return number|talus.Vector
function Blocks:sum(field) end

--- largest and smallest value of a field of numbers
---@param field string
---@return number
function Blocks:max(field) end

--- largest and smallest value of a field of numbers
---@param field string
---@return number
function Blocks:min(field) end

--- list of the field's values, in the order of the selection: much faster than one by one. A vector is {x, y, z}; with "flat" after the field {x, y, z, x, y, z, ...}
---@param field string
---@return any
function Blocks:values(field) end

--- {min = {x, y, z}, max = {x, y, z}} over all vertices
---@return { min: talus.Vector, max: talus.Vector }
function Blocks:bounds() end

--- those for which the function answers true
---@param keep fun(item: talus.Block): any
---@return talus.Blocks
function Blocks:where(keep) end

--- hidden blocks are not cut and not selected unless asked for
---@return talus.Blocks
function Blocks:hide() end

--- hidden blocks are not cut and not selected unless asked for
---@return talus.Blocks
function Blocks:show() end

--- removes the blocks
---@return talus.Blocks
function Blocks:delete() end

--- makes one rigid body of the blocks and of what they were joined to; makes each a body of its own. Momentum and angular momentum are kept
---@return talus.Blocks
function Blocks:join() end

--- makes one rigid body of the blocks and of what they were joined to; makes each a body of its own. Momentum and angular momentum are kept
---@return talus.Blocks
function Blocks:unjoin() end

--- lets fixed and driven blocks go
---@return talus.Blocks
function Blocks:free() end

--- sum of the forces that hold their bodies, N: {x, y, z}, of held components only
---@return talus.Blocks
function Blocks:reaction() end

--- displacements count from now
---@return talus.Blocks
function Blocks:reset_displacement() end

---@class (exact) talus.Contact
---@field id integer number of the pair of its blocks: that of the older times 2^32, plus the other's
---@field born integer steps made when it began: by this and its blocks a contact is known
---@field blocks talus.Block[] its two blocks, the older first
---@field joint string joint and plane ("J1:3"), or empty
---@field area number m2: of the common polygon of two faces, or of the surface of pressure
---@field normal talus.Vector unit normal from the first block to the second
---@field point talus.Vector m: centroid of the polygon, or centre of pressure
---@field gap number m: smallest gap, negative when overlapping
---@field normal_force number N: compression positive
---@field shear_force talus.Vector N: on the second block
---@field normal_stress number Pa: normal force over area
---@field shear_stress number Pa: length of shear force over area
---@field shear_displacement talus.Vector m: of the second block against the first at the point, along the contact: difference of their displacements
---@field state string "elastic", "slipping", "open" or "failed"
---@field law string name of its law, or empty
---@field law_number integer place of its law in model:laws(), or 0
---@field points { position: talus.Vector, area: number, normal_force: number }[] its points as they are now, each a table of the fields of a contact point and of the states of the law by name. The forces of the points add up to those of the contact; edges, vertices and tilted faces have one point
---@field states table<string, number|string|boolean|talus.Vector> the states of its law: the mean of the points, weighted by their areas; the sum of a state that goes with the area
---@field pressure number Pa, mean pressure of the water between its faces; nil, and NaN in lists, where it is dry
---@field aperture number m, hydraulic aperture of the joint between its faces; nil without water that flows there
---@field flow number m3/s, through the joint between its faces; likewise
local Contact = {}

--- A selection of contacts: a snapshot, in ascending order of their blocks.
---@class (exact) talus.Contacts
---@field [integer] talus.Contact
---@operator len: integer
local Contacts = {}

--- sum of a field of numbers, or of a state of a law by its name; of a vector a vector
---@param field string
---@return number|talus.Vector
function Contacts:sum(field) end

--- largest and smallest value of a field of numbers, or of a state, where the law has it
---@param field string
---@return number
function Contacts:max(field) end

--- largest and smallest value of a field of numbers, or of a state, where the law has it
---@param field string
---@return number
function Contacts:min(field) end

--- list of the field's values, in the order of the selection; likewise a state of a law, by its name, NaN where the contact's law has no such state. With "flat" after it vectors are not lists of their own
---@param field string
---@return any
function Contacts:values(field) end

--- those for which the function answers true
---@param keep fun(item: talus.Contact): any
---@return talus.Contacts
function Contacts:where(keep) end

---@class (exact) talus.Zone
---@field id integer of its own among all zones: 4294967296 times the first block of its body, and its number
---@field block integer block that it is of: as a block in Lua, as its id in values
---@field number integer its number in the block, or in the body of several joined blocks, from 0
---@field group string group of the block
---@field solid string name of its solid
---@field centroid talus.Vector m: present place of its centroid
---@field volume number m3: present volume
---@field stress talus.Tensor Pa: Cauchy stress, tension positive
---@field strain talus.Tensor logarithmic strain since it was made
---@field principal talus.Vector Pa: principal stresses, the largest first
---@field mean number Pa: mean stress
---@field deviator number Pa: sqrt(3 J2): of a uniaxial stress its size
---@field state string "elastic", "shear", "tension" or "joint" now, or "shear past" ...
---@field plastic boolean whether it has ever yielded
local Zone = {}

--- A selection of zones: a snapshot, in ascending order of id.
---@class (exact) talus.Zones
---@field [integer] talus.Zone
---@operator len: integer
local Zones = {}

--- sum of a field of numbers, or of a state of a solid; of a vector a vector
---@param field string
---@return number|talus.Vector
function Zones:sum(field) end

--- largest and smallest value of a field of numbers, of a component, as "stress.zz" (of "principal" x is the largest, z the least), or of a state
---@param field string
---@return number
function Zones:max(field) end

--- largest and smallest value of a field of numbers, of a component, as "stress.zz" (of "principal" x is the largest, z the least), or of a state
---@param field string
---@return number
function Zones:min(field) end

--- list of the field's values, in the order of the selection; likewise a state of a solid, by its name, NaN where the zone's solid has no such state. With "flat" after it vectors and tensors are not lists of their own
---@param field string
---@return any
function Zones:values(field) end

--- those for which the function answers true
---@param keep fun(item: talus.Zone): any
---@return talus.Zones
function Zones:where(keep) end

---@class (exact) talus.Gridpoint
---@field id integer of its own among all gridpoints: 4294967296 times the first block of its body, and its number
---@field block integer block that it is of, or the first of its body: as a block in Lua, as its id in values
---@field number integer its number in the block, or in the body of several joined blocks, from 0
---@field group string group of the block
---@field position talus.Vector m: present place
---@field displacement talus.Vector m: since it was made
---@field velocity talus.Vector m/s: half a step ago
---@field force talus.Vector N: unbalanced
---@field mass number kg: a quarter of that of each of its zones
---@field fixed integer components that are held: 1 x, 2 y, 4 z, added up
---@field surface boolean whether it is on the surface of its body
local Gridpoint = {}

--- A selection of gridpoints: a snapshot, in ascending order of id.
---@class (exact) talus.Gridpoints
---@field [integer] talus.Gridpoint
---@operator len: integer
local Gridpoints = {}

--- sum, largest and smallest value of a field of numbers, or of a component, as "displacement.z"
---@param field string
---@return number|talus.Vector
function Gridpoints:sum(field) end

--- sum, largest and smallest value of a field of numbers, or of a component, as "displacement.z"
---@param field string
---@return number
function Gridpoints:max(field) end

--- sum, largest and smallest value of a field of numbers, or of a component, as "displacement.z"
---@param field string
---@return number
function Gridpoints:min(field) end

--- list of the field's values, in the order of the selection; "flat" as of blocks
---@param field string
---@return any
function Gridpoints:values(field) end

--- those for which the function answers true
---@param keep fun(item: talus.Gridpoint): any
---@return talus.Gridpoints
function Gridpoints:where(keep) end

--- lets components go; all when none is named
---@param options any
---@return talus.Gridpoints
function Gridpoints:free(options) end

--- sum of the forces that hold their held components, N: {x, y, z}
---@return talus.Gridpoints
function Gridpoints:reaction() end

---@class (exact) talus.Element
---@field id integer id
---@field kind string name of its kind
---@field group string name that was given with the call that placed it
---@field node_count integer number of its nodes
---@field yielded boolean whether it has ever yielded
---@field broken boolean whether it has broken
---@field detached boolean whether a block of its nodes has been deleted
---@field stored number J: energy that it holds
---@field lost number J: energy turned to heat in the last step
---@field given number J: energy brought in from outside in the last step
---@field nodes table[] list of its nodes, each a table: rest, where it was when installed, position now, m; force on its block, N; weight, m or m2 that it stands for; block, nil on the ground; and the states of a node by their names
---@field params table<string, number|string|boolean|talus.Vector> its parameters, by their names
local Element = {}

--- A selection of elements: a snapshot, in ascending order of id.
---@class (exact) talus.Elements
---@field [integer] talus.Element
---@operator len: integer
local Elements = {}

--- sum, largest and smallest value of a field of numbers, or of a state of whole elements
---@param field string
---@return number|talus.Vector
function Elements:sum(field) end

--- sum, largest and smallest value of a field of numbers, or of a state of whole elements
---@param field string
---@return number
function Elements:max(field) end

--- sum, largest and smallest value of a field of numbers, or of a state of whole elements
---@param field string
---@return number
function Elements:min(field) end

--- list of the field's values, in the order of the selection; likewise a state of whole elements, NaN where the element's kind has no such state
---@param field string
---@return any
function Elements:values(field) end

--- those for which the function answers true
---@param keep fun(item: talus.Element): any
---@return talus.Elements
function Elements:where(keep) end

--- takes them away; what they hold counts as work by hand
---@return talus.Elements
function Elements:delete() end

---@class (exact) talus.ModelOptions
---@field gravity? talus.Vector m/s2, default {0, 0, -9.81}: acceleration of gravity
---@field seed? integer >= 0, default 1: seed of every random draw: the same seed gives the same model
---@field threads? integer in [1, 256], default 1: number of threads; results do not depend on it
---@field rotation? "exact"|"paper" default "exact": how blocks turn: Euler's equations, or the paper's single moment of inertia
---@field reuse_geometry? boolean default true: whether a field contact that hardly moved goes by slopes of its force
---@field contact_points? "consistent"|"corners" default "consistent": where the points of a face-face contact lie: also inside, which integrates the pressure of elastic faces exactly, or at the corners only, up to a tilt of 5 degrees: springs as those of rigid statics, and of rigid blocks of 3DEC; docs/how_stiff.md compares both

--- Makes an empty model.
---
---     model = talus.model{gravity = {0, 0, -9.81}, ...}
---@param options? talus.ModelOptions
---@return talus.Model
function talus.model(options) end

---@class (exact) talus.GenerateResult
---@field before integer number of blocks before and after
---@field after integer number of blocks before and after
---@field cuts integer cuts made, refused because a side would be too thin, and fallen on an existing face
---@field refused integer cuts made, refused because a side would be too thin, and fallen on an existing face
---@field coincident integer cuts made, refused because a side would be too thin, and fallen on an existing face
---@field smallest_volume number of the model after, m3, m and m2
---@field smallest_edge number of the model after, m3, m and m2
---@field smallest_face number of the model after, m3, m and m2
---@field volume_error number relative change of the volume that is not accounted for
---@field slivers integer blocks that this call made with an aspect over 50, or with less than 0.001 of the mean volume of a block; model:filter{auto = true} joins those that decide the time step
---@field report table where a file was read: what holds of it all by name, and a list of {name =, ...} of the objects to which something was done, or that were refused

--- Creates or cuts blocks; acts on visible blocks only, wholly or not at all. A list of tables, {{...}, {...}}, in the place of one: once for each, in their order and in one go. What an earlier entry makes and a later one cuts gets no ids, so ids are not those of a call for each entry.
---
---     summary = model:generate("GENERATOR", {...})
---@param generator string
---@param options? table
---@return talus.GenerateResult
---@overload fun(self: talus.Model, generator: "blocks", options: talus.generator.Blocks|talus.generator.Blocks[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "box", options: talus.generator.Box|talus.generator.Box[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "dfn", options: talus.generator.Dfn|talus.generator.Dfn[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "drum", options: talus.generator.Drum|talus.generator.Drum[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "fracture", options: talus.generator.Fracture|talus.generator.Fracture[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "import", options: talus.generator.Import|talus.generator.Import[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "joint", options: talus.generator.Joint|talus.generator.Joint[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "jointset", options: talus.generator.Jointset|talus.generator.Jointset[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "polyhedron", options: talus.generator.Polyhedron|talus.generator.Polyhedron[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "prism", options: talus.generator.Prism|talus.generator.Prism[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "profile", options: talus.generator.Profile|talus.generator.Profile[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "terrain", options: talus.generator.Terrain|talus.generator.Terrain[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "tetrahedron", options: talus.generator.Tetrahedron|talus.generator.Tetrahedron[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "tunnel", options?: talus.generator.Tunnel|talus.generator.Tunnel[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "wedge", options: talus.generator.Wedge|talus.generator.Wedge[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "roof_wedge", options: talus.generator.RoofWedge|talus.generator.RoofWedge[]): talus.GenerateResult
---@overload fun(self: talus.Model, generator: "zones", options: talus.generator.Zones|talus.generator.Zones[]): talus.GenerateResult
function Model:generate(generator, options) end

--- Sets the law of a joint set ("J1"), of one of its planes ("J1:3") or of every joint not named otherwise ("*"). A table, or a selection of blocks or contacts, in the place of the name: of contacts between groups or selections. Without a law's name it changes properties. The law that names more wins: first by how many of the two blocks it names, then by how closely it names the joint (plane, set, *), then the one named later.
---
---     model:joint("J1", "LAW", {...})  or  model:joint("J1", {friction = 30})
---@param joint string|table|talus.Blocks|talus.Contacts
---@param law string
---@param options? table
---@overload fun(self: talus.Model, joint: string|table|talus.Blocks|talus.Contacts, law: "barton_bandis", options: talus.law.BartonBandis)
---@overload fun(self: talus.Model, joint: string|table|talus.Blocks|talus.Contacts, law: "cohesive", options: talus.law.Cohesive)
---@overload fun(self: talus.Model, joint: string|table|talus.Blocks|talus.Contacts, law: "continuously_yielding", options: talus.law.ContinuouslyYielding)
---@overload fun(self: talus.Model, joint: string|table|talus.Blocks|talus.Contacts, law: "coulomb", options: talus.law.Coulomb)
---@overload fun(self: talus.Model, joint: string|table|talus.Blocks|talus.Contacts, law: "coulomb_tensile", options: talus.law.CoulombTensile)
---@overload fun(self: talus.Model, joint: string|table|talus.Blocks|talus.Contacts, law: "elastic", options: talus.law.Elastic)
---@overload fun(self: talus.Model, joint: string|table|talus.Blocks|talus.Contacts, law: "rate_state", options: talus.law.RateState)
---@overload fun(self: talus.Model, joint: string|table|talus.Blocks|talus.Contacts, law: "slip_weakening", options: talus.law.SlipWeakening)
---@overload fun(self: talus.Model, joint: string|table|talus.Blocks|talus.Contacts, options?: table)
function Model:joint(joint, law, options) end

---@class (exact) talus.InsituOptions
---@field at? talus.Vector m, default {0, 0, 0}: point at whose height the stress holds; the gradient counts from there
---@field stress? talus.Tensor stress at the height of `at`, Pa, tension positive; components left out are 0. yx, zy and xz are the same as xy, yz and zx
---@field gradient? talus.Tensor change of the stress with height z, Pa/m; components left out are 0
---@field blocks? talus.Blocks puts the stress in their zones, and on their contacts with any; all without it

--- Puts an initial stress in the zones, and on the face contacts, that exist now, once.
---
---     model:insitu{stress = {zz = -1e6}, gradient = {zz = 2e4}, at = {0, 0, 0}}
---@param options? talus.InsituOptions
function Model:insitu(options) end

--- Chooses how motion is damped; "none" is no damping, and the default.
---
---     model:damping("DAMPING", {...})
---@param damping string
---@param options? table
---@overload fun(self: talus.Model, damping: "adaptive", options?: talus.damping.Adaptive)
---@overload fun(self: talus.Model, damping: "combined", options?: talus.damping.Combined)
---@overload fun(self: talus.Model, damping: "dashpot", options: talus.damping.Dashpot)
---@overload fun(self: talus.Model, damping: "kinetic", options?: talus.damping.Kinetic)
---@overload fun(self: talus.Model, damping: "local", options?: talus.damping.Local)
---@overload fun(self: talus.Model, damping: "none", options?: talus.damping.None)
---@overload fun(self: talus.Model, damping: "rayleigh", options: talus.damping.Rayleigh)
---@overload fun(self: talus.Model, damping: "viscous", options: talus.damping.Viscous)
function Model:damping(damping, options) end

---@class (exact) talus.TimestepOptions
---@field fraction? number in [1e-09, 2]: share of the critical step that is used, FRAC of (27); when left out 0.5, by the rule paper 0.1, by the rule balance 1
---@field rule? "paper"|"body"|"balance" default "body": critical step from the lightest block and the stiffest contact (paper), or from each body's own mass and stiffness (body). balance is for collapses: the critical step of body, and field contacts in motion by slopes of their force, both as far as the energy balance allows; with dt the slopes only
---@field dt? number s, in [1e-100, 1e+100]: a fixed time step instead of the rule
---@field error? number in [0, 1], default 0.0001: rule balance: up to half of this error of the energy balance the step is the longest; from there to all of it it falls to half of that, and the slopes are used for contacts at rest only
---@field zone_fraction? number in [1e-09, 1], default 1: of deformable blocks: share of the step up to which zones are stable, whatever their motion

---@class (exact) talus.TimestepResult
---@field dt number the step the next cycle will use, s; 0 where nothing can move and no law is set
---@field block talus.Block? the block that controls it, or nil
---@field partner talus.Block? the block at the stiffest contact, or nil
---@field gridpoint integer? the number of the gridpoint in its block where zones control it, or nil
---@field mass number of the block's body or that gridpoint, kg; of what holds the gridpoint, or of the contact, of all its contacts or of the part of its largest face that counts, N/m
---@field stiffness number of the block's body or that gridpoint, kg; of what holds the gridpoint, or of the contact, of all its contacts or of the part of its largest face that counts, N/m
---@field message string the same in a sentence

--- Chooses how the time step is found.
---
---     model:timestep{fraction = 0.3}  or  report = model:timestep()
---@param options? talus.TimestepOptions
---@return talus.TimestepResult
---@overload fun(self: talus.Model): talus.TimestepResult
function Model:timestep(options) end

---@class (exact) talus.MassScalingOptions
---@field on? boolean default true: whether the inertia is scaled
---@field dt? number s, in [1e-100, 1e+100]: for motion that is to be right: the step. Only bodies in contact whose own stable step is shorter get inertia, as much as they need for it
---@field most? number >= 0: with dt: mass that may be added, as a share of the mass of all bodies that can move; a step that would need more fails. Left out, 0.05

---@class (exact) talus.MassScalingResult
---@field on boolean whether inertia is scaled; the other fields are there after mass_scaling{dt =} only
---@field dt number the step, s, and the largest share, as given
---@field most number the step, s, and the largest share, as given
---@field added number mass that the last step has added, as a share of that of the bodies that can move
---@field bodies integer how many have got some; a deformable body by some gridpoint
---@field gridpoints integer how many have got some; a deformable body by some gridpoint
---@field worst { block: integer, factor: number }? {block =, factor =}: the number of the block with the highest factor, and its inertia over its own; of a deformable one {block =, gridpoint =, factor =}, and the mass of the gridpoint; nil when none has got any

--- Scales the inertia, not the weight, of free bodies up to that of the one with the longest stable step, for finding equilibria: times and velocities then mean nothing. With dt it is for dynamics: inertia is added to the few bodies that need it. Without arguments it tells what the last step has added.
---
---     model:mass_scaling(true)  or  model:mass_scaling{dt = 1e-4}  or  added = model:mass_scaling()
---@param on? boolean whether the inertia is scaled
---@return talus.MassScalingResult
---@overload fun(self: talus.Model, options?: talus.MassScalingOptions): talus.MassScalingResult
---@overload fun(self: talus.Model): talus.MassScalingResult
function Model:mass_scaling(on) end

---@class (exact) talus.ContactAreaOptions
---@field fraction? number in [0, 1], default 0: minimum area of field contacts, as a share of the smaller block's mean face area; with 0 they have no more than their own
---@field absolute? number m2, >= 0: minimum area in square metres instead of the share
---@field joint? string the joint ("J1") or plane ("J1:3") it applies to; every joint when left out

--- Sets the minimum area of field contacts: those of edges, vertices and tilted faces. None by default.
---
---     model:contact_area{fraction = 0.01}
---@param options? talus.ContactAreaOptions
function Model:contact_area(options) end

---@class (exact) talus.EnergyResult
---@field kinetic number of motion, J
---@field potential number minus the work of gravity, J
---@field stored number elastic, in all contacts, those of held blocks, too, J
---@field friction number turned to heat by slip, J
---@field damping number taken out by the damping, J
---@field external number work of loads and driven bodies, and given by setting velocities and by edits of blocks and laws, J
---@field balance number error of the sum over the largest change of a term so far
---@field strain number elastic, in all zones of deformable blocks, J
---@field plastic number turned to heat in zones, by yielding, J
---@field elements number held by elements, part of stored, J
---@field element_loss number turned to heat by elements until now, part of friction, J

--- The energy of the bodies that are free to move, at the last force evaluation, counted from the first step. After model:relax stored, potential and friction keep their meaning; damping and external also hold what its own inertia and stops have taken and given, so balance goes on from what it was.
---
---     energy = model:energy()
---@return talus.EnergyResult
function Model:energy() end

--- A digest of all that what comes next depends on, settings too: models with the same text go on alike, to the last bit. Takes about as long as a step.
---
---     text = model:state_hash()
---@return string
function Model:state_hash() end

---@class (exact) talus.BlocksOptions
---@field group? string blocks of this group
---@field containing? talus.Vector m: blocks that contain this point
---@field region? talus.Vector[] m: blocks whose centroid is in the convex hull of these points
---@field joint? string blocks with a face on this joint or plane
---@field boundary? string blocks with an outer face on this side of the model: "xmin", "xmax" ... "zmax"
---@field fixed? boolean blocks held in every component, of deformable ones all gridpoints, or the others
---@field id? integer|integer[] the blocks of these ids
---@field inside? { min: talus.Vector, max: talus.Vector } blocks whose centroid is in this box
---@field above? { dip: number, dip_direction: number, origin: talus.Vector } blocks whose centroid is above this plane, or above all planes of a list
---@field below? { dip: number, dip_direction: number, origin: talus.Vector } blocks whose centroid is below this plane, or below all planes of a list
---@field hidden? boolean|"any" hidden blocks, visible ones (the default), or both
---@field where? fun(block: talus.Block): any blocks for which the function answers true

--- Selects blocks, visible ones unless asked otherwise; all conditions must hold.
---
---     selection = model:blocks{...}
---@param options? talus.BlocksOptions
---@return talus.Blocks
function Model:blocks(options) end

---@class (exact) talus.FixOptions
---@field x? boolean default false: hold the motion along x
---@field y? boolean default false: hold the motion along y
---@field z? boolean default false: hold the motion along z
---@field rotation? boolean default false: hold the rotation

--- Holds components of the motion of the blocks' bodies, besides what is held already; all of it when nothing is named.
---
---     selection:fix{x = true, rotation = true}  or  selection:fix()
---@param options? talus.FixOptions
---@return talus.Blocks
---@overload fun(self: talus.Blocks): talus.Blocks
function Blocks:fix(options) end

---@class (exact) talus.SetOptions
---@field density? number kg/m3, > 0: density
---@field group? string name of the group
---@field velocity? talus.Vector m/s: velocity of the centroid; of several blocks of a body, that of their common one
---@field angular_velocity? talus.Vector rad/s: angular velocity
---@field solid? string of deformable blocks: the solid of all their zones, by its name; stress stays, and states of the same names

--- Changes properties of blocks; what is not named stays.
---
---     selection:set{group = "wedge", velocity = {0, 0, -1}}
---@param options? talus.SetOptions
---@return talus.Blocks
function Blocks:set(options) end

---@class (exact) talus.LoadOptions
---@field force? talus.Vector N, default {0, 0, 0}: force on the body of each block
---@field moment? talus.Vector N m, default {0, 0, 0}: moment on the body of each block
---@field at? talus.Vector m: point where the force acts, which goes with the body; its centroid when left out

--- Puts a force and a moment, along the axes of the model, on the bodies of blocks, in the place of what they had; none at all takes the load off.
---
---     selection:load{force = {0, 0, -1e3}, at = {x, y, z}}
---@param options? talus.LoadOptions
---@return talus.Blocks
function Blocks:load(options) end

---@class (exact) talus.DriveOptions
---@field velocity? talus.Vector|(fun(t: number): number|talus.Vector, number?, number?) velocity of the centroid, m/s; the function gives {x, y, z} or three numbers for a time t, s: the middle of each step. x, y or z may be a talus.record, whose time counts from the call. Zero when left out
---@field angular_velocity? talus.Vector|(fun(t: number): number|talus.Vector, number?, number?) angular velocity, rad/s, likewise

--- Prescribes the motion of the blocks' bodies, in the place of any fixing, until selection:free(). A function is called in the middle of a step: it may read the model, but not change it. A body that is driven to turn is not cut in two.
---
---     selection:drive{velocity = function(t) return 0.1 * math.sin(t), 0, 0 end}
---@param options? talus.DriveOptions
---@return talus.Blocks
function Blocks:drive(options) end

---@class (exact) talus.ContactsOptions
---@field joint? string contacts on this joint or plane
---@field between? (talus.Blocks|talus.Block)[] contacts of a block of the first with one of the second; a single block serves too
---@field where? fun(contact: talus.Contact): any contacts for which the function answers true

--- Selects contacts; all conditions must hold.
---
---     selection = model:contacts{...}
---@param options? talus.ContactsOptions
---@return talus.Contacts
function Model:contacts(options) end

--- Names a solid, the material of zones: a kind of solid with its properties. Without a kind it changes properties of one that has been named. Zones keep their stress, and the states that the new kind has by the same names.
---
---     model:solid("granite", "SOLID", {...})  or  model:solid("granite", {young = 2e9})
---@param name string
---@param solid string
---@param options? table
---@overload fun(self: talus.Model, name: string, solid: "drucker_prager", options: talus.solid.DruckerPrager)
---@overload fun(self: talus.Model, name: string, solid: "elastic", options?: talus.solid.Elastic)
---@overload fun(self: talus.Model, name: string, solid: "hoek_brown", options: talus.solid.HoekBrown)
---@overload fun(self: talus.Model, name: string, solid: "mohr_coulomb", options?: talus.solid.MohrCoulomb)
---@overload fun(self: talus.Model, name: string, solid: "transverse", options: talus.solid.Transverse)
---@overload fun(self: talus.Model, name: string, solid: "ubiquitous", options: talus.solid.Ubiquitous)
---@overload fun(self: talus.Model, name: string, options?: table)
function Model:solid(name, solid, options) end

---@class (exact) talus.DeformableOptions
---@field solid string name of the solid that the zones are made of: model:solid
---@field file? string or a mesh whose tetrahedra fill the blocks: legacy VTK, or gmsh 2.2 as text
---@field zone? number|fun(place: talus.Vector): number wanted edge of zones, m, > 0, the same everywhere or at a place; required without a file. Larger than a block: zones between its corners and its centroid

---@class (exact) talus.DeformableResult
---@field blocks integer how many have been made
---@field zones integer how many have been made
---@field gridpoints integer how many have been made
---@field clusters integer how many have been made
---@field smallest_altitude number of a zone over its largest side, m
---@field altitude_ratio number smallest altitude over the wanted edge; of a file over the mean edge of the zone (rms)
---@field worst_block talus.Block the block that has it
---@field time_step number step that the gridpoints would allow if nothing touched them, s
---@field inertia number largest ratio of the inertia of a block's gridpoints to that of the block: about 1 + 2/n^2 of n zones to an edge. Blocks that topple or rock in time want 8 zones to an edge, or stay rigid
---@field memory integer that the model has grown by, bytes

--- Divides blocks into zones: tetrahedra of constant strain, whose corners are gridpoints. They are free of stress where the blocks are, and move as the blocks did. Joined blocks come all at once: they share gridpoints, so zones go on over the faces between them. With {file = "rock.msh", solid = "granite"} the tetrahedra of a mesh that was made elsewhere become the zones of the blocks in which they lie. They must fill these within 1e-6 of their size. Nothing is done where one block cannot be divided.
---
---     report = selection:deformable{zone = 1.0, solid = "granite"}
---@param options talus.DeformableOptions
---@return talus.Blocks
function Blocks:deformable(options) end

---@class (exact) talus.ZonesOptions
---@field group? string zones of blocks of this group
---@field solid? string zones of this solid
---@field near? talus.Vector m: the one zone whose centroid is nearest to this point
---@field containing? talus.Vector m: zones that have this point inside or on a side
---@field plastic? boolean zones that have ever yielded, or that never have
---@field id? integer|integer[] the zones of these ids
---@field block? talus.Block|integer zones of this block
---@field blocks? talus.Blocks zones of these blocks, hidden ones too
---@field inside? { min: talus.Vector, max: talus.Vector } zones in this box, by their centroids or places
---@field where? fun(zone: talus.Zone): any zones for which the function answers true

--- Selects zones of deformable blocks, of visible ones unless asked otherwise; all conditions must hold. Beside its fields a zone has the states of its solid by their names, as zone.plastic_shear.
---
---     selection = model:zones{...}
---@param options? talus.ZonesOptions
---@return talus.Zones
function Model:zones(options) end

---@class (exact) talus.GridpointsOptions
---@field group? string gridpoints of blocks of this group
---@field near? talus.Vector m: the one gridpoint that is nearest to this point
---@field surface? boolean gridpoints on the surface of their body, or inside
---@field fixed? boolean gridpoints held in some component, or in none
---@field id? integer|integer[] the gridpoints of these ids
---@field block? talus.Block|integer gridpoints of this block
---@field blocks? talus.Blocks gridpoints of these blocks, hidden ones too
---@field inside? { min: talus.Vector, max: talus.Vector } gridpoints in this box, by their centroids or places
---@field where? fun(gridpoint: talus.Gridpoint): any gridpoints for which the function answers true

--- Selects gridpoints, the corners of zones; all conditions must hold.
---
---     selection = model:gridpoints{...}
---@param options? talus.GridpointsOptions
---@return talus.Gridpoints
function Model:gridpoints(options) end

---@class (exact) talus.JointSet
---@field name string of the joint set; number of its planes so far
---@field planes integer of the joint set; number of its planes so far
---@field law string? name of the law of the set as a whole; nil while it has none
---@field scoped table[]? of the list itself: laws as of model:laws(), those that name groups or selections; nil without any

--- Lists the joint sets, in the order they were made.
---
---     list = model:joints()
---@return talus.JointSet[]
function Model:joints() end

---@class (exact) talus.Law
---@field joint string "*", "J1" or "J1:3", and the name of the law that was set for it
---@field law string "*", "J1" or "J1:3", and the name of the law that was set for it
---@field between (string|talus.Blocks)[]? two groups or selections of blocks, of a law for contacts between both
---@field group string? name of the group, of a law for contacts with at least one block of it
---@field blocks talus.Blocks? the selection of blocks, of a law for contacts with at least one of them
---@field contacts integer? the number of the pairs of blocks, of a law for contacts between these
---@field parameters { cohesion: number, dilation: number, friction: number, kn: number, ks: number }? {NAME = value}, as they are now; one that may be left out and was is nil

--- Lists the laws that were set by model:joint, with their parameters.
---
---     list = model:laws()
---@return talus.Law[]
function Model:laws() end

---@class (exact) talus.Solid
---@field name string of the solid, and of the kind that it is of
---@field kind string of the solid, and of the kind that it is of
---@field parameters { poisson: number, young: number } {NAME = value}, as they are now; of a table its rows
---@field zones integer number of its zones in visible blocks, and their volume, m3
---@field volume number number of its zones in visible blocks, and their volume, m3

--- Lists the solids that were named by model:solid, in their order. talus.solids() lists the kinds that are loaded.
---
---     list = model:solids()
---@return talus.Solid[]
function Model:solids() end

---@class (exact) talus.Group
---@field name string of the group
---@field blocks integer number of its blocks, hidden ones, too, and their volume, m3
---@field volume number number of its blocks, hidden ones, too, and their volume, m3

--- Lists the groups that blocks have.
---
---     list = model:groups()
---@return talus.Group[]
function Model:groups() end

---@class (exact) talus.Kind
---@field name string its name, what it does, the plugin it is of
---@field doc string its name, what it does, the plugin it is of
---@field plugin string its name, what it does, the plugin it is of
---@field parameters string[] list of the names of its parameters
---@field states string[] list of the names of its states

--- Lists the laws, dampings, generators, screens, solids or elements that are loaded.
---
---     list = talus.laws()  or  list = talus.dampings()  or  list = talus.generators()  or  list = talus.screens()  or  list = talus.solids()  or  list = talus.elements()
---@return talus.Kind[]
function talus.laws() end

--- Lists the laws, dampings, generators, screens, solids or elements that are loaded.
---
---     list = talus.laws()  or  list = talus.dampings()  or  list = talus.generators()  or  list = talus.screens()  or  list = talus.solids()  or  list = talus.elements()
---@return talus.Kind[]
function talus.dampings() end

--- Lists the laws, dampings, generators, screens, solids or elements that are loaded.
---
---     list = talus.laws()  or  list = talus.dampings()  or  list = talus.generators()  or  list = talus.screens()  or  list = talus.solids()  or  list = talus.elements()
---@return talus.Kind[]
function talus.generators() end

--- Lists the laws, dampings, generators, screens, solids or elements that are loaded.
---
---     list = talus.laws()  or  list = talus.dampings()  or  list = talus.generators()  or  list = talus.screens()  or  list = talus.solids()  or  list = talus.elements()
---@return talus.Kind[]
function talus.screens() end

--- Lists the laws, dampings, generators, screens, solids or elements that are loaded.
---
---     list = talus.laws()  or  list = talus.dampings()  or  list = talus.generators()  or  list = talus.screens()  or  list = talus.solids()  or  list = talus.elements()
---@return talus.Kind[]
function talus.solids() end

--- Lists the laws, dampings, generators, screens, solids or elements that are loaded.
---
---     list = talus.laws()  or  list = talus.dampings()  or  list = talus.generators()  or  list = talus.screens()  or  list = talus.solids()  or  list = talus.elements()
---@return talus.Kind[]
function talus.elements() end

---@class (exact) talus.ParametersResult
---@field gravity talus.Vector and all others that talus.model{...} takes
---@field seed integer and all others that talus.model{...} takes
---@field timestep { dt: number, fraction: number, rule: string }? rule and fraction; given: the step that was given, s, or nil; dt: the step the next cycle will use, s, or message: why it is not known
---@field mass_scaling { on: boolean } on; dt and most, where they were given
---@field damping { name: string, parameters: { alpha: number } }? name, nil where none was chosen; parameters: a table of them by name
---@field laws { *: { law: string, parameters: { cohesion: number, dilation: number, friction: number, kn: number, ks: number } }, J1: { law: string, parameters: { cohesion: number, dilation: number, friction: number, kn: number, ks: number } } } by joint ("*", "J1", "J1:3"), or "contacts of group 'stone' (law 2)": law, its name; parameters: a table of them by name
---@field joints { J1: string } by joint set: the joint whose law it has, "" for none
---@field contact_area { *: { fraction: number } } by joint, "*" for all others: fraction, or absolute, m2
---@field solids { granite: { kind: string, parameters: { poisson: number, young: number } } } by name: kind, its name; parameters: a table of them by name

--- Tells all parameters the model has now, with defaults and units, as a table, and prints them (not with --quiet).
---
---     table = model:parameters()
---@return talus.ParametersResult
function Model:parameters() end

---@class (exact) talus.LawTestOptions
---@field law string name of the law
---@field normal_stress? number Pa: normal stress, compression positive, which is held by closing and opening; when left out the closure is given, and begins at 0
---@field stiffness? number Pa/m, >= 0: normal stiffness of the surroundings: normal_stress is that of the start, and rises by so much a metre of dilation
---@field speed? number m/s, > 0, default 1e-05: speed of shear, or of closing where nothing is sheared
---@field steps? integer in [1, 1e+07], default 200: steps of each leg of the path
---@field every? integer in [1, 1e+07], default 1: steps from one point of the curve to the next; the end of a leg is always one
---@field params? table<string, number|string|boolean|talus.Vector> parameters of the law, as for model:joint
---@field path? (number|{ shear: number?, closure: number?, normal_stress: number?, time: number?, speed: number?, steps: integer? })[] shear displacements, m, one after the other from 0; or legs, tables {shear = m, closure = m, normal_stress = Pa, time = s, speed = m/s, steps =}: values at the end of the leg, what is not named stays; a leg with only a time waits

---@class (exact) talus.LawTestResult
---@field time number[] lists: seconds, and shear displacement, m; the first point is the start
---@field shear number[] lists: seconds, and shear displacement, m; the first point is the start
---@field shear_stress number[] lists, Pa, compression positive
---@field normal_stress number[] lists, Pa, compression positive
---@field closure number[] lists, m: how far the walls have approached, and how far they have parted since the start
---@field dilation number[] lists, m: how far the walls have approached, and how far they have parted since the start
---@field work number[] list, J/m2: work of the walls, and what was stored at the start
---@field stored number[] lists, J/m2: elastic energy, and energy turned to heat, as the law tells them. Work - stored - heat is the error of the law's energies and of the steps
---@field heat number[] lists, J/m2: elastic energy, and energy turned to heat, as the law tells them. Work - stored - heat is the error of the law's energies and of the steps
---@field slipping boolean[] lists of true and false, as the law flags the point
---@field open boolean[] lists of true and false, as the law flags the point
---@field failed boolean[] lists of true and false, as the law flags the point
---@field states { opening: number[] } a list for each state of the law, by its name; of vectors where it is one
---@field ends integer[] for each leg, the place of its last point in the lists

--- Tries a joint law on one contact point, without a model: direct shear under a constant normal stress, or in surroundings of constant normal stiffness, and closure tests.
---
---     curve = talus.law_test{law = "coulomb", params = {kn = 1e10, ks = 1e9, friction = 30}, normal_stress = 1e6, path = {0.005, -0.005}}
---@param options talus.LawTestOptions
---@return talus.LawTestResult
function talus.law_test(options) end

---@class (exact) talus.SolidTestOptions
---@field solid string name of the solid
---@field extent? number m, > 0, default 1: extent of the zone, the cube root of its volume, which solids may ask for
---@field steps? integer in [1, 1e+07], default 100: steps of each leg of the path
---@field every? integer in [1, 1e+07], default 1: steps from one point of the curve to the next; the end of a leg is always one
---@field params? table<string, number|string|boolean|talus.Vector> parameters of the solid, as for model:solid
---@field path? { strain: table<string, number>?, stress: table<string, number>?, steps: integer? }[] tables {strain = {zz = -0.01}, stress = {xx = -1e6, yy = -1e6}, steps =}: components that are driven to strains, and those that are held at stresses, at the end of the leg. A component that is not named keeps its stress
---@field stress? talus.Tensor stress at the start, Pa; 0 where it is left out

---@class (exact) talus.SolidTestResult
---@field stress { xx: number[], xy: number[], yy: number[], yz: number[], zx: number[], zz: number[] } tables of lists by component, curve.stress.zz[i], Pa; tension positive, shear strains those of the tensor; the first point is the start
---@field strain { xx: number[], xy: number[], yy: number[], yz: number[], zx: number[], zz: number[] } tables of lists by component, curve.stress.zz[i], Pa; tension positive, shear strains those of the tensor; the first point is the start
---@field work number[] list, J/m3: work of the stresses, and what was stored at the start
---@field stored number[] lists, J/m3: elastic energy, and energy turned to heat, as the solid tells them. Work - stored - dissipated is the error of the solid's energies and of the steps
---@field dissipated number[] lists, J/m3: elastic energy, and energy turned to heat, as the solid tells them. Work - stored - dissipated is the error of the solid's energies and of the steps
---@field shear boolean[] lists of true and false: how the zone yields in the step
---@field tension boolean[] lists of true and false: how the zone yields in the step
---@field joint boolean[] lists of true and false: how the zone yields in the step
---@field states table a list for each state of the solid, by its name; of lists where it is an axis or a tensor
---@field ends integer[] for each leg, the place of its last point in the lists

--- Tries a solid on one zone, without a model: any path of strains that are driven and stresses that are held.
---
---     curve = talus.solid_test{solid = "elastic", params = {young = 1e10, poisson = 0.25}, path = {{stress = {xx = -1e6, yy = -1e6}, strain = {zz = -0.01}}}}
---@param options talus.SolidTestOptions
---@return talus.SolidTestResult
function talus.solid_test(options) end

---@class (exact) talus.BoundaryOptions
---@field side? string faces in this plane of the box about all blocks: "xmin", "xmax", "ymin", "ymax", "zmin" or "zmax"
---@field facing? talus.Vector faces that look so: their normal is within an angle of this vector
---@field within? number deg, in [0, 180], default 45: this angle
---@field tolerance? number m, >= 0: how far off the plane, or out of the box, a corner may be; 1e-3 of the block's size when left out
---@field fixed? boolean default false: holds the bodies in all components
---@field roller? boolean default false: holds the bodies across their faces; those of rigid blocks must look along x, y or z
---@field rotation? boolean default false: with roller: holds the rotation of rigid blocks, too
---@field quiet? boolean default false: lets waves out, by dashpots (Lysmer and Kuhlemeyer 1969), of rigid blocks behind springs, and bears what it bore
---@field free_field? boolean default false: a vertical side of rigid blocks in level rows moves as the ground far away: as a column of such levels, whose base is that of the call or is held
---@field joint? string of quiet rigid blocks and free fields: the joint whose law has the stiffness kn and ks of what was cut off; "*" when left out
---@field p_velocity? number m/s, in (0, 1e+50]: in the place of joint: velocity of pressure waves in what was cut off
---@field s_velocity? number m/s, in (0, 1e+50]: likewise of shear waves
---@field density? number kg/m3, in (0, 1e+50]: of what was cut off at quiet rigid blocks and free fields; that of the blocks when left out
---@field pressure? number Pa: pressure on the faces, inward
---@field water_level? number m: height z of still water before the faces: it presses on what lies below
---@field unit_weight? number N/m3, in (0, 1e+50], default 9810: of this water
---@field traction? talus.Vector Pa: force per area on the faces
---@field at? talus.Vector m, default {0, 0, 0}: point at whose height stress holds; the gradient counts from there
---@field add? boolean default false: adds to the loads that the bodies have, in the place of taking it
---@field plane? { normal: talus.Vector, at: talus.Vector } faces in this plane that look along its normal
---@field box? { min: talus.Vector, max: talus.Vector } faces with all corners in this box
---@field stress? talus.Tensor stress, Pa, tension positive: the traction on a face is stress times its outward normal
---@field gradient? talus.Tensor change of the stress with height z, Pa/m
---@field velocity? talus.Vector|(fun(t: number): number|talus.Vector, number?, number?) prescribes the velocity of the faces, m/s; rigid bodies move with it whole
---@field input? talus.Vector of quiet faces: velocity of a wave that comes in, by the traction 2 rho c v (Joyner and Chen 1975)
---@field xmin? "roller"|"fixed"|"free_field"|talus.BoundaryOptions several sides in one call
---@field xmax? "roller"|"fixed"|"free_field"|talus.BoundaryOptions several sides in one call
---@field ymin? "roller"|"fixed"|talus.BoundaryOptions likewise
---@field ymax? "roller"|"fixed"|talus.BoundaryOptions likewise
---@field zmin? "roller"|"fixed"|talus.BoundaryOptions likewise
---@field zmax? "roller"|"fixed"|talus.BoundaryOptions likewise

---@class (exact) talus.BoundaryResult
---@field area number of the outer faces, or their outer parts, m2; without any the call is refused
---@field blocks talus.Blocks a selection of their blocks, hidden ones, too
---@field faces { area: number, block: talus.Block, centroid: talus.Vector, face: integer, normal: talus.Vector }[] each a table {block =, face =, area =, normal =, centroid =}; block.faces[face] is the face
---@field force talus.Vector of the load in all, N, and N m about {0, 0, 0}
---@field moment talus.Vector of the load in all, N, and N m about {0, 0, 0}
---@field reaction talus.Vector now: the force that holds the bodies in their held components, N
---@field xmin talus.BoundaryResult? where sides are given: these fields of each, in the place of those above
---@field xmax talus.BoundaryResult? where sides are given: these fields of each, in the place of those above
---@field ymin talus.BoundaryResult? where sides are given: these fields of each, likewise
---@field ymax talus.BoundaryResult? where sides are given: these fields of each, likewise
---@field zmin talus.BoundaryResult? where sides are given: these fields of each, likewise
---@field zmax talus.BoundaryResult? where sides are given: these fields of each, likewise

--- Finds outer faces of the model: those, or parts of those, that lie on no other block. Holds their bodies, or puts a traction on them as a load: its force and moment about each body's centroid take the place of the load the body had, keep their direction and go with the body. What one call puts on a body adds up. When a face is cut, each part of it gets its share. Of deformable blocks the triangles of faces that are meant bear the traction, as they are in each step, or hold their gridpoints; what is done to a triangle takes the place of all that was done to it before, or with add is added. Quiet faces of rigid blocks are elements of the kind quiet: model:elements{kind = "quiet"}; those of a free field are of the kind free_field. A body that was held is let go, and bears on as a load what held it: across the face, or in all components if it was held in all.
---
---     result = model:boundary{side = "xmax", stress = {xx = -1e6}}  or  model:boundary{xmin = "roller", zmin = "fixed", zmax = {pressure = 1e5}}
---@param options? talus.BoundaryOptions
---@return talus.BoundaryResult
---@overload fun(self: talus.Model, options?: talus.BoundaryOptions): talus.BoundaryResult
function Model:boundary(options) end

---@class (exact) talus.CycleOptions
---@field cycles integer >= 0: number of steps to run
---@field every? integer >= 1, default 500: steps between calls of on_progress
---@field on_progress? fun(model: talus.Model, result: talus.SolveResult) called every `every` steps

---@class (exact) talus.CycleResult
---@field reason string why it ended: "ratio", "velocity", "failure", "overlap" (blocks that were made overlapping push it apart), "cycles", "time", "stop" or "interrupt" (Ctrl-C at the prompt; in a script it raises an error)
---@field ratio number mean unbalanced force over mean contact force
---@field ratio_maximum number largest unbalanced force over mean contact force
---@field ratio_local number largest unbalanced force of a block over its own contact forces, or its weight and load where these are more
---@field measure string the measure that may end the run
---@field worst talus.Block? the block farthest from rest by the measure "local": nil when there is none that can move, or no force on any
---@field failing talus.Block? a block that fails steadily: it moves on in one direction without slowing down, and the force that pushes it stays; nil when none does
---@field cycles integer steps of this call
---@field time number the model's time at the end, s
---@field wall number seconds it took
---@field max_velocity number largest speed of a block that forces move, m/s
---@field stiffer table table of the same of the trial, with try_stiffer; `differs` tells whether the one rests and the other fails, `message` says so, or that one came to a limit before; reason "error" of a trial that failed

--- Runs a number of steps.
---
---     result = model:cycle(1000)  or  model:cycle(1000, {every = 100, on_progress = f})
---@param cycles integer number of steps to run
---@return talus.CycleResult
---@overload fun(self: talus.Model, cycles: integer, options: talus.CycleOptions): talus.CycleResult
function Model:cycle(cycles) end

---@class (exact) talus.SolveOptions
---@field ratio? number in [0, 1], default 1e-05: ends when the unbalanced force ratio falls below this; 0 for never
---@field measure? "average"|"maximum"|"local" default "local": which unbalanced force ratio ends the run: see theory.md, Convergence
---@field velocity? number m/s, >= 0: ends when no block is faster than this
---@field stop_at_failure? boolean default false: ends when some block is seen to fail steadily
---@field max_cycles? integer >= 0, default 1000000: largest number of steps of this call
---@field max_time? number s, > 0: longest simulated time of this call
---@field every? integer >= 1, default 500: steps between calls of on_progress and stop
---@field try_stiffer? boolean whether the same is tried on a copy whose joints are ten times as stiff: the result's `stiffer`
---@field stop? fun(model: talus.Model): any called every `every` steps; ends the run when it answers true
---@field on_progress? fun(model: talus.Model, result: talus.SolveResult) called every `every` steps

---@class (exact) talus.SolveResult
---@field reason string why it ended: "ratio", "velocity", "failure", "overlap" (blocks that were made overlapping push it apart), "cycles", "time", "stop" or "interrupt" (Ctrl-C at the prompt; in a script it raises an error)
---@field ratio number mean unbalanced force over mean contact force
---@field ratio_maximum number largest unbalanced force over mean contact force
---@field ratio_local number largest unbalanced force of a block over its own contact forces, or its weight and load where these are more
---@field measure string the measure that may end the run
---@field worst talus.Block? the block farthest from rest by the measure "local": nil when there is none that can move, or no force on any
---@field failing talus.Block? a block that fails steadily: it moves on in one direction without slowing down, and the force that pushes it stays; nil when none does
---@field cycles integer steps of this call
---@field time number the model's time at the end, s
---@field wall number seconds it took
---@field max_velocity number largest speed of a block that forces move, m/s
---@field stiffer table table of the same of the trial, with try_stiffer; `differs` tells whether the one rests and the other fails, `message` says so, or that one came to a limit before; reason "error" of a trial that failed

--- Runs until the forces balance or a limit is met.
---
---     result = model:solve{ratio = 1e-5, ...}
---@param options? talus.SolveOptions
---@return talus.SolveResult
function Model:solve(options) end

---@class (exact) talus.RelaxOptions
---@field ratio? number in (0, 1], default 1e-05: ends when the unbalanced force ratio falls below this
---@field measure? "average"|"maximum"|"local" default "local": which unbalanced force ratio ends it: see theory.md, Convergence
---@field stop_at_failure? boolean default true: ends when some block is seen to fail steadily
---@field max_cycles? integer >= 0, default 1000000: largest number of steps of this call
---@field load_steps? integer in [1, 10000], default 1: gravity and loads come on in so many equal parts, each near rest before the next: put on at once they settle a rock mass some per cent deeper, and zones yield that would not, for both follow their path. For loads that come on for the first time: a model that has borne them before is unloaded first
---@field every? integer >= 1, default 500: steps between calls of on_progress and stop
---@field try_stiffer? boolean whether the same is tried on a copy whose joints are ten times as stiff: the result's `stiffer`
---@field stop? fun(model: talus.Model): any called every `every` steps; ends the run when it answers true
---@field on_progress? fun(model: talus.Model, result: talus.SolveResult) called every `every` steps

---@class (exact) talus.RelaxResult
---@field reason string why it ended: "rest", "failure", "overlap" (blocks that were made overlapping push it apart), "cycles", "stop" or "interrupt" (Ctrl-C at the prompt; in a script it raises an error)
---@field message string what that means, in words; of a run that is not at rest what still moves, and why it is slow
---@field failing talus.Blocks? the selection of blocks that fail; nil when none does
---@field volume number? their volume, m3; nil when none fails
---@field direction talus.Vector? {x, y, z} of length 1: where they go; nil when none fails
---@field worst talus.Block the block farthest from rest by the measure "local"
---@field ratio number mean unbalanced force over mean contact force
---@field ratio_maximum number largest unbalanced force over mean contact force
---@field ratio_local number as in solve
---@field measure string the measure that may end it
---@field cycles integer steps of this call
---@field time number the model's time, which stands still, s
---@field wall number seconds it took
---@field max_velocity number largest speed of a block in the last step, by the masses of the relaxation, m/s
---@field stiffer table table of the same of the trial, with try_stiffer; `differs` tells whether the one rests and the other fails, `message` says so, or that one came to a limit before; reason "error" of a trial that failed

--- Finds where the model rests, or that it does not, by the cheapest means. Time, damping, time step and masses are afterwards as before, and nothing moves.
---
---     result = model:relax{ratio = 1e-5, ...}
---@param options? talus.RelaxOptions
---@return talus.RelaxResult
function Model:relax(options) end

---@class (exact) talus.HistoryOptions
---@field name string what it is called, one of its own
---@field every? integer >= 1, default 10: steps between two samples; the first is taken at once
---@field field? string field of numbers of what `of` gives ("displacement", "normal_force"), or of what is `at` a point
---@field at? talus.Vector m: of the point of a deformable block that is here now, and then goes with the block: a field of the zone in which it lies, or its position, displacement or velocity, between those of the zone's gridpoints
---@field take? "mean"|"sum"|"min"|"max" default "mean": of a selection: what is made of the values of its items
---@field remove? boolean default false: ends the history of that name, with all its samples
---@field value? fun(model: talus.Model): any|string gives a number, a list of numbers ({x, y, z}) or several numbers, as many each time; it may read the model, but not change it. Or one of "kinetic", "potential", "stored", "friction", "damping", "external", "strain", "plastic" (J), "balance", "ratio", "ratio_maximum", "ratio_local", "max_velocity" (m/s), "contacts", "slipping", "open" (numbers of contacts in the last step)
---@field of? talus.Block|talus.Contact|talus.Zone|talus.Gridpoint|talus.Blocks|talus.Contacts|talus.Zones|talus.Gridpoints what the field is sampled of, in the place of `value`. Those that no longer exist are left out; where none is left the value is nan

--- Samples a value at once and then every so many steps of all runs, until it is removed.
---
---     model:history{name = "gap", every = 10, value = function(m) return m:contacts():max("gap") end}  or  model:history{name = "wedge", of = selection, field = "displacement"}  or  model:history{name = "arch", at = {3.5, 0.4, 1.8}, field = "stress"}
---@param options talus.HistoryOptions
---@overload fun(self: talus.Model, options: talus.HistoryOptions)
---@overload fun(self: talus.Model, options: talus.HistoryOptions)
function Model:history(options) end

---@class (exact) talus.History
---@field cycle integer[] list of the steps at which it was sampled
---@field time number[] list of the times, s
---@field value (number|number[])[] list of the values, each a number or a list of numbers
---@field x number[] lists of the components, where each value is a list of three
---@field y number[] lists of the components, where each value is a list of three
---@field z number[] lists of the components, where each value is a list of three
---@field xx number[]? lists of the components of a field that is a tensor, as "stress"
---@field yy number[]? lists of the components of a field that is a tensor, as "stress"
---@field zz number[]? lists of the components of a field that is a tensor, as "stress"
---@field xy number[]? lists of the components of a field that is a tensor, as "stress"
---@field yz number[]? lists of the components of a field that is a tensor, as "stress"
---@field zx number[]? lists of the components of a field that is a tensor, as "stress"

--- Gives a table with the samples of each history, by name: copies of them.
---
---     histories = model:histories()
---@return table<string, talus.History>
function Model:histories() end

--- Writes the samples of all histories into a CSV file: the columns cycle, time and one for each history, in the order in which they were made, or name.x, name.y and name.z, of a tensor name.xx to name.zx. A cell is empty where a history has no sample of that cycle. Folders are made; the file is written whole or not at all.
---
---     model:write_histories("out/run.csv")
---@param path string
function Model:write_histories(path) end

---@class (exact) talus.BackAnalysisOptions
---@field build fun(values: table<string, number>): talus.Model, table? gives the model for values {NAME = number} of the unknown
---@field unknown table<string, number[]> the interval in which its value is sought
---@field observed table<string, number|number[]|boolean> what was observed: a number, a pair {low, high} of them, true or false
---@field measure? fun(model: talus.Model, values: table<string, number>): table gives a table with the field; when left out the second value that build gives is that table
---@field tolerance? number default 1e-4: share of the interval that is left when the search ends

---@class (exact) talus.BackAnalysisResult
---@field value number of the unknown; the ends of the interval that is left or, of a pair, the values for its two ends
---@field low number of the unknown; the ends of the interval that is left or, of a pair, the values for its two ends
---@field high number of the unknown; the ends of the interval that is left or, of a pair, the values for its two ends
---@field trials { friction: integer, safety: number }[] list of {NAME = value, FIELD = measured}

--- Finds the value of an unknown for which a model does what was observed, by halving an interval. Measured must be something that passes the observed value once in it.
---
---     found = talus.back_analysis{build = function(v) return model, {safety = v.friction / 30} end, unknown = {friction = {20, 60}}, observed = {safety = 1}}
---@param options talus.BackAnalysisOptions
---@return talus.BackAnalysisResult
function talus.back_analysis(options) end

---@class (exact) talus.BoltPatternOptions
---@field on talus.BoundaryResult the faces that are bolted
---@field spacing number[] of the grid in the plane of each face, across and along, m, both above 0
---@field length number of the bolts, m, from 1e-3 to 1e4
---@field direction? talus.Vector|string into the rock; faces that a bolt would not enter get none
---@field along? talus.Vector default {0, 1, 0}: direction of the rows, as it lies in each face: the axis of a tunnel
---@field origin? talus.Vector a point of the grid; left out: the centroid of the faces
---@field node_spacing? number `spacing` of the nodes of each bolt, m

--- Lays a grid of bolts over outer faces and gives a list for model:element("bolt", list). Other entries are parameters of the element "bolt", for each.
---
---     bolts = talus.bolt_pattern{on = model:boundary{facing = {0, 0, -1}}, spacing = {1.5, 1.5}, length = 3}
---@param options talus.BoltPatternOptions
---@return { from: talus.Vector, to: talus.Vector }[]
function talus.bolt_pattern(options) end

---@class (exact) talus.BoltTestOptions
---@field length number of the bolt, m, from 0.01 to 1000
---@field pull? number how far its mouth is drawn out, m; or `shear`
---@field shear? number how far a joint across its middle slides, m
---@field angle? number default 0: between the bolt and the normal of that joint, degrees, 0 to 89
---@field steps? number default 200: points of the curve

---@class (exact) talus.BoltTestResult
---@field displacement number[] list of the displacement of the mouth, or of the joint, m
---@field force number[]? list of the force at the mouth, N; nil with shear
---@field axial number[]? list of the largest tension, N; nil with pull
---@field dowel number[]? list of the dowel's force, N; nil with pull
---@field along number[]? list of the force that resists the slip, N; nil with pull
---@field closing number[]? list of the force that presses the joint together, N; nil with pull
---@field yielded boolean whether the bolt has yielded at the end
---@field broken boolean whether it has broken

--- Draws a bolt out of rock, or shears it by a joint, without a model, and gives the curve as lists. Other entries are parameters of the element "bolt". Its places, and in a pull its plate and pretension, are those of the test.
---
---     curve = talus.bolt_test{length = 2, pull = 0.01, grout_strength = 2e5}  or  curve = talus.bolt_test{length = 2, shear = 0.01, dowel_stiffness = 1e8}
---@param options talus.BoltTestOptions
---@return talus.BoltTestResult
---@overload fun(options: talus.BoltTestOptions): talus.BoltTestResult
function talus.bolt_test(options) end

---@class (exact) talus.ConvertOptions
---@field file string name of the data file, of 3DEC 7 to 9 or a classic one
---@field to? string name of the script that is written; folders are made
---@field up? "z"|"y" axis that points up in the file, z when left out; with "y" dip directions count from z, as in left-handed files

---@class (exact) talus.ConvertResult
---@field script string the script, a text
---@field report string[] lines that tell what was converted and what was not
---@field converted integer number of commands; of those for which Talus needs nothing
---@field needless integer number of commands; of those for which Talus needs nothing
---@field left_out { file: string, line: integer, reason: string, source: string }[] lists of {file =, line =, source =, reason =}: commands without counterpart, those of which a part has none, and those that are wrong
---@field in_part table lists of {file =, line =, source =, reason =}: commands without counterpart, those of which a part has none, and those that are wrong
---@field mistakes table lists of {file =, line =, source =, reason =}: commands without counterpart, those of which a part has none, and those that are wrong

--- Writes a data file of 3DEC as a script of Talus, one line a command, and tells what is left out. `talus convert [--up y] FILE [SCRIPT.lua]` does the same from a shell, and `talus run FILE.3ddat`, or FILE.dat, runs it at once.
---
---     result = talus.convert{file = "scripts/examples/fault.3ddat"}
---@param options talus.ConvertOptions
---@return talus.ConvertResult
function talus.convert(options) end

---@class (exact) talus.PlotOptions
---@field file string name of the SVG file; folders are made
---@field series? { x: number[]?, y: number[]?, name: string?, style: string?, colour: string? }[] lines: lists of numbers x (1, 2, 3, ... when left out) and y; style is "line", "points" or "both", colour "#0072b2". Numbers that are not finite make a gap. Or {history =, component =, against =, name =}: history is one of model:histories(), component "x", "y", "z" or a number (all when left out), against "time" or "cycle"
---@field model? talus.Model draws histories of this model
---@field histories? string[] which of them, in this order; all when left out
---@field x_axis? string|{ name: string?, unit: string?, log: boolean?, range: number[]? } name and unit of the axis; log = true is a logarithmic one, which leaves out numbers not above 0; range = {from, to} when left out takes in all
---@field y_axis? string|{ name: string?, unit: string?, log: boolean?, range: number[]? } name and unit of the axis; log = true is a logarithmic one, which leaves out numbers not above 0; range = {from, to} when left out takes in all
---@field title? string stands above the picture
---@field legend? boolean whether a list of the lines stands beside; left out: when there are several, or names
---@field grid? boolean default true: whether ticks have lines across
---@field width? number default 720 and 440: of the picture, pixels
---@field height? number default 720 and 440: of the picture, pixels

--- Draws lists and histories as lines, with axes, ticks and a legend, into an SVG file.
---
---     talus.plot{file = "out/run.svg", model = model, histories = {"roof"}, y_axis = {name = "subsidence", unit = "m"}}
---@param options talus.PlotOptions
function talus.plot(options) end

--- Reads measured orientations of joints: a table whose first line names the columns dip and dip_direction, and weight if there is one; or a list of {dip, dip_direction}. Cells are separated by commas, semicolons or tabs; with semicolons or tabs numbers may have decimal commas. Poles are axes, and their order means nothing. declination, degrees in [-180, 180], default 0, is that of magnetic from true north, east positive: it is added to all dip directions. Tables that are written are from true north.
---
---     poles = talus.poles{{30, 120}, {32, 118}}  or  talus.poles("FILE", {declination = 3.5})
---@param options? table
---@return table
---@overload fun(name: string, options?: table): table
function talus.poles(options) end

---@class (exact) talus.RealisationsOptions
---@field number integer of realisations
---@field build fun(draw: table): talus.Model gives the model of a realisation, by what it draws
---@field measure fun(model: talus.Model, draw: table): table, boolean? gives a table of what is measured: numbers, true and false, texts; the same names in each realisation
---@field screen? fun(model: talus.Model, draw: table): table, boolean? cheap test before the measure: gives a table likewise, and true when that decides, so that nothing is measured
---@field seed? integer default 1: of all draws
---@field latin? boolean default false: a Latin hypercube: of n realisations each n-th part of a distribution has one
---@field workers? integer default 1: processes that work at once; the rows are the same for any number
---@field file? string file of rows; one that is there is gone on with, and rows that it has are not computed again
---@field stop_when? { field: string, half_width: number, at_least: integer? } ends when the 95 % interval of the probability of the field has at most this half width, of so many rows or more
---@field on_row? fun(rows: integer) called after each row that is written, with the number of rows

--- Builds and measures many models, each with draws of its own, in worker processes, and gives the set of rows. A draw is a pure function of seed, row and name. A row that errs has its sentence in `error`; more than 5 % of them end the run. `talus run --shard i/n SCRIPT` makes the rows i, i + n, ... in FILE.shard-i-of-n, and `talus merge FILE` one file of the shards.
---
---     set = talus.realisations{number = 3, build = function(draw) return model end, measure = function(model, draw) return {failed = draw.uniform("u", 0, 1) < 0.1} end}
---@param options talus.RealisationsOptions
---@return table
function talus.realisations(options) end

---@class (exact) talus.StereonetOptions
---@field file string name of the SVG file; folders are made
---@field model? talus.Model draws the joint sets of this model, from the faces of its blocks as they lie now
---@field joints? string[] which of its joint sets ("J1"), in this order; all when left out
---@field sets? { name: string?, dip: number, dip_direction: number }[] further sets, degrees; or {name =, planes = {{dip, dip_direction}, ...}} for several planes
---@field poles? table|table[] what talus.poles gave, or a list of sets as its method sets gives
---@field keyblocks? talus.Keyblock[] what model:keyblocks{...} gave: a cross for the direction of each movement
---@field projection? "equal_area"|"equal_angle" of Schmidt and Lambert, the default, or of Wulff
---@field great_circles? "mean"|"all"|"none" of the mean plane of each set, the default, of every plane, or of none
---@field title? string stands above the picture
---@field legend? boolean default true: whether a list of the sets stands beside, with mean dip/dip direction
---@field grid? boolean default true: whether plunges of 30 and 60 degrees and every 30 degrees of trend are drawn
---@field size? number default 480: of the square picture without the legend, pixels

--- Draws joint sets by poles and great circles on the lower hemisphere, into an SVG file.
---
---     talus.stereonet{file = "out/joints.svg", model = model, keyblocks = model:keyblocks{friction = 30}}
---@param options talus.StereonetOptions
function talus.stereonet(options) end

--- Writes a text into a file, whole or not at all. Folders are made; only a regular file is replaced.
---
---     talus.write_file("out/table.csv", text)
---@param path string
---@param text any
function talus.write_file(path, text) end

---@class (exact) talus.ReportResult
---@field blocks integer number of blocks, and of bodies they make
---@field bodies integer number of blocks, and of bodies they make
---@field volume number of all blocks, m3; and its relative difference from what was created less what was deleted
---@field volume_error number of all blocks, m3; and its relative difference from what was created less what was deleted
---@field smallest_volume number m3, m and m2; smallest_volume_block and so on are the blocks that have them
---@field smallest_edge number m3, m and m2; smallest_volume_block and so on are the blocks that have them
---@field smallest_face number m3, m and m2; smallest_volume_block and so on are the blocks that have them
---@field worst_aspect number largest aspect of a block: its diameter (largest distance between two vertices) over its thickness (smallest extent along the normal of a face); 1.73 for a cube
---@field worst_aspect_block talus.Block largest aspect of a block: its diameter (largest distance between two vertices) over its thickness (smallest extent along the normal of a face); 1.73 for a cube
---@field slivers integer number of bodies whose shape makes the time step short where all joints are equally stiff, and their share of the volume; model:filter{auto = true} joins them
---@field sliver_share number number of bodies whose shape makes the time step short where all joints are equally stiff, and their share of the volume; model:filter{auto = true} joins them
---@field sliver_gain number how many times longer a step the others allow
---@field deformable integer number of blocks that have zones, and what they have; segments are where their surfaces lie on others
---@field zones integer number of blocks that have zones, and what they have; segments are where their surfaces lie on others
---@field gridpoints integer number of blocks that have zones, and what they have; segments are where their surfaces lie on others
---@field clusters integer number of blocks that have zones, and what they have; segments are where their surfaces lie on others
---@field segments integer number of blocks that have zones, and what they have; segments are where their surfaces lie on others
---@field smallest_altitude number? smallest altitude of a zone over its largest side, m, and the block that has it; nil without zones
---@field smallest_altitude_block talus.Block? smallest altitude of a zone over its largest side, m, and the block that has it; nil without zones
---@field cuts integer cuts made, refused because a side would be too thin, and fallen on existing faces, since the model was made
---@field refused integer cuts made, refused because a side would be too thin, and fallen on existing faces, since the model was made
---@field coincident integer cuts made, refused because a side would be too thin, and fallen on existing faces, since the model was made
---@field refused_cuts table the first 1000 refused cuts, each a table: joint, normal and point of the plane, block (its number), thickness and limit of the thinner side, and the reason as a sentence
---@field dt number the time step, s, the block that controls it, and the same in a sentence; when some contact has no law yet, there is only the sentence
---@field timestep_block talus.Block the time step, s, the block that controls it, and the same in a sentence; when some contact has no law yet, there is only the sentence
---@field timestep_message string the time step, s, the block that controls it, and the same in a sentence; when some contact has no law yet, there is only the sentence

--- Tells how good the blocks are that cutting made, and prints it on a page (not with --quiet).
---
---     table = talus.report(model)
---@param model talus.Model
---@return talus.ReportResult
function talus.report(model) end

---@class (exact) talus.FilterOptions
---@field volume? number m3, > 0: blocks smaller than this are slivers
---@field edge? number m, > 0: blocks with a shorter edge are slivers
---@field aspect? number > 1: blocks whose diameter is more than this times their thickness are slivers
---@field action? "report"|"delete"|"join" default "report": what is done with them: nothing; they are deleted; or each is joined to the block it shares the largest face with; joined when left out with auto = true
---@field auto? boolean default false: no limits are given: they are chosen so that little rock is beyond them, without which the time step is much longer; none where no filter gains a factor of two

---@class (exact) talus.FilterResult
---@field found integer number of slivers, and what was done with them
---@field deleted integer number of slivers, and what was done with them
---@field joined integer number of slivers, and what was done with them
---@field volume number of all slivers, m3
---@field gain number? how many times longer the time step is or, where slivers are only reported, would be; as long as some contact has no law, where all joints are equally stiff; nil without auto
---@field slivers table each a table: block (its number), volume, edge, aspect, beyond (which limits: "volume", "edge", "aspect") and joined_to (a block, or nil)

--- Finds slivers, the visible blocks beyond the limits, and deletes them or joins them to neighbours.
---
---     result = model:filter{volume = 1e-6, aspect = 100, action = "join"}
---@param options? talus.FilterOptions
---@return talus.FilterResult
function Model:filter(options) end

---@class (exact) talus.KeyblocksOptions
---@field gravity? talus.Vector m/s2: acceleration that acts on the blocks; that of the model when left out
---@field target? number > 0: factor of safety that is asked for: each keyblock then tells the support that it takes
---@field friction? number|table<string, number> friction angle of the joints, degrees, in [0, 90): one for all, or by joint: {["*"] = 35, J1 = 30, ["J1:3"] = 25}; the closest name counts
---@field cohesion? number|table<string, number> cohesion of the joints, Pa, likewise; 0 where none is given

---@class (exact) talus.Keyblock
---@field block talus.Block the block, the oldest one of a body of several
---@field mode string "falling", "sliding" (on one face), "sliding on two", or "stable": removable, but pressed in by its weight
---@field safety number factor of safety: 0 falling, math.huge stable
---@field faces { area: number, joint: string, normal: talus.Vector, normal_force: number }[] the faces it slides on, none to two: {joint =, normal = (outward), area =, normal_force =}
---@field direction talus.Vector of the motion, and the force along it, N; a stable one has no direction
---@field driving_force number of the motion, and the force along it, N; a stable one has no direction
---@field force talus.Vector weight and load, N; of the body, kg and m3
---@field mass number weight and load, N; of the body, kg and m3
---@field volume number weight and load, N; of the body, kg and m3
---@field support number? with target: least force against the motion that brings that factor, N; and the pressure on its outer faces that pushes as much against the motion, Pa, whatever it adds to normal forces; 0 where nothing is needed, nil where outer faces do not look along the motion
---@field support_pressure number? with target: least force against the motion that brings that factor, N; and the pressure on its outer faces that pushes as much against the motion, Pa, whatever it adds to normal forces; 0 where nothing is needed, nil where outer faces do not look along the motion
---@field pyramid talus.Vector[] edges of the joint pyramid, unit vectors: it can move in all directions between them

--- Finds the bodies that a translation can move out of the others (Shi's theorem), how they move, and their factor of safety in limit equilibrium.
---
---     list = model:keyblocks{friction = 35, target = 1.5}
---@param options? talus.KeyblocksOptions
---@return talus.Keyblock[]
function Model:keyblocks(options) end

--- Begins a stage: displacements of all blocks count from now, as after reset_displacement, and so does what model:verdict and pages tell of slip and opening. What laws keep stays. The name is at most 63 bytes; copies and files have it.
---
---     model:stage("excavated")
---@param name string
function Model:stage(name) end

---@class (exact) talus.VerdictResult
---@field standing string "at rest" below the local ratio of the last solve, else below 1e-5; "failed" by the criterion of stop_at_failure in the last solve; "accelerating" where unbalanced forces push on; else "moving". "unknown" before the first step
---@field text string all of this as one line
---@field stage string name given to model:stage, or ""
---@field ratio number the local unbalanced force ratio
---@field closed number blocks that have not moved, but closed their joints, have displacements up to this, m
---@field moved integer blocks that have moved by more than that, and by more than a twentieth of the largest displacement, a body of several parts as one; their volume, m3
---@field volume number blocks that have moved by more than that, and by more than a twentieth of the largest displacement, a body of several parts as one; their volume, m3
---@field direction talus.Vector of their mean motion, a unit vector
---@field farthest integer id of the block that has moved the most, and how far, m
---@field displacement number id of the block that has moved the most, and how far, m
---@field slip number how far two bodies have moved along each other since the stage began, the largest, m: the mean, by area, of their contacts on faces that look the same way; id of the first of these
---@field slipped integer how far two bodies have moved along each other since the stage began, the largest, m: the mean, by area, of their contacts on faces that look the same way; id of the first of these
---@field opening number the same apart, m; id of such a contact, 0: none
---@field opened integer the same apart, m; id of such a contact, 0: none
---@field contacts integer contacts there are, and those that slip
---@field slipping integer contacts there are, and those that slip

--- Tells how the model stands as of its last step: at rest, moving, accelerating or failed, and what has moved since the stage began. Nothing changes by it.
---
---     verdict = model:verdict()
---@return talus.VerdictResult
function Model:verdict() end

---@class (exact) talus.ProfileResult
---@field seconds { damping: number, detect: number, energy: number, gather: number, laws: number, move: number, timestep: number, zones: number }
---@field steps integer steps since profiling began
---@field pairs integer candidate pairs of the broad phase, now
---@field contacts integer contacts there are, and those that carry a force
---@field loaded integer contacts there are, and those that carry a force
---@field points integer contact points
---@field zones integer of deformable blocks; segments are where their surfaces lie on others
---@field gridpoints integer of deformable blocks; segments are where their surfaces lie on others
---@field segments integer of deformable blocks; segments are where their surfaces lie on others

--- Times the phases of the steps, and tells what a step works on.
---
---     model:profile(true); model:cycle(100); result = model:profile()
---@param on? boolean begins to time the phases of each step, from zero, or ends it; left out, gives the result so far
---@return talus.ProfileResult
---@overload fun(self: talus.Model): talus.ProfileResult
function Model:profile(on) end

---@class (exact) talus.MemoryResult
---@field blocks integer columns of the blocks
---@field shapes integer polyhedra
---@field bodies integer columns of the bodies
---@field step integer columns of the bodies that live through a step only
---@field broad integer how far blocks have moved since pairs were listed
---@field pairs integer candidate pairs
---@field contacts integer columns of the contacts
---@field facets integer faces of the contacts, and what field contacts keep beside their points
---@field points integer columns of the contact points
---@field index integer lists of each block's contacts, and of contacts by number
---@field spare integer second set of tables of contacts and points
---@field zones integer gridpoints, zones and segments of deformable blocks
---@field elements integer elements, their nodes, parameters and lists
---@field other integer rows by number, scratch of the threads, joints and laws
---@field total integer all of them

--- Bytes the model holds, by what they are for, room for growth included.
---
---     bytes = model:memory()
---@return talus.MemoryResult
function Model:memory() end

---@class (exact) talus.WriteHtmlOptions
---@field title? string title of the page; the name at the end of its path when left out
---@field contacts? boolean|"slipping" which contacts the frame has; when left out all, where there are 20000 at the most, and else those that slip
---@field block_fields? string[]|table<string, string|table<integer, number>|fun(block: talus.Block): number?> numbers of each block to colour by: fields of blocks, tables of numbers by ids, and functions that give a number, or nil for none
---@field contact_fields? string[]|table<string, string|fun(contact: talus.Contact): number?> numbers of each contact, likewise: fields of contacts, states of their laws, functions
---@field keyblocks? talus.KeyblocksOptions parameters of model:keyblocks, whose modes and factors of safety are shown as well
---@field safety_limit? number factor of safety that is asked for: the legend marks it

--- Adds a frame to a page for a browser: one file that shows the blocks, in every frame so far. The folder and the name are given first, with or without .html.
---
---     model:write_html("out/run", {title = "Slope", block_fields = {"kinetic_energy"}})
---@param path string
---@param options? talus.WriteHtmlOptions
function Model:write_html(path, options) end

---@class (exact) talus.WriteVtkOptions
---@field blocks? boolean default true: whether the frame has a file of the blocks
---@field contacts? boolean default true: whether the frame has a file of the contacts
---@field joints? boolean default true: whether the frame has a file of the faces that joints made
---@field elements? boolean default true: whether the frame has a file of the elements
---@field zones? boolean default true: whether the frame has a file of the zones of deformable blocks
---@field block_fields? string[]|table<string, string|table<integer, number>|fun(block: talus.Block): number?> numbers of each block to colour by: fields of blocks, tables of numbers by ids, and functions that give a number, or nil for none
---@field contact_fields? string[]|table<string, string|fun(contact: talus.Contact): number?> numbers of each contact, likewise: fields of contacts, states of their laws, functions
---@field zone_fields? { NAME: number } numbers of each zone, likewise: fields of zones, states of their solids, functions

--- Writes the next frame of a series of VTK files for ParaView, all of it or some of its files. Their names begin with the folder and the name given first.
---
---     model:write_vtk("out/run", {contacts = false, block_fields = {height = function(b) return b.centroid[3] end}})
---@param path string
---@param options? talus.WriteVtkOptions
function Model:write_vtk(path, options) end

---@class (exact) talus.WriteSectionOptions
---@field dip number deg, in [0, 90]: dip of the plane below horizontal
---@field dip_direction? number deg, in [0, 360], default 0: its dip direction, clockwise from north (+y)
---@field origin? talus.Vector m, default {0, 0, 0}: a point on the plane

--- Writes the next frame of a section: the polygons in which a plane cuts the blocks, with their displacements.
---
---     model:write_section("out/cut", {dip = 90, dip_direction = 90, origin = {0, 0, 0}})
---@param path string
---@param options talus.WriteSectionOptions
function Model:write_section(path, options) end

--- Writes all blocks as they stand into a JSON file. A name that ends in .obj, .stl, .ply or .vtk gets surfaces.
---
---     model:write_blocks("out/blocks.json")
---@param path string name of the file
function Model:write_blocks(path) end

---@class (exact) talus.ViewOptions
---@field title? string title of the page
---@field commands? boolean default true: whether commands are taken; without, the page only shows
---@field share? number in (0, 1], default 0.02: most of the run's time that goes into frames
---@field contacts? boolean|"slipping" which contacts the frame has; when left out all, where there are 20000 at the most, and else those that slip
---@field block_fields? string[]|table<string, string|table<integer, number>|fun(block: talus.Block): number?> numbers of each block to colour by: fields of blocks, tables of numbers by ids, and functions that give a number, or nil for none
---@field contact_fields? string[]|table<string, string|fun(contact: talus.Contact): number?> numbers of each contact, likewise: fields of contacts, states of their laws, functions
---@field keyblocks? talus.KeyblocksOptions parameters of model:keyblocks, whose modes and factors of safety are shown as well
---@field safety_limit? number factor of safety that is asked for: the legend marks it
---@field wait? boolean whether view waits, and does what is asked for on the page, until "go" is pressed there
---@field prefix? string folder and name with which files begin that are written from the page; view when left out
---@field log? string a file for the lines that repeat the work on the page

--- Shows the model in a browser while it runs, and takes commands from there. Gives the address to open. The page shows the model whenever a run makes steps, and while view waits.
---
---     address = model:view{title = "Slope"}
---@param options? talus.ViewOptions
---@return string
function Model:view(options) end

--- The same model once more in memory: equal state, and equal bits after equal calls from then on. The functions of drives are shared; frames of the copy begin with 0.
---
---     twin = model:copy()
---@return talus.Model
function Model:copy() end

--- Saves all that the next steps depend on, to the bit, compressed and with checksums. The file appears whole or not at all, in the place of an older one, and outlives a crash of the machine; folders are made. The model goes on as if it had not been saved. Histories are saved with all their samples; functions of drives and histories are not. Frames of files go on with the next number.
---
---     model:save("out/run.talus")
---@param path string
function Model:save(path) end

---@class (exact) talus.RestoreOptions
---@field threads? integer threads, in [1, 256]; default: as of talus.model. Results are the same bits for any number
---@field drives? table<integer, function|{ velocity: function?, angular_velocity: function? }> what functions drive, by the lowest block of each drive: a function(t) for its velocity, or {velocity = function(t), angular_velocity = function(t)}
---@field histories? { NAME: number } what functions sample, by the name of each history; false ends the history of that name

--- The model that a file holds: it goes on as the saved one does, to the bit, on any number of threads. Laws and damping must be loaded in the version that it was saved with. A damaged file, and one of another format, is refused.
---
---     model = talus.restore("out/run.talus", {threads = 2})
---@param path string
---@param options? talus.RestoreOptions
---@return talus.Model
function talus.restore(path, options) end

--- The model that `talus run --autosave MINUTES SCRIPT` saved last, after `talus run --resume SCRIPT`; nil when the script is not resumed, or nothing was saved. Takes the options of talus.restore. The file lies beside the script: SCRIPT.autosave.talus.
---
---     model = talus.resumed()
---@return talus.Model?
function talus.resumed() end

---@class (exact) talus.SeatOptions
---@field gap? number m, >= 0: gaps up to which faces are taken as being on each other; when left out 1 % of the mean size of the blocks
---@field overlap? number m, >= 0: overlaps up to which blocks are taken as only touching; when left out 1 % of the mean size of the blocks

---@class (exact) talus.SeatResult
---@field contacts integer number of pairs that were made to fit; those that fit already are not among them
---@field largest_gap number of these, as they were before, m; the mean is by area
---@field mean_gap number of these, as they were before, m; the mean is by area
---@field largest_overlap number likewise
---@field mean_overlap number likewise
---@field beyond table pairs beyond the limits, which stay as drawn: {a = block, b = block, gap =, overlap =}
---@field gap number the limits, m
---@field overlap number the limits, m

--- Takes blocks as drawn as fitting: gaps and overlaps up to a limit become the state free of force, under any law. Contacts are free of force after it. Prints and returns what was found.
---
---     result = model:seat{gap = 0.002, overlap = 0.002}
---@param options? talus.SeatOptions
---@return talus.SeatResult
function Model:seat(options) end

--- Puts elements on the blocks as they are now: one, or what a list of tables says, all or none. An element acts on points of blocks, its nodes: a spring, a bolt, water between walls. group = "NAME" names those of a call. Nodes follow their blocks when these are cut or joined.
---
---     selection = model:element("KIND", {...})  or  model:element("KIND", {{...}, {...}})
---@param name string
---@param options? table
---@return { after: integer, before: integer, coincident: integer, cuts: integer, refused: integer, slivers: integer, smallest_edge: number, smallest_face: number, smallest_volume: number, volume_error: number }
---@overload fun(self: talus.Model, name: string, options?: table): { after: integer, before: integer, coincident: integer, cuts: integer, refused: integer, slivers: integer, smallest_edge: number, smallest_face: number, smallest_volume: number, volume_error: number }
function Model:element(name, options) end

---@class (exact) talus.ElementsOptions
---@field kind? string elements of this kind
---@field group? string elements of this group
---@field block? talus.Block|integer elements with a node on this block
---@field where? fun(element: talus.Element): any elements for which the function answers true

--- Selects elements; all conditions must hold. Beside its fields an element has the states of its kind by their names, as element.axial; those of its nodes are in element.nodes.
---
---     selection = model:elements{...}
---@param options? talus.ElementsOptions
---@return talus.Elements
function Model:elements(options) end

---@class (exact) talus.WaterOptions
---@field level? number of a level table: its height z, m
---@field dip? number of a table that dips, degrees: with dip_direction and origin in the place of level
---@field dip_direction? number likewise, degrees
---@field origin? talus.Vector a point of it, m
---@field unit_weight? number of the water under a table, N/m3; 9810 when left out
---@field factor? number of the pressure under a table, as drains leave it; 1 when left out
---@field pressure? number|fun(x: number, y: number, z: number): number uniform pressure, Pa; or of a field, asked once for each node and then kept
---@field joints? string|string[] joints that have this water, "A", "A:3" or "*"; all when left out
---@field aperture? number of "flow", m: hydraulic aperture of walls that just touch, of all joints, by joint with "*" for the others, or asked once for each wet joint, at its middle; it grows as the joint opens and falls as it closes
---@field residual? number likewise: least aperture; 2e-5 when left out
---@field maximum? number likewise: largest aperture that counts; 2e-3 when left out
---@field viscosity? number likewise, Pa s; 1e-3 when left out
---@field heads? { inside: { min: talus.Vector, max: talus.Vector }, min: talus.Vector, max: talus.Vector, head: number }[] likewise: heads, m above z = 0, of the edges of wet joints whose middle lies in a box
---@field drains? (talus.Vector|number)[][] likewise: holes of a radius, m, in which the pressure is 0
---@field steady? boolean likewise: true, when left out, for water in balance; false: joints store water
---@field every? number likewise: steps between two solutions; 100 of steady flow and 1 of stored water when left out
---@field bulk? number likewise: bulk modulus of water that is stored, Pa; 2e9 when left out
---@field initial_head? number likewise: head at the beginning where flow is not steady; without it pressure is 0, m
---@field drain_gap? number mean opening beyond which a joint runs dry, m; 0.05 when left out

--- Lets water press on the walls of joints: on the polygons in which a face of one block faces one of another, in contact or not. A later call takes the place of earlier water on the same walls; "none" takes it away, from some joints or from all. A joint keeps its water until its mean opening passes drain_gap; then it is dry. Of "flow" pressures are found by the cubic law, between heads and drains, with apertures that follow the joints: model:flow tells what flows. What the laws see is the effective force. Keyblocks take water as a force. The elements have the states area, opening and dry, their nodes pressure.
---
---     selection = model:water("table", {level = 20})  or  model:water("uniform", {pressure = 65e3, joints = {"J1"}})  or  model:water("field", {pressure = function(x, y, z) return 9810 * z end})  or  model:water("none")  or  model:water("flow", {aperture = 2e-4, heads = {{inside = {min = {-2, -2, -2}, max = {2, 2, 2}}, head = 20}}})
---@param name string
---@param options? talus.WaterOptions
---@return talus.Elements
---@overload fun(self: talus.Model, name: string, options?: talus.WaterOptions): talus.Elements
---@overload fun(self: talus.Model, name: string, options?: talus.WaterOptions): talus.Elements
---@overload fun(self: talus.Model, name: string): talus.Elements
---@overload fun(self: talus.Model, name: string, options?: talus.WaterOptions): talus.Elements
function Model:water(name, options) end

--- What flows in the joints, as of the last solution: lists heads and drains, in the order in which they were given, of tables with flow, m3/s into the rock, and closed, true when it reaches no joint any more; joints, the selection of wet joints, with area, aperture, flow, head and closed; and closed, how many of them reach neither a head nor a drain.
---
---     model:water("flow", {aperture = 2e-4, steady = false}); result = model:flow()
---@return { closed: integer, drains: table, heads: table, joints: talus.Elements }
function Model:flow() end

---@class (exact) talus.FactorOfSafetyOptions
---@field from? number >= 0.05, default 0.1: least factor that is tried
---@field to? number > 0.05, default 10: largest factor that is tried; above `from`
---@field resolution? number in [0.0001, 0.5], default 0.01: relative width of the bracket that is found
---@field least_volume? number m3, >= 0, default 0: what fails and is smaller than this in all is deleted in the copies and listed, and the search goes on
---@field max_cycles? integer >= 1, default 100000: largest number of steps of one trial; one that is undecided then counts as failing
---@field workers? integer in [1, 256], default 1: processes that make trials at once; what is found is the same for any number
---@field solids? boolean default true: whether the strengths of deformable blocks' solids are divided, too
---@field elements? boolean default false: whether the strengths of elements, such as bolts, are divided, too
---@field joints? string|string[] joints whose laws are divided: they must have laws of their own; all when left out
---@field on_trial? fun(trial: { F: number, holds: boolean, undecided: boolean, cycles: integer, why: string }) called after each trial with {F =, holds =, undecided =, cycles =, why =}

---@class (exact) talus.FactorOfSafetyResult
---@field factor number sqrt(lower * upper); 0 where it fails whatever the strengths, math.huge where it holds at `to`, `from` where it fails there
---@field lower number the largest factor that holds, 0: none; and the least that fails, math.huge: none
---@field upper number the largest factor that holds, 0: none; and the least that fails, math.huge: none
---@field failing talus.Blocks selection of the blocks that go together at `upper`: those within 0.3 of the fastest
---@field volume number? of these, m3, and where they go, a unit vector; without any direction is nil
---@field direction talus.Vector? of these, m3, and where they go, a unit vector; without any direction is nil
---@field mode string "slides"; "turns" (its corners go farther by rotation than its centre goes); "falls" (nothing bears it); "yields" (a deformable block is strained on and on); "holds" without any
---@field keyblock { block: talus.Block, factor: number }? {factor =, block =}: the least factor of model:keyblocks with the strengths of the laws; nil where there is none, or laws have no friction and cohesion or name blocks
---@field trials { F: number, cycles: integer, holds: boolean, undecided: boolean, why: string }[] each a table: F, holds, undecided, cycles, why; in the order in which they were made
---@field small talus.Blocks selection of the blocks below least_volume that failed before at `upper`, and were deleted in that copy
---@field undecided integer number of trials that neither came to rest nor failed: they count as failing
---@field cycles integer steps of all trials, and s
---@field wall number steps of all trials, and s
---@field message string all of this in a sentence

--- Finds by how much the strengths of laws and solids may be divided before the model does not come to rest any more. Trials are made on copies: the model stays as it is.
---
---     result = model:factor_of_safety{resolution = 0.01}
---@param options? talus.FactorOfSafetyOptions
---@return talus.FactorOfSafetyResult
function Model:factor_of_safety(options) end

---@class (exact) talus.SafetyMapOptions
---@field from? number >= 0.05, default 0.5: least factor that is tried
---@field to? number > 0.05, default 3: largest factor that is tried; above `from`
---@field step? number >= 0.001, default 0.02: from one factor to the next
---@field failed? "delete"|"hold" default "delete": what becomes of blocks that have failed, in the copies: they are deleted, or held where they were
---@field max_cycles? integer >= 1, default 100000: largest number of steps of one trial; one that is undecided then counts as failing
---@field workers? integer in [1, 256], default 1: processes that make trials at once; what is found is the same for any number
---@field solids? boolean default true: whether the strengths of deformable blocks' solids are divided, too
---@field elements? boolean default false: whether the strengths of elements, such as bolts, are divided, too
---@field joints? string|string[] joints whose laws are divided: they must have laws of their own; all when left out
---@field on_trial? fun(trial: { F: number, holds: boolean, undecided: boolean, cycles: integer, why: string }) called after each trial with {F =, holds =, undecided =, cycles =, why =}

---@class (exact) talus.SafetyMapResult
---@field factor table by the id of each block that can move: the factor at which it fails once those before it have gone; math.huge: it holds at `to`; 0: nothing holds it. Files and screens take it as block_fields = {safety = map.factor}
---@field curve { blocks: integer, factor: number, volume: number }[] by ascending factors, each {factor =, volume =, blocks =}: what has failed by then, in all
---@field undecided integer number of trials that neither came to rest nor failed: they count as failing
---@field cycles integer steps of all trials, and s
---@field wall number steps of all trials, and s

--- Finds the factor of safety of every block: strengths are divided by more and more, and what has failed goes before it goes on. Trials are made on copies: the model stays as it is.
---
---     map = model:safety_map{from = 0.5, to = 3, step = 0.5}
---@param options? talus.SafetyMapOptions
---@return talus.SafetyMapResult
function Model:safety_map(options) end

---@class (exact) talus.RecordOptions
---@field file? string lines of numbers, or PEER's AT2 or VT2; or give samples in `at`
---@field column? integer in [0, 64], default 0: which number of each line it is; 0: the last of two, all of a file that tells NPTS
---@field dt? number s, >= 0, default 0: from one sample to the next; 0: as the file says
---@field quantity? "acceleration"|"velocity" default "acceleration": what the samples are
---@field unit? "own"|"m/s2"|"g"|"cm/s2"|"m/s"|"cm/s" default "own": of the samples; own: as the file says, or m/s2 and m/s; g is 9.80665 m/s2
---@field scale? number default 1: by which the samples are multiplied
---@field baseline? "as_is"|"mean"|"parabola" default "as_is": what is taken off a motion that drifts: nothing, the mean acceleration, or the parabola that fits the velocity best
---@field at? number[] samples, in the place of a file; then dt must be given
---@field band? number[] {low, high}, Hz: filters of Butterworth at both, forward and backward, so without a shift in time; low = 0: only at high

--- A record of ground motion, which blocks follow as selection:drive{velocity = {rec, 0, 0}}.
---
---     rec = talus.record{at = {0, 1, -1, 0}, dt = 0.01}
---@param options? talus.RecordOptions
---@return userdata
function talus.record(options) end

---@class (exact) talus.ModesOptions
---@field count? integer in [1, 1000], default 6: how many vibrations, the slowest first

--- Finds the slowest vibrations of small size about the present place of a model at rest.
---
---     modes = model:modes{count = "COUNT"}
---@param options? talus.ModesOptions
---@return { after: integer, before: integer, coincident: integer, cuts: integer, refused: integer, slivers: integer, smallest_edge: number, smallest_face: number, smallest_volume: number, volume_error: number }
function Model:modes(options) end

return talus

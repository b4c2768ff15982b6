! Written by fortran.py from motet.h and motet.in.f90. Change these, not this file.
!
! motet for Fortran 2018. Arrays are real64 of shape (3, n), used in place; ids start at 0, as in C.
!
! Compile this with your program, and link libmotet:
!   gfortran motet.f90 yours.f90 $(pkg-config --libs motet)
!
! motet.h is the reference for what each call does; names here have no prefix. Every call that can fail has
! two optional arguments at its end: `status`, MOTET_OK or one of MOTET_ERROR_.., and `message`, a text that is
! cut to its length. Without `status` an error stops the program and prints the message. Objects are freed when
! they go out of scope, or by `free`; they must not be copied by assignment.
!
! Lists in options are arrays of Fortran, such as `options%slide = [character(8) :: 'inlet', 'outlet']`; blanks at
! the end of a name do not count. A call is watched by `options%watched_by => mine`, a `type(watch), target`.
module motet
  use, intrinsic :: iso_c_binding
  implicit none
  private

  public :: motet_version
  public :: certificate, moving_step, progress

  ! The largest length of a name in options. Their lengths are not deferred: gfortran 12 copies such components
  ! wrongly.
  integer, parameter, public :: MOTET_NAME_LENGTH = 256

  ! The version of the header.
  integer(c_int32_t), parameter, public :: MOTET_VERSION_MAJOR = 0
  integer(c_int32_t), parameter, public :: MOTET_VERSION_MINOR = 1
  integer(c_int32_t), parameter, public :: MOTET_VERSION_PATCH = 0

  ! Statuses of calls.
  integer(c_int32_t), parameter, public :: MOTET_OK = 0
  ! MOTET_ERROR_INTERNAL: a bug in motet; inputs are unchanged, free the handles that were to change
  integer(c_int32_t), parameter, public :: MOTET_ERROR_INTERNAL = 1
  ! MOTET_ERROR_OPTIONS: options without a meaning, a NULL, a count below 0
  integer(c_int32_t), parameter, public :: MOTET_ERROR_OPTIONS = 2
  ! MOTET_ERROR_INPUT: data that cannot be read, or that do not meet what the call requires
  integer(c_int32_t), parameter, public :: MOTET_ERROR_INPUT = 3
  ! MOTET_ERROR_IO: the operating system refused access to a file
  integer(c_int32_t), parameter, public :: MOTET_ERROR_IO = 4
  ! MOTET_ERROR_STOPPED: a watch stopped the call; inputs and handles are as before
  integer(c_int32_t), parameter, public :: MOTET_ERROR_STOPPED = 5

  ! Kinds of cells: VTK's numbers, with VTK's order of vertices. VTK's other kinds are accepted as well.
  integer(c_int32_t), parameter, public :: MOTET_VERTEX = 1
  integer(c_int32_t), parameter, public :: MOTET_LINE = 3
  integer(c_int32_t), parameter, public :: MOTET_TRIANGLE = 5
  integer(c_int32_t), parameter, public :: MOTET_QUAD = 9
  integer(c_int32_t), parameter, public :: MOTET_TETRA = 10
  integer(c_int32_t), parameter, public :: MOTET_HEXAHEDRON = 12
  integer(c_int32_t), parameter, public :: MOTET_WEDGE = 13
  integer(c_int32_t), parameter, public :: MOTET_PYRAMID = 14
  integer(c_int32_t), parameter, public :: MOTET_TETRA10 = 24

  ! What the rows of an array belong to.
  integer(c_int32_t), parameter, public :: MOTET_ON_POINTS = 0
  integer(c_int32_t), parameter, public :: MOTET_ON_CELLS = 1

  ! Methods of motion: `method` in options.
  ! MOTET_DELAUNAY: weights in the Delaunay graph of the boundary (Liu, Qin, Xia 2006): the cheapest
  integer(c_int32_t), parameter, public :: MOTET_DELAUNAY = 0
  ! MOTET_BODIES: rigid bodies carry the vertices around them: for parts that turn or shift far
  integer(c_int32_t), parameter, public :: MOTET_BODIES = 1
  ! MOTET_GUIDED: a graph with inner nodes and rotations: for walls that bend
  integer(c_int32_t), parameter, public :: MOTET_GUIDED = 2
  ! MOTET_ELASTIC: linear elasticity; for comparison
  integer(c_int32_t), parameter, public :: MOTET_ELASTIC = 3
  ! MOTET_LAPLACE: a Laplace equation; for comparison
  integer(c_int32_t), parameter, public :: MOTET_LAPLACE = 4
  ! MOTET_IDW: inverse-distance weighting; for comparison
  integer(c_int32_t), parameter, public :: MOTET_IDW = 5
  ! MOTET_RBF: radial basis functions; for comparison
  integer(c_int32_t), parameter, public :: MOTET_RBF = 6

  ! How an array is transferred from the old mesh to the new one.
  ! MOTET_RULE_MEAN: on points: interpolated; on cells: averaged by volume, so that integrals are kept
  integer(c_int32_t), parameter, public :: MOTET_RULE_MEAN = 0
  ! MOTET_RULE_INHERIT: the value of the old point or cell with the largest share
  integer(c_int32_t), parameter, public :: MOTET_RULE_INHERIT = 1
  ! MOTET_RULE_LINEAR: on points: linear in each old tet; on cells: as MOTET_RULE_MEAN
  integer(c_int32_t), parameter, public :: MOTET_RULE_LINEAR = 2

  ! What a repair may do to walls (boundary, interfaces, labelled facets): `surface` in options.
  ! MOTET_SURFACE_KEEP: walls are kept to the bit
  integer(c_int32_t), parameter, public :: MOTET_SURFACE_KEEP = 0
  ! MOTET_SURFACE_ADAPT: walls change within a distance; features are kept
  integer(c_int32_t), parameter, public :: MOTET_SURFACE_ADAPT = 1
  ! MOTET_SURFACE_LOOSE: walls change within a distance; features change as well where nothing else helps
  integer(c_int32_t), parameter, public :: MOTET_SURFACE_LOOSE = 2

  ! What becomes of the space inside a device: `inside` in options.
  ! MOTET_INSIDE_OWN: devices keep their tets; devices that are surfaces are filled
  integer(c_int32_t), parameter, public :: MOTET_INSIDE_OWN = 0
  ! MOTET_INSIDE_FILLED: all devices are filled with new tets
  integer(c_int32_t), parameter, public :: MOTET_INSIDE_FILLED = 1
  ! MOTET_INSIDE_HOLLOW: no tets: the surface of the device bounds the mesh
  integer(c_int32_t), parameter, public :: MOTET_INSIDE_HOLLOW = 2

  ! What of the host is refined before the implantation: `adapt` in options.
  ! MOTET_ADAPT_NO: nothing
  integer(c_int32_t), parameter, public :: MOTET_ADAPT_NO = 0
  ! MOTET_ADAPT_WALLS: walls near the devices
  integer(c_int32_t), parameter, public :: MOTET_ADAPT_WALLS = 1
  ! MOTET_ADAPT_ALL: all tets near the devices
  integer(c_int32_t), parameter, public :: MOTET_ADAPT_ALL = 2

  ! Whether a body is the wall of a room that contains other bodies: is_room of motet_contact_new.
  ! MOTET_ROOM_FOUND: a closed surface that encloses most of the area of another body is its room
  integer(c_int32_t), parameter, public :: MOTET_ROOM_FOUND = -1
  ! MOTET_ROOM_NO: a body, not a room
  integer(c_int32_t), parameter, public :: MOTET_ROOM_NO = 0
  ! MOTET_ROOM_YES: a room that contains the others
  integer(c_int32_t), parameter, public :: MOTET_ROOM_YES = 1

  ! Options of a mover. As C has them.
  type, bind(c) :: c_mover_options
    integer(c_size_t) :: size = 0
    integer(c_int32_t) :: method = MOTET_DELAUNAY
    integer(c_int32_t) :: within_walls = 0
    integer(c_int32_t) :: smooth = 0
    integer(c_int32_t) :: substeps = 50
    integer(c_int32_t) :: threads = 1
    integer(c_int32_t) :: rigid_layer_cells = 0
    real(c_double) :: rigid_layer = 0
    real(c_double) :: residual = 1e-6_c_double
    real(c_double) :: factor_gib = 0
    type(c_ptr) :: slide = c_null_ptr
    integer(c_int64_t) :: n_slide = 0
    type(c_ptr) :: bodies = c_null_ptr
    integer(c_int64_t) :: n_bodies = 0
    type(c_ptr) :: wall = c_null_ptr
    integer(c_int64_t) :: n_wall = 0
    type(c_ptr) :: also_moved = c_null_ptr
    integer(c_int64_t) :: n_also_moved = 0
    real(c_double) :: slide_tolerance = 0.05_c_double
    type(c_ptr) :: watched_by = c_null_ptr
  end type

  ! Options of a mover.
  type, public :: mover_options
    ! how vertices follow the boundary; default MOTET_DELAUNAY
    integer(c_int32_t) :: method = MOTET_DELAUNAY
    ! 1: no vertex follows the wall of another lumen or the far side of a flap; default 0
    integer(c_int32_t) :: within_walls = 0
    ! number of sweeps over the vertices of bad tets after each step; default 0
    integer(c_int32_t) :: smooth = 0
    ! largest number of sub-steps of an advance; default 50
    integer(c_int32_t) :: substeps = 50
    ! default 1
    integer(c_int32_t) :: threads = 1
    ! thickness of the rigid layer in cells: its vertices move rigidly with the wall; default 0: no layer
    integer(c_int32_t) :: rigid_layer_cells = 0
    ! thickness of the rigid layer as a distance; default 0: no layer
    real(c_double) :: rigid_layer = 0
    ! relative residual at which iterative solvers stop; default 1e-6
    real(c_double) :: residual = 1e-6_c_double
    ! gibibytes that a factor of the matrix may take to be kept; default 0
    real(c_double) :: factor_gib = 0
    ! names (or labels as text) of flat patches whose vertices slide in their plane; default none
    character(MOTET_NAME_LENGTH), allocatable :: slide(:)
    ! names of patches that are rigid bodies, for MOTET_BODIES; default none: every separate part of the moved
    ! walls but the outer one
    character(MOTET_NAME_LENGTH), allocatable :: bodies(:)
    ! names of patches that have the rigid layer; default none: all of the boundary that does not slide
    character(MOTET_NAME_LENGTH), allocatable :: wall(:)
    ! inner vertices that the caller moves as well; default none
    integer(c_int32_t), allocatable :: also_moved(:)
    ! largest distance of a vertex of a sliding patch from the plane of the patch, as a fraction of the radius
    ! of the patch; default 0.05
    real(c_double) :: slide_tolerance = 0.05_c_double
    ! tells the progress of calls and stops them; default NULL: nobody
    type(watch), pointer :: watched_by => null()
  end type

  ! What an advance reached.
  type, bind(c) :: certificate
    integer(c_size_t) :: size = 0
    ! 1: the whole motion was reached
    integer(c_int32_t) :: complete = 0
    ! number of sub-steps
    integer(c_int32_t) :: substeps = 0
    ! the fraction of the motion that was reached
    real(c_double) :: fraction = 0
    ! number of inverted or flat volume cells
    integer(c_int64_t) :: inverted = 0
    ! number of inverted or flat volume cells of the mesh at first
    integer(c_int64_t) :: inverted_before = 0
    ! number of tets with an EAS below 0.2
    integer(c_int64_t) :: bad = 0
    ! the tet with the worst EAS; -1 where there is none
    integer(c_int64_t) :: worst_cell = -1
    ! the EAS of worst_cell
    real(c_double) :: worst_eas = 0
    ! the centroid of worst_cell
    real(c_double) :: worst_place(3) = 0
    ! duration of the call
    real(c_double) :: seconds = 0
    ! the quadratic cell with the worst scaled Jacobian; -1 where there is none
    integer(c_int64_t) :: worst_curved_cell = -1
    ! a lower bound of the scaled Jacobian, 0 or less where the cell may be folded; NaN where there is none
    real(c_double) :: worst_curved_jacobian = 0
    ! the vertex on the rim of a sliding patch that the motion takes farthest out of the plane of the patch;
    ! -1 where none leaves it
    integer(c_int64_t) :: leaves_plane_vertex = -1
    ! distance of that vertex from the plane, in the unit of the mesh
    real(c_double) :: leaves_plane_distance = 0
  end type

  ! Options of a repair, which finds bad tets and repairs these only. As C has them.
  type, bind(c) :: c_remesh_options
    integer(c_size_t) :: size = 0
    real(c_double) :: min_eas = 0.2_c_double
    real(c_double) :: min_dihedral_deg = 0
    integer(c_int32_t) :: best = 0
    integer(c_int32_t) :: surface = MOTET_SURFACE_KEEP
    real(c_double) :: distance = 0
    integer(c_int32_t) :: repair_layers = 0
    integer(c_int32_t) :: rounds = 20
    integer(c_int32_t) :: threads = 0
    real(c_double) :: edge_length = 0
    type(c_ptr) :: sizes = c_null_ptr
    integer(c_int64_t) :: n_sizes = 0
    type(c_ptr) :: hold = c_null_ptr
    integer(c_int64_t) :: n_hold = 0
    type(c_ptr) :: watched_by = c_null_ptr
  end type

  ! Options of a repair, which finds bad tets and repairs these only.
  type, public :: remesh_options
    ! tets with a lower EAS are bad; default 0.2
    real(c_double) :: min_eas = 0.2_c_double
    ! tets with a smaller dihedral angle are bad as well, in degrees; default 0
    real(c_double) :: min_dihedral_deg = 0
    ! 1: all tets are improved, not the bad ones only; default 0
    integer(c_int32_t) :: best = 0
    ! what happens to walls; default MOTET_SURFACE_KEEP
    integer(c_int32_t) :: surface = MOTET_SURFACE_KEEP
    ! how far walls may stray; default 0: a thousandth of the largest extent
    real(c_double) :: distance = 0
    ! 1: thin tets of boundary layers are repaired as others are; default 0
    integer(c_int32_t) :: repair_layers = 0
    ! largest number of rounds; default 20
    integer(c_int32_t) :: rounds = 20
    ! default 0
    integer(c_int32_t) :: threads = 0
    ! requested length of all edges; default 0: edges keep their lengths
    real(c_double) :: edge_length = 0
    ! requested length of edges at each point; default NULL
    real(c_double), allocatable :: sizes(:)
    ! names (or labels as text) of regions and patches that are kept to the bit; default none
    character(MOTET_NAME_LENGTH), allocatable :: hold(:)
    ! tells the progress and stops the call; default NULL: nobody
    type(watch), pointer :: watched_by => null()
  end type

  ! Options of an implantation, which puts devices into a mesh of tets. As C has them.
  type, bind(c) :: c_implant_options
    integer(c_size_t) :: size = 0
    integer(c_int32_t) :: inside = MOTET_INSIDE_OWN
    integer(c_int32_t) :: conform = 0
    real(c_double) :: tolerance = 0
    integer(c_int32_t) :: keep_outside = 0
    integer(c_int32_t) :: adapt = MOTET_ADAPT_WALLS
    real(c_double) :: stray = -1.0_c_double
    real(c_double) :: edge_length = 0
    real(c_double) :: growth = 0.5_c_double
    real(c_double) :: carve = 1.0_c_double
    real(c_double) :: reach = 3.0_c_double
    real(c_double) :: min_eas = 0.2_c_double
    integer(c_int32_t) :: threads = 0
    type(c_ptr) :: watched_by = c_null_ptr
  end type

  ! Options of an implantation, which puts devices into a mesh of tets.
  type, public :: implant_options
    ! the space inside devices; default MOTET_INSIDE_OWN
    integer(c_int32_t) :: inside = MOTET_INSIDE_OWN
    ! 1: devices get a new surface near theirs, for surfaces that touch or cross themselves; default 0: every
    ! triangle is kept
    integer(c_int32_t) :: conform = 0
    ! with conform: largest distance of the new surface from that of the device; default 0: a fifth of the
    ! radius of a wire as thick as the device
    real(c_double) :: tolerance = 0
    ! 1: the parts of devices outside of the host are kept; default 0: they are cut off
    integer(c_int32_t) :: keep_outside = 0
    ! what is refined first; default MOTET_ADAPT_WALLS
    integer(c_int32_t) :: adapt = MOTET_ADAPT_WALLS
    ! how far surfaces may stray where a device meets a wall; default -1: a twentieth of the edge length of
    ! the device
    real(c_double) :: stray = -1.0_c_double
    ! length of edges beside the devices; default 0: as those of the devices
    real(c_double) :: edge_length = 0
    ! growth of lengths per unit of distance from the devices; default 0.5
    real(c_double) :: growth = 0.5_c_double
    ! tets nearer to a device than this number of edge lengths are replaced; default 1
    real(c_double) :: carve = 1.0_c_double
    ! tets farther than this number of edge lengths are kept to the bit; default 3
    real(c_double) :: reach = 3.0_c_double
    ! tets with a lower EAS are repaired; default 0.2
    real(c_double) :: min_eas = 0.2_c_double
    ! default 0
    integer(c_int32_t) :: threads = 0
    ! tells the progress and stops the call; default NULL: nobody
    type(watch), pointer :: watched_by => null()
  end type

  ! Options of filling, which makes tets inside closed surfaces. As C has them.
  type, bind(c) :: c_fill_options
    integer(c_size_t) :: size = 0
    real(c_double) :: edge_length = 0
    integer(c_int32_t) :: graded = 0
    real(c_double) :: growth = 0
    real(c_double) :: min_eas = 0
    integer(c_int32_t) :: layers = 0
    real(c_double) :: first_layer = 0
    real(c_double) :: layer_growth = 1.2_c_double
    integer(c_int32_t) :: keep_prisms = 0
    integer(c_int32_t) :: repair = 0
    integer(c_int32_t) :: threads = 0
    integer(c_int32_t) :: cut = 0
    integer(c_int32_t) :: voids = 0
    type(c_ptr) :: watched_by = c_null_ptr
    integer(c_int32_t) :: unite = 0
    real(c_double) :: wrap = 0
  end type

  ! Options of filling, which makes tets inside closed surfaces.
  type, public :: fill_options
    ! length of inner edges, the largest where sizes grow; default 0: only necessary points
    real(c_double) :: edge_length = 0
    ! 1: lengths are those of the surface and grow inwards; default 0
    integer(c_int32_t) :: graded = 0
    ! growth of lengths per unit of distance; default 0: 0.3
    real(c_double) :: growth = 0
    ! tets with a lower EAS are repaired; default 0: 0.2 with sizes, no repair without
    real(c_double) :: min_eas = 0
    ! number of thin layers on walls; default 0
    integer(c_int32_t) :: layers = 0
    ! thickness of the first layer
    real(c_double) :: first_layer = 0
    ! ratio of the thicknesses of a layer and the one before; default 1.2
    real(c_double) :: layer_growth = 1.2_c_double
    ! 1: layers are wedges and pyramids, not divided into tets; default 0
    integer(c_int32_t) :: keep_prisms = 0
    ! 1: T-junctions, coincident faces, duplicates, orientation and small holes are repaired first; default 0
    integer(c_int32_t) :: repair = 0
    ! default 0
    integer(c_int32_t) :: threads = 0
    ! 1: surfaces that cross are divided along their intersection; default 0
    integer(c_int32_t) :: cut = 0
    ! 1: spaces inside closed surfaces that are turned inward stay empty; default 0
    integer(c_int32_t) :: voids = 0
    ! tells the progress and stops the call; default NULL: nobody
    type(watch), pointer :: watched_by => null()
    ! 1: bodies that cross, touch or lie on each other become one, without what lies inside; default 0
    integer(c_int32_t) :: unite = 0
    ! the surfaces are replaced by a closed one within this distance, around what they enclose: they may be
    ! open, torn and cross; default 0: they are not
    real(c_double) :: wrap = 0
  end type

  ! Options of a refinement. As C has them.
  type, bind(c) :: c_refinement_options
    integer(c_size_t) :: size = 0
    integer(c_int32_t) :: threads = 0
    type(c_ptr) :: watched_by = c_null_ptr
  end type

  ! Options of a refinement.
  type, public :: refinement_options
    ! default 0
    integer(c_int32_t) :: threads = 0
    ! tells the progress of calls and stops them; default NULL: nobody
    type(watch), pointer :: watched_by => null()
  end type

  ! Options of contact. As C has them.
  type, bind(c) :: c_contact_options
    integer(c_size_t) :: size = 0
    real(c_double) :: warn = 0
    real(c_double) :: within = 0
    real(c_double) :: fold = 3.0_c_double
    integer(c_int32_t) :: own = 0
    integer(c_int32_t) :: facing = 0
    integer(c_int32_t) :: threads = 0
  end type

  ! Options of contact.
  type, public :: contact_options
    ! vertices with a smaller gap warn; default 0: none
    real(c_double) :: warn = 0
    ! largest distance that is searched; default 0: no limit
    real(c_double) :: within = 0
    ! two places of one surface are neighbours, without a gap, if the way along the surface is shorter than
    ! this many times the straight distance; default 3
    real(c_double) :: fold = 3.0_c_double
    ! 1: each surface is measured against itself as well; default 0
    integer(c_int32_t) :: own = 0
    ! 1: only surfaces that face each other through free space; default 0
    integer(c_int32_t) :: facing = 0
    ! default 0
    integer(c_int32_t) :: threads = 0
  end type

  ! Options of a moving mesh. As C has them.
  type, bind(c) :: c_moving_options
    integer(c_size_t) :: size = 0
    integer(c_int32_t) :: method = MOTET_DELAUNAY
    integer(c_int32_t) :: within_walls = 0
    integer(c_int32_t) :: smooth = 0
    integer(c_int32_t) :: rigid_layer_cells = 0
    real(c_double) :: rigid_layer = 0
    type(c_ptr) :: inside = c_null_ptr
    integer(c_int64_t) :: n_inside = 0
    type(c_ptr) :: slide = c_null_ptr
    integer(c_int64_t) :: n_slide = 0
    type(c_ptr) :: bodies = c_null_ptr
    integer(c_int64_t) :: n_bodies = 0
    type(c_ptr) :: wall = c_null_ptr
    integer(c_int64_t) :: n_wall = 0
    integer(c_int32_t) :: no_repair = 0
    integer(c_int32_t) :: surface = MOTET_SURFACE_KEEP
    real(c_double) :: distance = 0
    real(c_double) :: min_eas = 0.2_c_double
    real(c_double) :: margin = 0.05_c_double
    real(c_double) :: floor = 0.05_c_double
    real(c_double) :: improve_below = 0.75_c_double
    type(c_ptr) :: contents = c_null_ptr
    integer(c_int64_t) :: n_contents = 0
    type(c_ptr) :: watch = c_null_ptr
    integer(c_int64_t) :: n_watch = 0
    real(c_double) :: warn = 0
    real(c_double) :: within = 0
    real(c_double) :: horizon = 0
    real(c_double) :: hold = 0
    integer(c_int32_t) :: remembered = 64
    integer(c_int32_t) :: threads = 0
    type(c_ptr) :: hold_names = c_null_ptr
    integer(c_int64_t) :: n_hold_names = 0
    real(c_double) :: slide_tolerance = 0.05_c_double
    integer(c_int32_t) :: valid_at_start = 0
    integer(c_int32_t) :: strain_in_band = 0
    integer(c_int32_t) :: returns = 0
    type(c_ptr) :: watched_by = c_null_ptr
  end type

  ! Options of a moving mesh.
  type, public :: moving_options
    ! how vertices follow the walls; default MOTET_DELAUNAY
    integer(c_int32_t) :: method = MOTET_DELAUNAY
    ! 1: no vertex follows the wall of another lumen or the far side of a flap; default 0
    integer(c_int32_t) :: within_walls = 0
    ! number of sweeps over the vertices of bad tets after each step; default 0
    integer(c_int32_t) :: smooth = 0
    ! thickness of the rigid layer in cells; default 0: no layer
    integer(c_int32_t) :: rigid_layer_cells = 0
    ! thickness of the rigid layer as a distance; default 0: no layer
    real(c_double) :: rigid_layer = 0
    ! names (or labels as text) of patches inside the volume that are driven, such as a flap; default none
    character(MOTET_NAME_LENGTH), allocatable :: inside(:)
    ! names of flat patches whose vertices slide in their plane; default none
    character(MOTET_NAME_LENGTH), allocatable :: slide(:)
    ! names of patches that are rigid bodies, for MOTET_BODIES; default none: every separate part of the moved
    ! walls but the outer one
    character(MOTET_NAME_LENGTH), allocatable :: bodies(:)
    ! names of patches that have the rigid layer; default none: all of the boundary that does not slide
    character(MOTET_NAME_LENGTH), allocatable :: wall(:)
    ! 1: nothing is repaired, and a step stops before a cell is inverted; default 0
    integer(c_int32_t) :: no_repair = 0
    ! what a repair does to walls; default MOTET_SURFACE_KEEP
    integer(c_int32_t) :: surface = MOTET_SURFACE_KEEP
    ! how far walls may stray; default 0: a thousandth of the largest extent
    real(c_double) :: distance = 0
    ! tets with a lower EAS are bad; default 0.2
    real(c_double) :: min_eas = 0.2_c_double
    ! a repair aims at an EAS of min_eas plus this; default 0.05
    real(c_double) :: margin = 0.05_c_double
    ! no step takes a tet that can be repaired below this EAS; default 0.05
    real(c_double) :: floor = 0.05_c_double
    ! where a repair changes the mesh, tets with a lower EAS are improved as well and the number of vertices
    ! is kept; 0: only bad tets change; default 0.75
    real(c_double) :: improve_below = 0.75_c_double
    ! names of cell arrays that are densities of something that stays in its cell: their integrals are kept;
    ! default none
    character(MOTET_NAME_LENGTH), allocatable :: contents(:)
    ! names of patches whose gaps are measured at each step; default none
    character(MOTET_NAME_LENGTH), allocatable :: watch(:)
    ! vertices with a smaller gap warn; default 0: none
    real(c_double) :: warn = 0
    ! largest distance that is searched; default 0: no limit
    real(c_double) :: within = 0
    ! how far contact is predicted, in units of time; default 0: the duration of the last step
    real(c_double) :: horizon = 0
    ! walls stop at this distance from each other, whatever displacement is requested; each watched patch
    ! gives way to those listed after it; default 0: they do not stop
    real(c_double) :: hold = 0
    ! number of changes that are kept for motet_moving_since; default 64
    integer(c_int32_t) :: remembered = 64
    ! default 0
    integer(c_int32_t) :: threads = 0
    ! names of regions and patches that a repair keeps to the bit; default none
    character(MOTET_NAME_LENGTH), allocatable :: hold_names(:)
    ! largest distance of a vertex of a sliding patch from the plane of the patch, as a fraction of the radius
    ! of the patch; default 0.05
    real(c_double) :: slide_tolerance = 0.05_c_double
    ! 1: new tets must have a volume also where their vertices were at the start of the step; a repair that
    ! inserts others is repeated with the replaced tets held; default 0
    integer(c_int32_t) :: valid_at_start = 0
    ! 1: with MOTET_BODIES a band beside the bodies takes the strain, for bodies that go on in one direction;
    ! default 0: the strain is spread over all of the volume
    integer(c_int32_t) :: strain_in_band = 0
    ! 1: the walls return to their first places again and again: tets are improved to be good there as well,
    ! and a mesh that does not settle is replaced by the first mesh when the walls are back; default 0
    integer(c_int32_t) :: returns = 0
    ! tells the progress of calls and stops them; default NULL: nobody
    type(watch), pointer :: watched_by => null()
  end type

  ! The result of a step.
  type, bind(c) :: moving_step
    integer(c_size_t) :: size = 0
    ! number of the step, from 1
    integer(c_int64_t) :: step = 0
    ! the time that was reached
    real(c_double) :: time = 0
    ! 1: the walls reached the requested displacement
    integer(c_int32_t) :: complete = 0
    ! number of parts in which the step was made
    integer(c_int32_t) :: legs = 0
    ! the fraction of the motion that was reached
    real(c_double) :: fraction = 0
    ! number of changes of connectivity; above 0, points and cells are numbered anew
    integer(c_int64_t) :: changes = 0
    ! number of points of the mesh
    integer(c_int64_t) :: points = 0
    ! number of tets of the mesh
    integer(c_int64_t) :: tets = 0
    ! number of tets with an EAS below the limit
    integer(c_int64_t) :: bad = 0
    ! number of bad tets that are as good as the walls at them allow
    integer(c_int64_t) :: forced = 0
    ! number of flat or inverted tets
    integer(c_int64_t) :: inverted = 0
    ! the tet with the worst EAS; -1 where there is none
    integer(c_int64_t) :: worst_cell = -1
    ! the EAS of worst_cell
    real(c_double) :: worst_eas = 0
    ! the centroid of worst_cell
    real(c_double) :: worst_place(3) = 0
    ! the least gap of the watched patches; infinite where nothing is within reach, or no patch is watched
    real(c_double) :: gap = 0
    ! number of vertices that warn
    integer(c_int64_t) :: warned = 0
    ! number of driven vertices that were stopped before another patch
    integer(c_int64_t) :: held = 0
    ! a time before which nothing touches at the velocities of this step; infinite where nothing touches
    ! within the horizon
    real(c_double) :: touch_not_before = 0
    ! duration of the call
    real(c_double) :: seconds = 0
  end type

  ! Texts as C takes them: each ends with c_null_char.
  type :: texts
    character(kind=c_char), allocatable :: letters(:)
    type(c_ptr), allocatable :: places(:)
  end type

  abstract interface
    ! Is told the progress: what is being done (empty at first), how much of it is done, and how much there is to
    ! do, 0 where that is unknown. Returns .true. to stop the watched call. It must not use the objects of that
    ! call.
    function progress(stage, done, of) result(stops)
      import
      character(*), intent(in) :: stage
      integer(c_int64_t), intent(in) :: done, of
      logical :: stops
    end function
  end interface

  type :: listener
    procedure(progress), pointer, nopass :: tell => null()
  end type

  ! Tells the progress of long calls and stops them; see motet_watch in motet.h. `new` takes the function that is
  ! told the progress (without one, nobody is told) and the seconds between two calls of it (0.05 by default).
  type, public :: watch
    private
    type(c_ptr) :: handle = c_null_ptr
    type(listener), pointer :: told => null()
  contains
    procedure :: new => watch_new
    procedure :: stop => watch_stop
    procedure :: progress => watch_progress
    procedure :: free => watch_free
    final :: watch_final
  end type

  type, public :: mesh
    private
    type(c_ptr) :: handle = c_null_ptr
  contains
    procedure :: new => mesh_new
    procedure :: read => mesh_read
    procedure :: write => mesh_write
    procedure :: add_cells => mesh_add_cells
    procedure :: set_points => mesh_set_points
    procedure :: set_labels => mesh_set_labels
    procedure :: name_region => mesh_name_region
    procedure :: name_patch => mesh_name_patch
    procedure :: set_array => mesh_set_array
    procedure :: array => mesh_array
    procedure :: n_points => mesh_n_points
    procedure :: n_cells => mesh_n_cells
    procedure :: n_of_kind => mesh_n_of_kind
    procedure :: points => mesh_points
    procedure :: of_kind => mesh_of_kind
    procedure :: eas => mesh_eas
    procedure :: labels => mesh_labels
    procedure :: region => mesh_region
    procedure :: patch => mesh_patch
    procedure :: patch_vertices => mesh_patch_vertices
    procedure :: free => mesh_free
    final :: mesh_final
  end type

  type, public :: mover
    private
    type(c_ptr) :: handle = c_null_ptr
  contains
    procedure :: new => mover_new
    procedure :: n_points => mover_n_points
    procedure :: n_boundary => mover_n_boundary
    procedure :: boundary => mover_boundary
    procedure :: step => mover_step
    procedure :: advance => mover_advance
    procedure :: free => mover_free
    final :: mover_final
  end type

  ! Moves points with nodes, without a mesh.
  type, public :: point_mover
    private
    type(c_ptr) :: handle = c_null_ptr
  contains
    procedure :: new => point_mover_new
    procedure :: step => point_mover_step
    procedure :: free => point_mover_free
    final :: point_mover_final
  end type

  ! The result of `remesh`, `implant` and `fill`; `mesh` copies the new mesh.
  type, public :: outcome
    private
    type(c_ptr) :: handle = c_null_ptr
  contains
    procedure :: remesh => outcome_remesh
    procedure :: implant => outcome_implant
    procedure :: fill => outcome_fill
    procedure :: complete => outcome_complete
    procedure :: mesh => outcome_mesh
    procedure :: to_old => outcome_to_old
    procedure :: transfer => outcome_transfer
    procedure :: free => outcome_free
    final :: outcome_final
  end type

  ! A mesh whose tets are divided over many steps, and whose divisions are taken back; `mesh` copies the current
  ! mesh.
  type, public :: refinement
    private
    type(c_ptr) :: handle = c_null_ptr
  contains
    procedure :: new => refinement_new
    procedure :: mesh => refinement_mesh
    procedure :: generations => refinement_generations
    procedure :: divide => refinement_divide
    procedure :: coarsen => refinement_coarsen
    procedure :: near => refinement_near
    procedure :: free => refinement_free
    final :: refinement_final
  end type

  type, public :: contact
    private
    type(c_ptr) :: handle = c_null_ptr
  contains
    procedure :: new => contact_new
    procedure :: refit => contact_refit
    procedure :: measure => contact_measure
    procedure :: free => contact_free
    final :: contact_final
  end type

  ! A mesh that moves with its walls and stays good; `mesh` copies the current mesh.
  type, public :: moving_mesh
    private
    type(c_ptr) :: handle = c_null_ptr
  contains
    procedure :: new => moving_new
    procedure :: save => moving_save
    procedure :: load => moving_load
    procedure :: n_driven => moving_n_driven
    procedure :: driven_places => moving_driven_places
    procedure :: time => moving_time
    procedure :: mesh => moving_mesh_copy
    procedure :: velocity => moving_velocity
    procedure :: displacement => moving_displacement
    procedure :: set_array => moving_set_array
    procedure :: advance => moving_advance
    procedure :: repair => moving_repair
    procedure :: refine_near => moving_refine_near
    procedure :: refine_gaps => moving_refine_gaps
    procedure :: since => moving_since
    procedure :: free => moving_free
    final :: moving_final
  end type

  abstract interface
    ! Is told the progress: what is being done (empty at first; valid during this call only), how much of it
    ! is done, and how much there is to do as far as is known by now, 0 where that is unknown. A stage may
    ! occur more than once. Returns 0 to go on, another number to stop the watched call. It must not return by
    ! longjmp or an exception, nor use the handles of the watched call.
    function c_progress(data, stage, done, of) bind(c)
      import
      type(c_ptr), value :: data
      character(kind=c_char), intent(in) :: stage(*)
      integer(c_int64_t), value :: done, of
      integer(c_int32_t) :: c_progress
    end function
  end interface

  interface
    ! The version of the linked library: major * 10000 + minor * 100 + patch.
    function c_version() bind(c, name='motet_version')
      import
      integer(c_int32_t) :: c_version
    end function
    ! The status of the call that returned the error; MOTET_OK for NULL.
    function c_error_status(error) bind(c, name='motet_error_status')
      import
      type(c_ptr), value :: error
      integer(c_int32_t) :: c_error_status
    end function
    ! The whole error in one sentence or two: the four parts below together.
    function c_error_message(error) bind(c, name='motet_error_message')
      import
      type(c_ptr), value :: error
      type(c_ptr) :: c_error_message
    end function
    ! What was expected and what was found.
    function c_error_what(error) bind(c, name='motet_error_what')
      import
      type(c_ptr), value :: error
      type(c_ptr) :: c_error_what
    end function
    ! The file that the error is in; NULL for errors that are in no file.
    function c_error_file(error) bind(c, name='motet_error_file')
      import
      type(c_ptr), value :: error
      type(c_ptr) :: c_error_file
    end function
    ! The place in the file or in the mesh; NULL where there is none.
    function c_error_place(error) bind(c, name='motet_error_place')
      import
      type(c_ptr), value :: error
      type(c_ptr) :: c_error_place
    end function
    ! What can be done about the error; NULL where nothing is known.
    function c_error_remedy(error) bind(c, name='motet_error_remedy')
      import
      type(c_ptr), value :: error
      type(c_ptr) :: c_error_remedy
    end function
    subroutine c_error_free(error) bind(c, name='motet_error_free')
      import
      type(c_ptr), value :: error
    end subroutine
    ! Creates a watch that tells nobody.
    function c_watch_new(watch, error) bind(c, name='motet_watch_new')
      import
      type(c_ptr), intent(inout) :: watch, error
      integer(c_int32_t) :: c_watch_new
    end function
    ! Frees a watch that watches no call at the time. Handles made with it remain usable; nobody watches them
    ! any longer.
    subroutine c_watch_free(watch) bind(c, name='motet_watch_free')
      import
      type(c_ptr), value :: watch
    end subroutine
    ! Sets the function that is told the progress, on the thread that makes the watched call, every `every`
    ! seconds while the call runs (0: 0.05), whether or not there is progress; the work goes on meanwhile, on
    ! another thread. NULL for none: the call works on the thread of the caller. `data` is passed on to the
    ! function. Has an effect on later calls.
    function c_watch_on_progress(watch, tell, data, every, error) bind(c, name='motet_watch_on_progress')
      import
      type(c_ptr), value :: watch
      type(c_funptr), value :: tell
      type(c_ptr), value :: data
      real(c_double), value :: every
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_watch_on_progress
    end function
    ! Stops the watched call soon, or the next one if none is running: it returns MOTET_ERROR_STOPPED, and the
    ! request is used up. May be called from any thread, from the function that is told the progress, and by a
    ! handler of signals.
    subroutine c_watch_stop(watch) bind(c, name='motet_watch_stop')
      import
      type(c_ptr), value :: watch
    end subroutine
    ! Copies the progress of the watched call, or of the last one, from any thread. `stage` receives up to n
    ! bytes with the zero at the end; 64 are enough for all stages. `done` and `of` are as those of
    ! motet_progress; they may be NULL.
    function c_watch_progress(watch, stage, n, done, of, error) bind(c, name='motet_watch_progress')
      import
      type(c_ptr), value :: watch
      character(kind=c_char), intent(inout) :: stage(*)
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(out) :: done, of
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_watch_progress
    end function
    ! Creates a mesh of n points and no cells.
    function c_mesh_new(points, n, stride, mesh, error) bind(c, name='motet_mesh_new')
      import
      real(c_double), intent(in) :: points(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr), intent(inout) :: mesh, error
      integer(c_int32_t) :: c_mesh_new
    end function
    ! Appends n cells of one kind; `vertices` lists the vertices of each cell, cell after cell. All ids are
    ! checked: on an error no cell is appended.
    function c_mesh_add_cells(mesh, kind, vertices, n, error) bind(c, name='motet_mesh_add_cells')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: kind
      integer(c_int32_t), intent(in) :: vertices(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_add_cells
    end function
    ! Sets the labels of all n cells, in their order: regions of volume cells, patches of surface cells; 0 for
    ! none.
    function c_mesh_set_labels(mesh, labels, n, error) bind(c, name='motet_mesh_set_labels')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), intent(in) :: labels(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_set_labels
    end function
    ! Names the region that has a label.
    function c_mesh_name_region(mesh, label, name, error) bind(c, name='motet_mesh_name_region')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: label
      character(kind=c_char), intent(in) :: name(*)
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_name_region
    end function
    ! Names the patch that has a label.
    function c_mesh_name_patch(mesh, label, name, error) bind(c, name='motet_mesh_name_patch')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: label
      character(kind=c_char), intent(in) :: name(*)
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_name_patch
    end function
    ! Sets an array of n rows with `components` contiguous values each, on points or on cells; replaces an
    ! array of the same name.
    function c_mesh_set_array(mesh, on, name, values, n, components, error) &
        bind(c, name='motet_mesh_set_array')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: on
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: values(*)
      integer(c_int64_t), value :: n
      integer(c_int32_t), value :: components
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_set_array
    end function
    ! Moves all n points.
    function c_mesh_set_points(mesh, points, n, stride, error) bind(c, name='motet_mesh_set_points')
      import
      type(c_ptr), value :: mesh
      real(c_double), intent(in) :: points(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_set_points
    end function
    ! Reads a file; its suffix states the format.
    function c_mesh_read(path, mesh, error) bind(c, name='motet_mesh_read')
      import
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(inout) :: mesh, error
      integer(c_int32_t) :: c_mesh_read
    end function
    ! Writes a file; its suffix states the format.
    function c_mesh_write(mesh, path, error) bind(c, name='motet_mesh_write')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_write
    end function
    ! The characters of a text, terminated by zero.
    function c_text_get(text) bind(c, name='motet_text_get')
      import
      type(c_ptr), value :: text
      type(c_ptr) :: c_text_get
    end function
    subroutine c_text_free(text) bind(c, name='motet_text_free')
      import
      type(c_ptr), value :: text
    end subroutine
    ! Reads a file and says what of it is not used, a sentence a line; NULL where all is.
    function c_mesh_read_noted(path, mesh, notes, error) bind(c, name='motet_mesh_read_noted')
      import
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(inout) :: mesh, notes, error
      integer(c_int32_t) :: c_mesh_read_noted
    end function
    ! Writes a file and says what the format cannot hold, a sentence a line; NULL where it holds all.
    function c_mesh_write_noted(mesh, path, lost, error) bind(c, name='motet_mesh_write_noted')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(inout) :: lost, error
      integer(c_int32_t) :: c_mesh_write_noted
    end function
    ! Copies a mesh with its arrays and names.
    function c_mesh_copy(mesh, copy, error) bind(c, name='motet_mesh_copy')
      import
      type(c_ptr), value :: mesh
      type(c_ptr), intent(inout) :: copy, error
      integer(c_int32_t) :: c_mesh_copy
    end function
    subroutine c_mesh_free(mesh) bind(c, name='motet_mesh_free')
      import
      type(c_ptr), value :: mesh
    end subroutine
    ! The number of points.
    function c_mesh_n_points(mesh) bind(c, name='motet_mesh_n_points')
      import
      type(c_ptr), value :: mesh
      integer(c_int64_t) :: c_mesh_n_points
    end function
    ! The number of cells of all kinds.
    function c_mesh_n_cells(mesh) bind(c, name='motet_mesh_n_cells')
      import
      type(c_ptr), value :: mesh
      integer(c_int64_t) :: c_mesh_n_cells
    end function
    ! The number of cells of one kind.
    function c_mesh_n_of_kind(mesh, kind) bind(c, name='motet_mesh_n_of_kind')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: kind
      integer(c_int64_t) :: c_mesh_n_of_kind
    end function
    ! The sum of the numbers of vertices of all cells.
    function c_mesh_n_vertices_of_cells(mesh) bind(c, name='motet_mesh_n_vertices_of_cells')
      import
      type(c_ptr), value :: mesh
      integer(c_int64_t) :: c_mesh_n_vertices_of_cells
    end function
    ! Copies the coordinates of all n points.
    function c_mesh_points(mesh, points, n, stride, error) bind(c, name='motet_mesh_points')
      import
      type(c_ptr), value :: mesh
      real(c_double), intent(inout) :: points(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_points
    end function
    ! Copies the vertices of all cells of one kind, cell after cell; n is the number of these cells times the
    ! number of vertices of each.
    function c_mesh_of_kind(mesh, kind, vertices, n, error) bind(c, name='motet_mesh_of_kind')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: kind
      integer(c_int32_t), intent(inout) :: vertices(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_of_kind
    end function
    ! Copies all cells in their order: the kind of each; where the vertices of each begin in `vertices`, and
    ! the end of the last (n_cells + 1 offsets); the vertices of all cells.
    function c_mesh_cells(mesh, kinds, n_cells, offsets, vertices, n_vertices, error) &
        bind(c, name='motet_mesh_cells')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), intent(inout) :: kinds(*)
      integer(c_int64_t), value :: n_cells
      integer(c_int64_t), intent(inout) :: offsets(*)
      integer(c_int32_t), intent(inout) :: vertices(*)
      integer(c_int64_t), value :: n_vertices
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_cells
    end function
    ! Copies the labels of all n cells; 0 for cells without a label.
    function c_mesh_labels(mesh, labels, n, error) bind(c, name='motet_mesh_labels')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), intent(inout) :: labels(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_labels
    end function
    ! The label of a region by its name; -1 where no region has that name.
    function c_mesh_region(mesh, name) bind(c, name='motet_mesh_region')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int32_t) :: c_mesh_region
    end function
    ! The label of a patch by its name; -1 where no patch has that name.
    function c_mesh_patch(mesh, name) bind(c, name='motet_mesh_patch')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int32_t) :: c_mesh_patch
    end function
    ! The number of vertices of a patch, by its name or its label as text; -1 where there is no such patch.
    function c_mesh_n_patch_vertices(mesh, name) bind(c, name='motet_mesh_n_patch_vertices')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int64_t) :: c_mesh_n_patch_vertices
    end function
    ! Copies the n vertices of a patch in ascending order, by its name or its label as text.
    function c_mesh_patch_vertices(mesh, name, vertices, n, error) bind(c, name='motet_mesh_patch_vertices')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int32_t), intent(inout) :: vertices(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_patch_vertices
    end function
    ! The number of components of an array; 0 where no array of numbers has that name.
    function c_mesh_array_components(mesh, on, name) bind(c, name='motet_mesh_array_components')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: on
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int32_t) :: c_mesh_array_components
    end function
    ! Copies an array: n rows with all components, row after row.
    function c_mesh_array(mesh, on, name, values, n, error) bind(c, name='motet_mesh_array')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: on
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(inout) :: values(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_array
    end function
    ! Computes the equi-angle quality (EAS) of each of the n cells: 1 regular, 0 flat, negative inverted, bad
    ! below 0.2; NaN for cells that are not tets.
    function c_mesh_eas(mesh, eas, n, error) bind(c, name='motet_mesh_eas')
      import
      type(c_ptr), value :: mesh
      real(c_double), intent(inout) :: eas(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mesh_eas
    end function
    ! Writes counts, bounds, volumes, quality and defects as one JSON object, the one of `motet info --json`.
    function c_mesh_summary(mesh, summary, error) bind(c, name='motet_mesh_summary')
      import
      type(c_ptr), value :: mesh
      type(c_ptr), intent(inout) :: summary, error
      integer(c_int32_t) :: c_mesh_summary
    end function
    ! Sets all members to their defaults; `size` is sizeof(motet_mover_options).
    subroutine c_mover_options_init(options, size) bind(c, name='motet_mover_options_init')
      import
      type(c_mover_options), intent(inout) :: options
      integer(c_size_t), value :: size
    end subroutine
    ! Sets up the motion of a mesh; the mesh may be freed afterwards. NULL for options: the defaults.
    function c_mover_new(mesh, options, mover, error) bind(c, name='motet_mover_new')
      import
      type(c_ptr), value :: mesh
      type(c_mover_options), intent(in) :: options
      type(c_ptr), intent(inout) :: mover, error
      integer(c_int32_t) :: c_mover_new
    end function
    subroutine c_mover_free(mover) bind(c, name='motet_mover_free')
      import
      type(c_ptr), value :: mover
    end subroutine
    ! The number of points of the mesh.
    function c_mover_n_points(mover) bind(c, name='motet_mover_n_points')
      import
      type(c_ptr), value :: mover
      integer(c_int64_t) :: c_mover_n_points
    end function
    ! The number of vertices that the caller moves: those of the boundary, and also_moved.
    function c_mover_n_boundary(mover) bind(c, name='motet_mover_n_boundary')
      import
      type(c_ptr), value :: mover
      integer(c_int64_t) :: c_mover_n_boundary
    end function
    ! Copies the n vertices that the caller moves, in ascending order.
    function c_mover_boundary(mover, vertices, n, error) bind(c, name='motet_mover_boundary')
      import
      type(c_ptr), value :: mover
      integer(c_int32_t), intent(inout) :: vertices(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mover_boundary
    end function
    ! Returns the four vertices that a vertex follows and their weights; is_hanging is 0, and both arrays
    ! unchanged, for a vertex that follows something else.
    function c_mover_weights(mover, vertex, vertices, weights, is_hanging, error) &
        bind(c, name='motet_mover_weights')
      import
      type(c_ptr), value :: mover
      integer(c_int32_t), value :: vertex
      integer(c_int32_t), intent(inout) :: vertices(4)
      real(c_double), intent(inout) :: weights(4)
      integer(c_int32_t), intent(out) :: is_hanging
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mover_weights
    end function
    ! Moves the mesh from its first place. `displacement` has a row for each moved vertex, `points` receives
    ! the place of every vertex. Only the counts are checked, and that displacements are finite. The result
    ! depends on the displacement only, not on earlier steps.
    function c_mover_step(mover, displacement, n_boundary, displacement_stride, points, n_points, &
        points_stride, error) bind(c, name='motet_mover_step')
      import
      type(c_ptr), value :: mover
      real(c_double), intent(in) :: displacement(*)
      integer(c_int64_t), value :: n_boundary, displacement_stride
      real(c_double), intent(inout) :: points(*)
      integer(c_int64_t), value :: n_points, points_stride
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mover_step
    end function
    ! Sets all members to those of an empty certificate; `size` is sizeof(motet_certificate).
    subroutine c_certificate_init(certificate_, size) bind(c, name='motet_certificate_init')
      import
      type(certificate), intent(inout) :: certificate_
      integer(c_size_t), value :: size
    end subroutine
    ! Moves the mesh from its first place, in sub-steps where necessary: no cell that was not inverted at
    ! first is inverted at the end. `displacement` and `points` are as those of motet_mover_step. A motion
    ! that is reached in part only is no error. `certificate` may be NULL.
    function c_mover_advance(mover, displacement, n_boundary, displacement_stride, points, n_points, &
        points_stride, certificate_, error) bind(c, name='motet_mover_advance')
      import
      type(c_ptr), value :: mover
      real(c_double), intent(in) :: displacement(*)
      integer(c_int64_t), value :: n_boundary, displacement_stride
      real(c_double), intent(inout) :: points(*)
      integer(c_int64_t), value :: n_points, points_stride
      type(certificate), intent(inout) :: certificate_
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_mover_advance
    end function
    ! Sets up the motion of points with nodes.
    function c_point_mover_new(nodes, n_nodes, node_stride, points, n_points, point_stride, threads, mover, &
        error) bind(c, name='motet_point_mover_new')
      import
      real(c_double), intent(in) :: nodes(*)
      integer(c_int64_t), value :: n_nodes, node_stride
      real(c_double), intent(in) :: points(*)
      integer(c_int64_t), value :: n_points, point_stride
      integer(c_int32_t), value :: threads
      type(c_ptr), intent(inout) :: mover, error
      integer(c_int32_t) :: c_point_mover_new
    end function
    subroutine c_point_mover_free(mover) bind(c, name='motet_point_mover_free')
      import
      type(c_ptr), value :: mover
    end subroutine
    ! Moves the points from their first places. `displacement` has a row for each node, `points` receives the
    ! places. Of several nodes at one place, the displacement of the first counts.
    function c_point_mover_step(mover, displacement, n_nodes, displacement_stride, points, n_points, &
        points_stride, error) bind(c, name='motet_point_mover_step')
      import
      type(c_ptr), value :: mover
      real(c_double), intent(in) :: displacement(*)
      integer(c_int64_t), value :: n_nodes, displacement_stride
      real(c_double), intent(inout) :: points(*)
      integer(c_int64_t), value :: n_points, points_stride
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_point_mover_step
    end function
    ! 1: the requested result was reached.
    function c_outcome_complete(outcome) bind(c, name='motet_outcome_complete')
      import
      type(c_ptr), value :: outcome
      integer(c_int32_t) :: c_outcome_complete
    end function
    ! The new mesh; belongs to the outcome.
    function c_outcome_mesh(outcome) bind(c, name='motet_outcome_mesh')
      import
      type(c_ptr), value :: outcome
      type(c_ptr) :: c_outcome_mesh
    end function
    ! The report as one JSON object; belongs to the outcome.
    function c_outcome_report(outcome) bind(c, name='motet_outcome_report')
      import
      type(c_ptr), value :: outcome
      type(c_ptr) :: c_outcome_report
    end function
    ! Why the requested result was not reached; NULL where it was. Belongs to the outcome.
    function c_outcome_not_reached(outcome) bind(c, name='motet_outcome_not_reached')
      import
      type(c_ptr), value :: outcome
      type(c_ptr) :: c_outcome_not_reached
    end function
    ! For each of the n new points or cells: the old one that it equals to the bit; -1 for those that are new.
    function c_outcome_to_old(outcome, on, old, n, error) bind(c, name='motet_outcome_to_old')
      import
      type(c_ptr), value :: outcome
      integer(c_int32_t), value :: on
      integer(c_int32_t), intent(inout) :: old(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_outcome_to_old
    end function
    ! Transfers an array of the old mesh, n rows with `components` values each, to the n_out points or cells
    ! of the new mesh.
    function c_outcome_transfer(outcome, on, rule, values, n, components, out, n_out, error) &
        bind(c, name='motet_outcome_transfer')
      import
      type(c_ptr), value :: outcome
      integer(c_int32_t), value :: on, rule
      real(c_double), intent(in) :: values(*)
      integer(c_int64_t), value :: n
      integer(c_int32_t), value :: components
      real(c_double), intent(inout) :: out(*)
      integer(c_int64_t), value :: n_out
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_outcome_transfer
    end function
    subroutine c_outcome_free(outcome) bind(c, name='motet_outcome_free')
      import
      type(c_ptr), value :: outcome
    end subroutine
    ! Sets all members to their defaults; `size` is sizeof(motet_remesh_options).
    subroutine c_remesh_options_init(options, size) bind(c, name='motet_remesh_options_init')
      import
      type(c_remesh_options), intent(inout) :: options
      integer(c_size_t), value :: size
    end subroutine
    ! Repairs the bad tets of a mesh. NULL for options: the defaults.
    function c_remesh(mesh, options, outcome, error) bind(c, name='motet_remesh')
      import
      type(c_ptr), value :: mesh
      type(c_remesh_options), intent(in) :: options
      type(c_ptr), intent(inout) :: outcome, error
      integer(c_int32_t) :: c_remesh
    end function
    ! Sets all members to their defaults; `size` is sizeof(motet_implant_options).
    subroutine c_implant_options_init(options, size) bind(c, name='motet_implant_options_init')
      import
      type(c_implant_options), intent(inout) :: options
      integer(c_size_t), value :: size
    end subroutine
    ! Puts devices into a host. `names` has a name for each device: that of its region and its patch. NULL for
    ! options: the defaults.
    function c_implant(host, devices, names, n_devices, options, outcome, error) &
        bind(c, name='motet_implant')
      import
      type(c_ptr), value :: host
      type(c_ptr), intent(in) :: devices(*), names(*)
      integer(c_int64_t), value :: n_devices
      type(c_implant_options), intent(in) :: options
      type(c_ptr), intent(inout) :: outcome, error
      integer(c_int32_t) :: c_implant
    end function
    ! Sets all members to their defaults; `size` is sizeof(motet_fill_options).
    subroutine c_fill_options_init(options, size) bind(c, name='motet_fill_options_init')
      import
      type(c_fill_options), intent(inout) :: options
      integer(c_size_t), value :: size
    end subroutine
    ! Fills closed surfaces with tets. `names` has a name for each surface; is_membrane has 1 for surfaces
    ! that may end inside the others, NULL: there are none. NULL for options: the defaults. The outcome has no
    ! history.
    function c_fill(surfaces, names, is_membrane, n_surfaces, options, outcome, error) &
        bind(c, name='motet_fill')
      import
      type(c_ptr), intent(in) :: surfaces(*), names(*)
      type(c_ptr), value :: is_membrane
      integer(c_int64_t), value :: n_surfaces
      type(c_fill_options), intent(in) :: options
      type(c_ptr), intent(inout) :: outcome, error
      integer(c_int32_t) :: c_fill
    end function
    ! Sets all members to their defaults; `size` is sizeof(motet_refinement_options).
    subroutine c_refinement_options_init(options, size) bind(c, name='motet_refinement_options_init')
      import
      type(c_refinement_options), intent(inout) :: options
      integer(c_size_t), value :: size
    end subroutine
    ! Sets up the refinement of a mesh; the mesh may be freed afterwards. NULL for options: the defaults.
    function c_refinement_new(mesh, options, refinement, error) bind(c, name='motet_refinement_new')
      import
      type(c_ptr), value :: mesh
      type(c_refinement_options), intent(in) :: options
      type(c_ptr), intent(inout) :: refinement, error
      integer(c_int32_t) :: c_refinement_new
    end function
    subroutine c_refinement_free(refinement) bind(c, name='motet_refinement_free')
      import
      type(c_ptr), value :: refinement
    end subroutine
    ! The current mesh; belongs to the refinement and is valid until the next change.
    function c_refinement_mesh(refinement) bind(c, name='motet_refinement_mesh')
      import
      type(c_ptr), value :: refinement
      type(c_ptr) :: c_refinement_mesh
    end function
    ! Copies the number of divisions of each of the n cells; -1 for cells that are not tets.
    function c_refinement_generations(refinement, generations, n, error) &
        bind(c, name='motet_refinement_generations')
      import
      type(c_ptr), value :: refinement
      integer(c_int32_t), intent(inout) :: generations(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_refinement_generations
    end function
    ! Divides the tets among the n cells whose mark is not 0, and further tets where conformity requires it.
    ! The outcome has a copy of the mesh and the history; NULL where none is wanted.
    function c_refinement_divide(refinement, marks, n, outcome, error) &
        bind(c, name='motet_refinement_divide')
      import
      type(c_ptr), value :: refinement
      integer(c_int32_t), intent(in) :: marks(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: outcome, error
      integer(c_int32_t) :: c_refinement_divide
    end function
    ! Takes back the divisions of which all parts have a mark that is not 0. `marks` and `outcome` are as
    ! those of motet_refinement_divide.
    function c_refinement_coarsen(refinement, marks, n, outcome, error) &
        bind(c, name='motet_refinement_coarsen')
      import
      type(c_ptr), value :: refinement
      integer(c_int32_t), intent(in) :: marks(*)
      integer(c_int64_t), value :: n
      type(c_ptr), intent(inout) :: outcome, error
      integer(c_int32_t) :: c_refinement_coarsen
    end function
    ! Divides tets until no edge is longer than `at` at a surface, and `growth` more per unit of distance from
    ! it. The outcome is as that of motet_refinement_divide. On an error nothing is changed.
    function c_refinement_near(refinement, surface, at, growth, outcome, error) &
        bind(c, name='motet_refinement_near')
      import
      type(c_ptr), value :: refinement, surface
      real(c_double), value :: at, growth
      type(c_ptr), intent(inout) :: outcome, error
      integer(c_int32_t) :: c_refinement_near
    end function
    ! Sets all members to their defaults; `size` is sizeof(motet_contact_options).
    subroutine c_contact_options_init(options, size) bind(c, name='motet_contact_options_init')
      import
      type(c_contact_options), intent(inout) :: options
      integer(c_size_t), value :: size
    end subroutine
    ! Sets up bodies over n_points points. `triangles` has three vertices for each triangle, body after body;
    ! `counts` has the number of triangles of each body; is_room has a MOTET_ROOM_ constant for each body,
    ! NULL: MOTET_ROOM_FOUND for all. NULL for options: the defaults.
    function c_contact_new(points, n_points, stride, triangles, counts, is_room, n_bodies, options, contact, &
        error) bind(c, name='motet_contact_new')
      import
      real(c_double), intent(in) :: points(*)
      integer(c_int64_t), value :: n_points, stride
      integer(c_int32_t), intent(in) :: triangles(*)
      integer(c_int64_t), intent(in) :: counts(*)
      type(c_ptr), value :: is_room
      integer(c_int64_t), value :: n_bodies
      type(c_contact_options), intent(in) :: options
      type(c_ptr), intent(inout) :: contact, error
      integer(c_int32_t) :: c_contact_new
    end function
    subroutine c_contact_free(contact) bind(c, name='motet_contact_free')
      import
      type(c_ptr), value :: contact
    end subroutine
    ! Moves all points.
    function c_contact_refit(contact, points, n_points, stride, error) bind(c, name='motet_contact_refit')
      import
      type(c_ptr), value :: contact
      real(c_double), intent(in) :: points(*)
      integer(c_int64_t), value :: n_points, stride
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_contact_refit
    end function
    ! Measures the gap at each point: the least of the gaps of its bodies; infinite for points of no body and
    ! where nothing is within reach; negative where a body is where it must not be. `least` receives the least
    ! distance of any two triangles; it may be NULL.
    function c_contact_measure(contact, gaps, n_points, least, error) bind(c, name='motet_contact_measure')
      import
      type(c_ptr), value :: contact
      real(c_double), intent(inout) :: gaps(*)
      integer(c_int64_t), value :: n_points
      real(c_double), intent(out) :: least
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_contact_measure
    end function
    ! Finds the closest points of two bodies: their distance, infinite where nothing is within reach; the two
    ! places; the triangle of each. `places` and `triangles` may be NULL.
    function c_contact_nearest(contact, first, second, distance, places, triangles, error) &
        bind(c, name='motet_contact_nearest')
      import
      type(c_ptr), value :: contact
      integer(c_int32_t), value :: first, second
      real(c_double), intent(out) :: distance
      real(c_double), intent(inout) :: places(6)
      integer(c_int32_t), intent(inout) :: triangles(2)
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_contact_nearest
    end function
    ! Computes a time before which nothing touches if points move straight on at their velocities, one row for
    ! each point; infinite where nothing touches before the horizon (0: no horizon).
    function c_contact_ahead(contact, velocity, n_points, stride, horizon, time, error) &
        bind(c, name='motet_contact_ahead')
      import
      type(c_ptr), value :: contact
      real(c_double), intent(in) :: velocity(*)
      integer(c_int64_t), value :: n_points, stride
      real(c_double), value :: horizon
      real(c_double), intent(out) :: time
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_contact_ahead
    end function
    ! Sets all members to their defaults; `size` is sizeof(motet_moving_options).
    subroutine c_moving_options_init(options, size) bind(c, name='motet_moving_options_init')
      import
      type(c_moving_options), intent(inout) :: options
      integer(c_size_t), value :: size
    end subroutine
    ! Sets up the motion of a mesh with its arrays; the mesh may be freed afterwards. NULL for options: the
    ! defaults.
    function c_moving_new(mesh, options, moving, error) bind(c, name='motet_moving_new')
      import
      type(c_ptr), value :: mesh
      type(c_moving_options), intent(in) :: options
      type(c_ptr), intent(inout) :: moving, error
      integer(c_int32_t) :: c_moving_new
    end function
    ! Writes all that later steps depend on to a .vtu file.
    function c_moving_save(moving, path, error) bind(c, name='motet_moving_save')
      import
      type(c_ptr), value :: moving
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_moving_save
    end function
    ! Continues from a file of motet_moving_save: with the same options, later steps are the same to the bit.
    ! Earlier changes are not remembered.
    function c_moving_load(path, options, moving, error) bind(c, name='motet_moving_load')
      import
      character(kind=c_char), intent(in) :: path(*)
      type(c_moving_options), intent(in) :: options
      type(c_ptr), intent(inout) :: moving, error
      integer(c_int32_t) :: c_moving_load
    end function
    subroutine c_moving_free(moving) bind(c, name='motet_moving_free')
      import
      type(c_ptr), value :: moving
    end subroutine
    ! The number of driven vertices: those of the boundary and of the patches `inside` of the first mesh.
    function c_moving_n_driven(moving) bind(c, name='motet_moving_n_driven')
      import
      type(c_ptr), value :: moving
      integer(c_int64_t) :: c_moving_n_driven
    end function
    ! Copies the first places of the n driven vertices. Displacements have a row for each of these, in this
    ! order.
    function c_moving_driven_places(moving, places, n, stride, error) &
        bind(c, name='motet_moving_driven_places')
      import
      type(c_ptr), value :: moving
      real(c_double), intent(inout) :: places(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_moving_driven_places
    end function
    ! The current time; 0 at first.
    function c_moving_time(moving) bind(c, name='motet_moving_time')
      import
      type(c_ptr), value :: moving
      real(c_double) :: c_moving_time
    end function
    ! The number of steps so far.
    function c_moving_step(moving) bind(c, name='motet_moving_step')
      import
      type(c_ptr), value :: moving
      integer(c_int64_t) :: c_moving_step
    end function
    ! The current mesh with its arrays; belongs to the moving mesh and is valid until the next call that
    ! changes it.
    function c_moving_mesh(moving) bind(c, name='motet_moving_mesh')
      import
      type(c_ptr), value :: moving
      type(c_ptr) :: c_moving_mesh
    end function
    ! Computes the velocity of each of the n points of the current mesh in the last step.
    function c_moving_velocity(moving, velocity, n, stride, error) bind(c, name='motet_moving_velocity')
      import
      type(c_ptr), value :: moving
      real(c_double), intent(inout) :: velocity(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_moving_velocity
    end function
    ! Computes the displacement of each of the n points of the current mesh from its first place.
    function c_moving_displacement(moving, displacement, n, stride, error) &
        bind(c, name='motet_moving_displacement')
      import
      type(c_ptr), value :: moving
      real(c_double), intent(inout) :: displacement(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_moving_displacement
    end function
    ! Sets an array of n rows with `components` contiguous values each; replaces an array of the same name.
    ! The array is transferred where the mesh changes.
    function c_moving_set_array(moving, on, name, values, n, components, error) &
        bind(c, name='motet_moving_set_array')
      import
      type(c_ptr), value :: moving
      integer(c_int32_t), value :: on
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: values(*)
      integer(c_int64_t), value :: n
      integer(c_int32_t), value :: components
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_moving_set_array
    end function
    ! Sets all members to those of an empty step; `size` is sizeof(motet_step).
    subroutine c_step_init(step, size) bind(c, name='motet_step_init')
      import
      type(moving_step), intent(inout) :: step
      integer(c_size_t), value :: size
    end subroutine
    ! Moves the walls to their displacements at a time after the current one, one row for each driven vertex;
    ! the inside follows and is repaired on the way where necessary. A motion that is reached in part only is
    ! no error: `complete` is 0. `step` may be NULL. On an error nothing is changed.
    function c_moving_advance(moving, time, displacement, n_driven, stride, step, error) &
        bind(c, name='motet_moving_advance')
      import
      type(c_ptr), value :: moving
      real(c_double), value :: time
      real(c_double), intent(in) :: displacement(*)
      integer(c_int64_t), value :: n_driven, stride
      type(moving_step), intent(inout) :: step
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_moving_advance
    end function
    ! Repairs the bad tets of the current mesh, for a mesh that is bad at first or after refinement; a step
    ! repairs by itself. `changes` receives the number of changes; it may be NULL.
    function c_moving_repair(moving, changes, error) bind(c, name='motet_moving_repair')
      import
      type(c_ptr), value :: moving
      integer(c_int64_t), intent(out) :: changes
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_moving_repair
    end function
    ! Divides tets until no edge is longer than `at` at a surface, and `growth` more per unit of distance from
    ! it; `coarsen` 1: divisions that are not needed are taken back. `changes` receives the number of changes;
    ! it may be NULL.
    function c_moving_refine_near(moving, surface, at, growth, coarsen, changes, error) &
        bind(c, name='motet_moving_refine_near')
      import
      type(c_ptr), value :: moving, surface
      real(c_double), value :: at, growth
      integer(c_int32_t), value :: coarsen
      integer(c_int64_t), intent(out) :: changes
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_moving_refine_near
    end function
    ! Divides tets until edges at watched patches are no longer than the gap between them or than `smallest`;
    ! `coarsen` 1: divisions that are not needed are taken back. `changes` receives the number of changes; it
    ! may be NULL.
    function c_moving_refine_gaps(moving, smallest, coarsen, changes, error) &
        bind(c, name='motet_moving_refine_gaps')
      import
      type(c_ptr), value :: moving
      real(c_double), value :: smallest
      integer(c_int32_t), value :: coarsen
      integer(c_int64_t), intent(out) :: changes
      type(c_ptr), intent(inout) :: error
      integer(c_int32_t) :: c_moving_refine_gaps
    end function
    ! 1 where all changes since a step are remembered (step 0: since the first mesh), otherwise 0.
    function c_moving_remembers(moving, step) bind(c, name='motet_moving_remembers')
      import
      type(c_ptr), value :: moving
      integer(c_int64_t), value :: step
      integer(c_int32_t) :: c_moving_remembers
    end function
    ! The history from the mesh after a step to the current mesh: transfers any array of the caller, of any
    ! time in between, by motet_outcome_transfer. The outcome is NULL where the mesh did not change, so that
    ! arrays fit as they are.
    function c_moving_since(moving, step, outcome, error) bind(c, name='motet_moving_since')
      import
      type(c_ptr), value :: moving
      integer(c_int64_t), value :: step
      type(c_ptr), intent(inout) :: outcome, error
      integer(c_int32_t) :: c_moving_since
    end function
  end interface

  interface
    function c_strlen(text) bind(c, name='strlen')
      import
      type(c_ptr), value :: text
      integer(c_size_t) :: c_strlen
    end function
  end interface

contains

  ! The version of the linked library: major * 10000 + minor * 100 + patch.
  function motet_version() result(version)
    integer(c_int32_t) :: version
    version = c_version()
  end function

  ! Ends a call: stores its status and its message, or stops the program on an error if `status` is absent.
  subroutine finish(code, error, status, message)
    integer(c_int32_t), intent(in) :: code
    type(c_ptr), intent(in) :: error
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    character(:), allocatable :: text
    text = ''
    if (c_associated(error)) then
      text = fortran_text(c_error_message(error))
      call c_error_free(error)
    end if
    call settle(code, text, status, message)
  end subroutine

  subroutine settle(code, text, status, message)
    integer(c_int32_t), intent(in) :: code
    character(*), intent(in) :: text
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    if (present(message)) message = text
    if (present(status)) then
      status = code
    else if (code /= MOTET_OK) then
      error stop 'motet: '//text
    end if
  end subroutine

  function fortran_text(c_text) result(text)
    type(c_ptr), intent(in) :: c_text
    character(:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    integer(c_size_t) :: i, n
    n = c_strlen(c_text)
    call c_f_pointer(c_text, letters, [n])
    allocate(character(len=n) :: text)
    do i = 1, n
      text(i:i) = letters(i)
    end do
  end function

  ! Keeps texts for C; `place` and `n` are the list that C takes.
  subroutine keep(strings, kept, place, n)
    character(*), intent(in), optional :: strings(:)
    type(texts), intent(out), target :: kept
    type(c_ptr), intent(out) :: place
    integer(c_int64_t), intent(out) :: n
    integer :: i, k, at
    place = c_null_ptr
    n = 0
    if (.not. present(strings)) return
    n = size(strings, kind=c_int64_t)
    if (n == 0) return
    allocate(kept%letters(sum(len_trim(strings) + 1)), kept%places(n))
    at = 1
    do i = 1, size(strings)
      kept%places(i) = c_loc(kept%letters(at))
      do k = 1, len_trim(strings(i))
        kept%letters(at) = strings(i)(k:k)
        at = at + 1
      end do
      kept%letters(at) = c_null_char
      at = at + 1
    end do
    place = c_loc(kept%places)
  end subroutine

  subroutine give_mover_options(options, given, kept)
    type(mover_options), intent(in), optional, target :: options
    type(c_mover_options), intent(out) :: given
    type(texts), allocatable, intent(out), target :: kept(:)
    allocate(kept(3))
    given%size = c_sizeof(given)
    if (.not. present(options)) return
    given%method = options%method
    given%within_walls = options%within_walls
    given%smooth = options%smooth
    given%substeps = options%substeps
    given%threads = options%threads
    given%rigid_layer_cells = options%rigid_layer_cells
    given%rigid_layer = options%rigid_layer
    given%residual = options%residual
    given%factor_gib = options%factor_gib
    call keep(options%slide, kept(1), given%slide, given%n_slide)
    call keep(options%bodies, kept(2), given%bodies, given%n_bodies)
    call keep(options%wall, kept(3), given%wall, given%n_wall)
    if (allocated(options%also_moved)) then
      given%n_also_moved = size(options%also_moved, kind=c_int64_t)
      if (given%n_also_moved > 0) given%also_moved = c_loc(options%also_moved)
    end if
    given%slide_tolerance = options%slide_tolerance
    if (associated(options%watched_by)) given%watched_by = options%watched_by%handle
  end subroutine

  subroutine give_remesh_options(options, given, kept)
    type(remesh_options), intent(in), optional, target :: options
    type(c_remesh_options), intent(out) :: given
    type(texts), allocatable, intent(out), target :: kept(:)
    allocate(kept(1))
    given%size = c_sizeof(given)
    if (.not. present(options)) return
    given%min_eas = options%min_eas
    given%min_dihedral_deg = options%min_dihedral_deg
    given%best = options%best
    given%surface = options%surface
    given%distance = options%distance
    given%repair_layers = options%repair_layers
    given%rounds = options%rounds
    given%threads = options%threads
    given%edge_length = options%edge_length
    if (allocated(options%sizes)) then
      given%n_sizes = size(options%sizes, kind=c_int64_t)
      if (given%n_sizes > 0) given%sizes = c_loc(options%sizes)
    end if
    call keep(options%hold, kept(1), given%hold, given%n_hold)
    if (associated(options%watched_by)) given%watched_by = options%watched_by%handle
  end subroutine

  subroutine give_implant_options(options, given, kept)
    type(implant_options), intent(in), optional, target :: options
    type(c_implant_options), intent(out) :: given
    type(texts), allocatable, intent(out), target :: kept(:)
    allocate(kept(0))
    given%size = c_sizeof(given)
    if (.not. present(options)) return
    given%inside = options%inside
    given%conform = options%conform
    given%tolerance = options%tolerance
    given%keep_outside = options%keep_outside
    given%adapt = options%adapt
    given%stray = options%stray
    given%edge_length = options%edge_length
    given%growth = options%growth
    given%carve = options%carve
    given%reach = options%reach
    given%min_eas = options%min_eas
    given%threads = options%threads
    if (associated(options%watched_by)) given%watched_by = options%watched_by%handle
  end subroutine

  subroutine give_fill_options(options, given, kept)
    type(fill_options), intent(in), optional, target :: options
    type(c_fill_options), intent(out) :: given
    type(texts), allocatable, intent(out), target :: kept(:)
    allocate(kept(0))
    given%size = c_sizeof(given)
    if (.not. present(options)) return
    given%edge_length = options%edge_length
    given%graded = options%graded
    given%growth = options%growth
    given%min_eas = options%min_eas
    given%layers = options%layers
    given%first_layer = options%first_layer
    given%layer_growth = options%layer_growth
    given%keep_prisms = options%keep_prisms
    given%repair = options%repair
    given%threads = options%threads
    given%cut = options%cut
    given%voids = options%voids
    if (associated(options%watched_by)) given%watched_by = options%watched_by%handle
    given%unite = options%unite
    given%wrap = options%wrap
  end subroutine

  subroutine give_refinement_options(options, given, kept)
    type(refinement_options), intent(in), optional, target :: options
    type(c_refinement_options), intent(out) :: given
    type(texts), allocatable, intent(out), target :: kept(:)
    allocate(kept(0))
    given%size = c_sizeof(given)
    if (.not. present(options)) return
    given%threads = options%threads
    if (associated(options%watched_by)) given%watched_by = options%watched_by%handle
  end subroutine

  subroutine give_contact_options(options, given, kept)
    type(contact_options), intent(in), optional, target :: options
    type(c_contact_options), intent(out) :: given
    type(texts), allocatable, intent(out), target :: kept(:)
    allocate(kept(0))
    given%size = c_sizeof(given)
    if (.not. present(options)) return
    given%warn = options%warn
    given%within = options%within
    given%fold = options%fold
    given%own = options%own
    given%facing = options%facing
    given%threads = options%threads
  end subroutine

  subroutine give_moving_options(options, given, kept)
    type(moving_options), intent(in), optional, target :: options
    type(c_moving_options), intent(out) :: given
    type(texts), allocatable, intent(out), target :: kept(:)
    allocate(kept(7))
    given%size = c_sizeof(given)
    if (.not. present(options)) return
    given%method = options%method
    given%within_walls = options%within_walls
    given%smooth = options%smooth
    given%rigid_layer_cells = options%rigid_layer_cells
    given%rigid_layer = options%rigid_layer
    call keep(options%inside, kept(1), given%inside, given%n_inside)
    call keep(options%slide, kept(2), given%slide, given%n_slide)
    call keep(options%bodies, kept(3), given%bodies, given%n_bodies)
    call keep(options%wall, kept(4), given%wall, given%n_wall)
    given%no_repair = options%no_repair
    given%surface = options%surface
    given%distance = options%distance
    given%min_eas = options%min_eas
    given%margin = options%margin
    given%floor = options%floor
    given%improve_below = options%improve_below
    call keep(options%contents, kept(5), given%contents, given%n_contents)
    call keep(options%watch, kept(6), given%watch, given%n_watch)
    given%warn = options%warn
    given%within = options%within
    given%horizon = options%horizon
    given%hold = options%hold
    given%remembered = options%remembered
    given%threads = options%threads
    call keep(options%hold_names, kept(7), given%hold_names, given%n_hold_names)
    given%slide_tolerance = options%slide_tolerance
    given%valid_at_start = options%valid_at_start
    given%strain_in_band = options%strain_in_band
    given%returns = options%returns
    if (associated(options%watched_by)) given%watched_by = options%watched_by%handle
  end subroutine

  subroutine watch_new(self, tell, every, status, message)
    class(watch), intent(inout) :: self
    procedure(progress), optional :: tell
    real(c_double), intent(in), optional :: every
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    real(c_double) :: seconds
    call self%free()
    code = c_watch_new(self%handle, error)
    if (code == MOTET_OK .and. present(tell)) then
      seconds = 0
      if (present(every)) seconds = every
      allocate(self%told)
      self%told%tell => tell
      code = c_watch_on_progress(self%handle, c_funloc(tell_progress), c_loc(self%told), seconds, error)
    end if
    call finish(code, error, status, message)
  end subroutine

  ! Tells the progress to a function of Fortran, `data`: a listener.
  function tell_progress(data, stage, done, of) result(stops) bind(c, name='')
    type(c_ptr), value :: data
    character(kind=c_char), intent(in) :: stage(*)
    integer(c_int64_t), value :: done, of
    integer(c_int32_t) :: stops
    type(listener), pointer :: told
    call c_f_pointer(data, told)
    stops = merge(1_c_int32_t, 0_c_int32_t, told%tell(letters_of(stage), done, of))
  end function

  ! A text that ends with c_null_char.
  pure function letters_of(c_text) result(text)
    character(kind=c_char), intent(in) :: c_text(*)
    character(:), allocatable :: text
    integer :: i, n
    n = 0
    do while (c_text(n + 1) /= c_null_char)
      n = n + 1
    end do
    allocate(character(len=n) :: text)
    do i = 1, n
      text(i:i) = c_text(i)
    end do
  end function

  ! Stops the watched call, or the next one if none is running; from any thread.
  subroutine watch_stop(self)
    class(watch), intent(in) :: self
    call c_watch_stop(self%handle)
  end subroutine

  ! The progress of the watched call, or of the last one; from any thread.
  subroutine watch_progress(self, stage, done, of, status, message)
    class(watch), intent(in) :: self
    character(:), allocatable, intent(out) :: stage
    integer(c_int64_t), intent(out) :: done, of
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    character(kind=c_char) :: letters(64)
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    letters = c_null_char
    code = c_watch_progress(self%handle, letters, size(letters, kind=c_int64_t), done, of, error)
    stage = letters_of(letters)
    call finish(code, error, status, message)
  end subroutine

  subroutine watch_free(self)
    class(watch), intent(inout) :: self
    call c_watch_free(self%handle)
    self%handle = c_null_ptr
    if (associated(self%told)) deallocate(self%told)
  end subroutine

  impure elemental subroutine watch_final(self)
    type(watch), intent(inout) :: self
    call self%free()
  end subroutine

  subroutine mesh_new(self, points, status, message)
    class(mesh), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    code = c_mesh_new(points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  ! `notes` says what of the file is not used, a sentence a line; empty where all is.
  subroutine mesh_read(self, path, status, message, notes)
    class(mesh), intent(inout) :: self
    character(*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    character(:), allocatable, intent(out), optional :: notes
    type(c_ptr) :: error, sentences
    integer(c_int32_t) :: code
    call self%free()
    sentences = c_null_ptr
    code = c_mesh_read_noted(trim(path)//c_null_char, self%handle, sentences, error)
    if (present(notes)) notes = text_of(sentences)
    call c_text_free(sentences)
    call finish(code, error, status, message)
  end subroutine

  ! `lost` says what the format cannot hold, a sentence a line; empty where it holds all.
  subroutine mesh_write(self, path, status, message, lost)
    class(mesh), intent(in) :: self
    character(*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    character(:), allocatable, intent(out), optional :: lost
    type(c_ptr) :: error, sentences
    integer(c_int32_t) :: code
    sentences = c_null_ptr
    code = c_mesh_write_noted(self%handle, trim(path)//c_null_char, sentences, error)
    if (present(lost)) lost = text_of(sentences)
    call c_text_free(sentences)
    call finish(code, error, status, message)
  end subroutine

  ! The characters of a text of C; none for NULL.
  function text_of(c_text) result(text)
    type(c_ptr), intent(in) :: c_text
    character(:), allocatable :: text
    text = ''
    if (c_associated(c_text)) text = fortran_text(c_text_get(c_text))
  end function

  ! `vertices` has a column for each cell.
  subroutine mesh_add_cells(self, kind, vertices, status, message)
    class(mesh), intent(inout) :: self
    integer(c_int32_t), intent(in) :: kind
    integer(c_int32_t), contiguous, intent(in) :: vertices(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_add_cells(self%handle, kind, vertices, size(vertices, 2, c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  subroutine mesh_set_points(self, points, status, message)
    class(mesh), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_set_points(self%handle, points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  ! Sets the label of each cell: regions of volume cells, patches of surface cells; 0 for none.
  subroutine mesh_set_labels(self, labels, status, message)
    class(mesh), intent(inout) :: self
    integer(c_int32_t), contiguous, intent(in) :: labels(:)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_set_labels(self%handle, labels, size(labels, kind=c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  ! Names the region that has a label.
  subroutine mesh_name_region(self, label, name, status, message)
    class(mesh), intent(inout) :: self
    integer(c_int32_t), intent(in) :: label
    character(*), intent(in) :: name
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_name_region(self%handle, label, trim(name)//c_null_char, error)
    call finish(code, error, status, message)
  end subroutine

  ! Names the patch that has a label.
  subroutine mesh_name_patch(self, label, name, status, message)
    class(mesh), intent(inout) :: self
    integer(c_int32_t), intent(in) :: label
    character(*), intent(in) :: name
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_name_patch(self%handle, label, trim(name)//c_null_char, error)
    call finish(code, error, status, message)
  end subroutine

  ! `values` has the shape (components, n), a column for each point or cell.
  subroutine mesh_set_array(self, on, name, values, status, message)
    class(mesh), intent(inout) :: self
    integer(c_int32_t), intent(in) :: on
    character(*), intent(in) :: name
    real(c_double), contiguous, intent(in) :: values(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_set_array(self%handle, on, trim(name)//c_null_char, values, size(values, 2, c_int64_t), &
        size(values, 1, c_int32_t), error)
    call finish(code, error, status, message)
  end subroutine

  ! Allocates values(components, n), a column for each point or cell.
  subroutine mesh_array(self, on, name, values, status, message)
    class(mesh), intent(in) :: self
    integer(c_int32_t), intent(in) :: on
    character(*), intent(in) :: name
    real(c_double), allocatable, intent(out) :: values(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    integer(c_int64_t) :: n
    n = merge(self%n_points(), self%n_cells(), on == MOTET_ON_POINTS)
    allocate(values(c_mesh_array_components(self%handle, on, trim(name)//c_null_char), n))
    code = c_mesh_array(self%handle, on, trim(name)//c_null_char, values, n, error)
    call finish(code, error, status, message)
  end subroutine

  function mesh_n_points(self) result(n)
    class(mesh), intent(in) :: self
    integer(c_int64_t) :: n
    n = c_mesh_n_points(self%handle)
  end function

  function mesh_n_cells(self) result(n)
    class(mesh), intent(in) :: self
    integer(c_int64_t) :: n
    n = c_mesh_n_cells(self%handle)
  end function

  function mesh_n_of_kind(self, kind) result(n)
    class(mesh), intent(in) :: self
    integer(c_int32_t), intent(in) :: kind
    integer(c_int64_t) :: n
    n = c_mesh_n_of_kind(self%handle, kind)
  end function

  ! Allocates points(3, n_points).
  subroutine mesh_points(self, points, status, message)
    class(mesh), intent(in) :: self
    real(c_double), allocatable, intent(out) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(points(3, self%n_points()))
    code = c_mesh_points(self%handle, points, self%n_points(), 3_c_int64_t, error)
    call finish(code, error, status, message)
  end subroutine

  ! Allocates vertices(of_each, n), a column for each cell of the kind, which has `of_each` vertices.
  subroutine mesh_of_kind(self, kind, of_each, vertices, status, message)
    class(mesh), intent(in) :: self
    integer(c_int32_t), intent(in) :: kind, of_each
    integer(c_int32_t), allocatable, intent(out) :: vertices(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(vertices(of_each, self%n_of_kind(kind)))
    code = c_mesh_of_kind(self%handle, kind, vertices, size(vertices, kind=c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  subroutine mesh_eas(self, eas, status, message)
    class(mesh), intent(in) :: self
    real(c_double), allocatable, intent(out) :: eas(:)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(eas(self%n_cells()))
    code = c_mesh_eas(self%handle, eas, self%n_cells(), error)
    call finish(code, error, status, message)
  end subroutine

  subroutine mesh_labels(self, labels, status, message)
    class(mesh), intent(in) :: self
    integer(c_int32_t), allocatable, intent(out) :: labels(:)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(labels(self%n_cells()))
    code = c_mesh_labels(self%handle, labels, self%n_cells(), error)
    call finish(code, error, status, message)
  end subroutine

  function mesh_region(self, name) result(label)
    class(mesh), intent(in) :: self
    character(*), intent(in) :: name
    integer(c_int32_t) :: label
    label = c_mesh_region(self%handle, trim(name)//c_null_char)
  end function

  function mesh_patch(self, name) result(label)
    class(mesh), intent(in) :: self
    character(*), intent(in) :: name
    integer(c_int32_t) :: label
    label = c_mesh_patch(self%handle, trim(name)//c_null_char)
  end function

  ! Allocates the vertices of a patch, in ascending order.
  subroutine mesh_patch_vertices(self, name, vertices, status, message)
    class(mesh), intent(in) :: self
    character(*), intent(in) :: name
    integer(c_int32_t), allocatable, intent(out) :: vertices(:)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(vertices(max(0_c_int64_t, c_mesh_n_patch_vertices(self%handle, trim(name)//c_null_char))))
    code = c_mesh_patch_vertices(self%handle, trim(name)//c_null_char, vertices, size(vertices, kind=c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  subroutine mesh_free(self)
    class(mesh), intent(inout) :: self
    call c_mesh_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  impure elemental subroutine mesh_final(self)
    type(mesh), intent(inout) :: self
    call self%free()
  end subroutine

  subroutine mover_new(self, of, options, status, message)
    class(mover), intent(inout) :: self
    class(mesh), intent(in) :: of
    type(mover_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_mover_options) :: used
    type(texts), allocatable, target :: kept(:)
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    call give_mover_options(options, used, kept)
    code = c_mover_new(of%handle, used, self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  function mover_n_points(self) result(n)
    class(mover), intent(in) :: self
    integer(c_int64_t) :: n
    n = c_mover_n_points(self%handle)
  end function

  function mover_n_boundary(self) result(n)
    class(mover), intent(in) :: self
    integer(c_int64_t) :: n
    n = c_mover_n_boundary(self%handle)
  end function

  subroutine mover_boundary(self, vertices, status, message)
    class(mover), intent(in) :: self
    integer(c_int32_t), allocatable, intent(out) :: vertices(:)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(vertices(self%n_boundary()))
    code = c_mover_boundary(self%handle, vertices, self%n_boundary(), error)
    call finish(code, error, status, message)
  end subroutine

  ! displacement(3, n_boundary) and points(3, n_points) are used in place; both may have more than three rows.
  subroutine mover_step(self, displacement, points, status, message)
    class(mover), intent(in) :: self
    real(c_double), contiguous, intent(in) :: displacement(:, :)
    real(c_double), contiguous, intent(inout) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mover_step(self%handle, displacement, size(displacement, 2, c_int64_t), size(displacement, 1, c_int64_t), &
        points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  subroutine mover_advance(self, displacement, points, reached, status, message)
    class(mover), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: displacement(:, :)
    real(c_double), contiguous, intent(inout) :: points(:, :)
    type(certificate), intent(out) :: reached
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    reached%size = c_sizeof(reached)
    code = c_mover_advance(self%handle, displacement, size(displacement, 2, c_int64_t), size(displacement, 1, c_int64_t), &
        points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), reached, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine mover_free(self)
    class(mover), intent(inout) :: self
    call c_mover_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  impure elemental subroutine mover_final(self)
    type(mover), intent(inout) :: self
    call self%free()
  end subroutine

  ! nodes(3, n_nodes) are those of the whole boundary, of all processes; points(3, n_points) follow them.
  subroutine point_mover_new(self, nodes, points, threads, status, message)
    class(point_mover), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: nodes(:, :), points(:, :)
    integer(c_int32_t), intent(in), optional :: threads
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code, n
    call self%free()
    n = 1
    if (present(threads)) n = threads
    code = c_point_mover_new(nodes, size(nodes, 2, c_int64_t), size(nodes, 1, c_int64_t), points, size(points, 2, c_int64_t), &
        size(points, 1, c_int64_t), n, self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine point_mover_step(self, displacement, points, status, message)
    class(point_mover), intent(in) :: self
    real(c_double), contiguous, intent(in) :: displacement(:, :)
    real(c_double), contiguous, intent(inout) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_point_mover_step(self%handle, displacement, size(displacement, 2, c_int64_t), size(displacement, 1, c_int64_t), &
        points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  subroutine point_mover_free(self)
    class(point_mover), intent(inout) :: self
    call c_point_mover_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  impure elemental subroutine point_mover_final(self)
    type(point_mover), intent(inout) :: self
    call self%free()
  end subroutine

  subroutine outcome_remesh(self, of, options, status, message)
    class(outcome), intent(inout) :: self
    class(mesh), intent(in) :: of
    type(remesh_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_remesh_options) :: used
    type(texts), allocatable, target :: kept(:)
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    call give_remesh_options(options, used, kept)
    code = c_remesh(of%handle, used, self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  ! Puts one device into a host; the region and the patch of the device get its name.
  subroutine outcome_implant(self, host, device, name, options, status, message)
    class(outcome), intent(inout) :: self
    class(mesh), intent(in) :: host, device
    character(*), intent(in) :: name
    type(implant_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_implant_options) :: used
    type(texts), allocatable, target :: kept(:)
    type(texts), target :: names
    type(c_ptr) :: devices(1), place, error
    integer(c_int32_t) :: code
    integer(c_int64_t) :: n
    call self%free()
    call give_implant_options(options, used, kept)
    devices(1) = device%handle
    call keep([name], names, place, n)
    code = c_implant(host%handle, devices, names%places, n, used, self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  ! Fills closed surfaces with tets; `names` has a name for each. The outcome has no history.
  subroutine outcome_fill(self, surfaces, names, options, status, message)
    class(outcome), intent(inout) :: self
    type(mesh), intent(in) :: surfaces(:)
    character(*), intent(in) :: names(:)
    type(fill_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_fill_options) :: used
    type(texts), allocatable, target :: kept(:)
    type(texts), target :: letters
    type(c_ptr) :: handles(size(surfaces)), place, error
    integer(c_int32_t) :: code
    integer(c_int64_t) :: n
    integer :: i
    call self%free()
    if (size(names) /= size(surfaces)) then
      call settle(MOTET_ERROR_OPTIONS, 'the number of names is not that of surfaces', status, message)
      return
    end if
    call give_fill_options(options, used, kept)
    do i = 1, size(surfaces)
      handles(i) = surfaces(i)%handle
    end do
    call keep(names, letters, place, n)
    if (n == 0) allocate(letters%places(0))
    code = c_fill(handles, letters%places, c_null_ptr, n, used, self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  function outcome_complete(self) result(is_so)
    class(outcome), intent(in) :: self
    logical :: is_so
    is_so = c_outcome_complete(self%handle) == 1
  end function

  subroutine outcome_mesh(self, new, status, message)
    class(outcome), intent(in) :: self
    class(mesh), intent(inout) :: new
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call new%free()
    code = c_mesh_copy(c_outcome_mesh(self%handle), new%handle, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine outcome_to_old(self, on, old, status, message)
    class(outcome), intent(in) :: self
    integer(c_int32_t), intent(in) :: on
    integer(c_int32_t), allocatable, intent(out) :: old(:)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(old(rows(self, on)))
    code = c_outcome_to_old(self%handle, on, old, size(old, kind=c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  ! `values` has a column for each old point or cell, `new` a column for each new one.
  subroutine outcome_transfer(self, on, rule, values, new, status, message)
    class(outcome), intent(in) :: self
    integer(c_int32_t), intent(in) :: on, rule
    real(c_double), contiguous, intent(in) :: values(:, :)
    real(c_double), allocatable, intent(out) :: new(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(new(size(values, 1), rows(self, on)))
    code = c_outcome_transfer(self%handle, on, rule, values, size(values, 2, c_int64_t), size(values, 1, c_int32_t), new, &
        size(new, 2, c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  function rows(of, on) result(n)
    class(outcome), intent(in) :: of
    integer(c_int32_t), intent(in) :: on
    integer(c_int64_t) :: n
    if (on == MOTET_ON_POINTS) then
      n = c_mesh_n_points(c_outcome_mesh(of%handle))
    else
      n = c_mesh_n_cells(c_outcome_mesh(of%handle))
    end if
  end function

  subroutine outcome_free(self)
    class(outcome), intent(inout) :: self
    call c_outcome_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  impure elemental subroutine outcome_final(self)
    type(outcome), intent(inout) :: self
    call self%free()
  end subroutine

  subroutine refinement_new(self, of, options, status, message)
    class(refinement), intent(inout) :: self
    class(mesh), intent(in) :: of
    type(refinement_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_refinement_options) :: used
    type(texts), allocatable, target :: kept(:)
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    call give_refinement_options(options, used, kept)
    code = c_refinement_new(of%handle, used, self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine refinement_mesh(self, copy, status, message)
    class(refinement), intent(in) :: self
    type(mesh), intent(inout) :: copy
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call copy%free()
    code = c_mesh_copy(c_refinement_mesh(self%handle), copy%handle, error)
    call finish(code, error, status, message)
  end subroutine

  ! Allocates the number of divisions of each cell of the current mesh.
  subroutine refinement_generations(self, generations, status, message)
    class(refinement), intent(in) :: self
    integer(c_int32_t), allocatable, intent(out) :: generations(:)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(generations(c_mesh_n_cells(c_refinement_mesh(self%handle))))
    code = c_refinement_generations(self%handle, generations, size(generations, kind=c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  ! `marks` has an entry for each cell of the current mesh; `changes` has the history.
  subroutine refinement_divide(self, marks, changes, status, message)
    class(refinement), intent(inout) :: self
    integer(c_int32_t), contiguous, intent(in) :: marks(:)
    type(outcome), intent(inout), optional :: changes
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error, made
    integer(c_int32_t) :: code
    made = c_null_ptr
    if (present(changes)) call changes%free()
    code = c_refinement_divide(self%handle, marks, size(marks, kind=c_int64_t), made, error)
    if (present(changes)) then
      changes%handle = made
    else
      call c_outcome_free(made)
    end if
    call finish(code, error, status, message)
  end subroutine

  subroutine refinement_coarsen(self, marks, changes, status, message)
    class(refinement), intent(inout) :: self
    integer(c_int32_t), contiguous, intent(in) :: marks(:)
    type(outcome), intent(inout), optional :: changes
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error, made
    integer(c_int32_t) :: code
    made = c_null_ptr
    if (present(changes)) call changes%free()
    code = c_refinement_coarsen(self%handle, marks, size(marks, kind=c_int64_t), made, error)
    if (present(changes)) then
      changes%handle = made
    else
      call c_outcome_free(made)
    end if
    call finish(code, error, status, message)
  end subroutine

  subroutine refinement_near(self, surface, at, growth, changes, status, message)
    class(refinement), intent(inout) :: self
    class(mesh), intent(in) :: surface
    real(c_double), intent(in) :: at, growth
    type(outcome), intent(inout), optional :: changes
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error, made
    integer(c_int32_t) :: code
    made = c_null_ptr
    if (present(changes)) call changes%free()
    code = c_refinement_near(self%handle, surface%handle, at, growth, made, error)
    if (present(changes)) then
      changes%handle = made
    else
      call c_outcome_free(made)
    end if
    call finish(code, error, status, message)
  end subroutine

  subroutine refinement_free(self)
    class(refinement), intent(inout) :: self
    call c_refinement_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  impure elemental subroutine refinement_final(self)
    type(refinement), intent(inout) :: self
    call self%free()
  end subroutine

  ! `triangles` has a column for each triangle, body after body; `counts` has the number of each body.
  subroutine contact_new(self, points, triangles, counts, options, status, message)
    class(contact), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: points(:, :)
    integer(c_int32_t), contiguous, intent(in) :: triangles(:, :)
    integer(c_int64_t), intent(in) :: counts(:)
    type(contact_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_contact_options) :: used
    type(texts), allocatable, target :: kept(:)
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    call give_contact_options(options, used, kept)
    code = c_contact_new(points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), triangles, counts, c_null_ptr, &
        size(counts, kind=c_int64_t), used, self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine contact_refit(self, points, status, message)
    class(contact), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_contact_refit(self%handle, points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), error)
    call finish(code, error, status, message)
  end subroutine

  ! `gaps` has an entry for each point.
  subroutine contact_measure(self, gaps, least, status, message)
    class(contact), intent(inout) :: self
    real(c_double), contiguous, intent(out) :: gaps(:)
    real(c_double), intent(out) :: least
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_contact_measure(self%handle, gaps, size(gaps, kind=c_int64_t), least, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine contact_free(self)
    class(contact), intent(inout) :: self
    call c_contact_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  impure elemental subroutine contact_final(self)
    type(contact), intent(inout) :: self
    call self%free()
  end subroutine

  subroutine moving_new(self, of, options, status, message)
    class(moving_mesh), intent(inout) :: self
    class(mesh), intent(in) :: of
    type(moving_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_moving_options) :: used
    type(texts), allocatable, target :: kept(:)
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    call give_moving_options(options, used, kept)
    code = c_moving_new(of%handle, used, self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine moving_save(self, path, status, message)
    class(moving_mesh), intent(in) :: self
    character(*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_moving_save(self%handle, trim(path)//c_null_char, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine moving_load(self, path, options, status, message)
    class(moving_mesh), intent(inout) :: self
    character(*), intent(in) :: path
    type(moving_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_moving_options) :: used
    type(texts), allocatable, target :: kept(:)
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    call give_moving_options(options, used, kept)
    code = c_moving_load(trim(path)//c_null_char, used, self%handle, error)
    call finish(code, error, status, message)
  end subroutine

  function moving_n_driven(self) result(n)
    class(moving_mesh), intent(in) :: self
    integer(c_int64_t) :: n
    n = c_moving_n_driven(self%handle)
  end function

  ! Allocates places(3, n_driven).
  subroutine moving_driven_places(self, places, status, message)
    class(moving_mesh), intent(in) :: self
    real(c_double), allocatable, intent(out) :: places(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(places(3, self%n_driven()))
    code = c_moving_driven_places(self%handle, places, self%n_driven(), 3_c_int64_t, error)
    call finish(code, error, status, message)
  end subroutine

  function moving_time(self) result(time)
    class(moving_mesh), intent(in) :: self
    real(c_double) :: time
    time = c_moving_time(self%handle)
  end function

  subroutine moving_mesh_copy(self, copy, status, message)
    class(moving_mesh), intent(in) :: self
    type(mesh), intent(inout) :: copy
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call copy%free()
    code = c_mesh_copy(c_moving_mesh(self%handle), copy%handle, error)
    call finish(code, error, status, message)
  end subroutine

  ! Allocates velocity(3, n_points), a column for each point of the current mesh.
  subroutine moving_velocity(self, velocity, status, message)
    class(moving_mesh), intent(in) :: self
    real(c_double), allocatable, intent(out) :: velocity(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    integer(c_int64_t) :: n
    n = c_mesh_n_points(c_moving_mesh(self%handle))
    allocate(velocity(3, n))
    code = c_moving_velocity(self%handle, velocity, n, 3_c_int64_t, error)
    call finish(code, error, status, message)
  end subroutine

  ! Allocates displacement(3, n_points), a column for each point of the current mesh.
  subroutine moving_displacement(self, displacement, status, message)
    class(moving_mesh), intent(in) :: self
    real(c_double), allocatable, intent(out) :: displacement(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    integer(c_int64_t) :: n
    n = c_mesh_n_points(c_moving_mesh(self%handle))
    allocate(displacement(3, n))
    code = c_moving_displacement(self%handle, displacement, n, 3_c_int64_t, error)
    call finish(code, error, status, message)
  end subroutine

  ! `values` has the shape (components, n).
  subroutine moving_set_array(self, on, name, values, status, message)
    class(moving_mesh), intent(inout) :: self
    integer(c_int32_t), intent(in) :: on
    character(*), intent(in) :: name
    real(c_double), contiguous, intent(in) :: values(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_moving_set_array(self%handle, on, trim(name)//c_null_char, values, size(values, 2, c_int64_t), &
        size(values, 1, c_int32_t), error)
    call finish(code, error, status, message)
  end subroutine

  ! displacement(3, n_driven) may have more than three rows.
  subroutine moving_advance(self, time, displacement, step, status, message)
    class(moving_mesh), intent(inout) :: self
    real(c_double), intent(in) :: time
    real(c_double), contiguous, intent(in) :: displacement(:, :)
    type(moving_step), intent(out) :: step
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    step%size = c_sizeof(step)
    code = c_moving_advance(self%handle, time, displacement, size(displacement, 2, c_int64_t), size(displacement, 1, c_int64_t), &
        step, error)
    call finish(code, error, status, message)
  end subroutine

  ! `changes` is the number of changes of connectivity.
  subroutine moving_repair(self, changes, status, message)
    class(moving_mesh), intent(inout) :: self
    integer(c_int64_t), intent(out) :: changes
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_moving_repair(self%handle, changes, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine moving_refine_near(self, surface, at, growth, coarsen, changes, status, message)
    class(moving_mesh), intent(inout) :: self
    class(mesh), intent(in) :: surface
    real(c_double), intent(in) :: at, growth
    logical, intent(in) :: coarsen
    integer(c_int64_t), intent(out) :: changes
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_moving_refine_near(self%handle, surface%handle, at, growth, merge(1_c_int32_t, 0_c_int32_t, coarsen), changes, error)
    call finish(code, error, status, message)
  end subroutine

  subroutine moving_refine_gaps(self, smallest, coarsen, changes, status, message)
    class(moving_mesh), intent(inout) :: self
    real(c_double), intent(in) :: smallest
    logical, intent(in) :: coarsen
    integer(c_int64_t), intent(out) :: changes
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_moving_refine_gaps(self%handle, smallest, merge(1_c_int32_t, 0_c_int32_t, coarsen), changes, error)
    call finish(code, error, status, message)
  end subroutine

  ! The history from the mesh after a step to the current mesh. Where the mesh did not change, has_changed is
  ! false and `changes` is empty: arrays fit as they are.
  subroutine moving_since(self, step, changes, has_changed, status, message)
    class(moving_mesh), intent(in) :: self
    integer(c_int64_t), intent(in) :: step
    type(outcome), intent(inout) :: changes
    logical, intent(out) :: has_changed
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call changes%free()
    code = c_moving_since(self%handle, step, changes%handle, error)
    has_changed = c_associated(changes%handle)
    call finish(code, error, status, message)
  end subroutine

  subroutine moving_free(self)
    class(moving_mesh), intent(inout) :: self
    call c_moving_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  impure elemental subroutine moving_final(self)
    type(moving_mesh), intent(inout) :: self
    call self%free()
  end subroutine

end module motet

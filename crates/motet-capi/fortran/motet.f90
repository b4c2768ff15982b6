! motet for Fortran 2018: arrays as they are, real64 of shape (3, n), ids from 0 as in the files and in C.
!
! Compile this with your program, and link libmotet:
!   gfortran motet.f90 yours.f90 $(pkg-config --libs motet)
!
! motet.h is the reference for what each call does; here are its names without the prefix. Every call that can fail takes two
! optional arguments at its end: `status`, one of MOTET_OK, MOTET_ERROR_.., and `message`, a text that is cut to its length.
! Without `status` an error stops the program and says why. Handles free what they hold when they go out of scope, or by `free`;
! they are not to be copied by assignment.
module motet
  use, intrinsic :: iso_c_binding
  implicit none
  private

  integer(c_int32_t), parameter, public :: MOTET_OK = 0, MOTET_ERROR_INTERNAL = 1, MOTET_ERROR_OPTIONS = 2, MOTET_ERROR_INPUT = 3, &
      MOTET_ERROR_IO = 4
  integer(c_int32_t), parameter, public :: MOTET_LINE = 3, MOTET_TRIANGLE = 5, MOTET_QUAD = 9, MOTET_TETRA = 10, &
      MOTET_HEXAHEDRON = 12, MOTET_WEDGE = 13, MOTET_PYRAMID = 14
  integer(c_int32_t), parameter, public :: MOTET_ON_POINTS = 0, MOTET_ON_CELLS = 1
  integer(c_int32_t), parameter, public :: MOTET_RULE_MEAN = 0, MOTET_RULE_INHERIT = 1, MOTET_RULE_LINEAR = 2
  integer(c_int32_t), parameter, public :: MOTET_DELAUNAY = 0, MOTET_BODIES = 1, MOTET_GUIDED = 2, MOTET_ELASTIC = 3, &
      MOTET_LAPLACE = 4, MOTET_IDW = 5, MOTET_RBF = 6

  ! Options of a mover; members as in motet.h. Lists of patches are what C has: c_loc of an array of c_ptr to texts that end
  ! with c_null_char.
  type, bind(c), public :: mover_options
    integer(c_size_t) :: size = 0
    integer(c_int32_t) :: method = 0, within_walls = 0, smooth = 0, substeps = 50, threads = 1, rigid_layer_cells = 0
    real(c_double) :: rigid_layer = 0, residual = 1e-6_c_double, factor_gib = 0
    type(c_ptr) :: slide = c_null_ptr
    integer(c_int64_t) :: n_slide = 0
    type(c_ptr) :: bodies = c_null_ptr
    integer(c_int64_t) :: n_bodies = 0
    type(c_ptr) :: wall = c_null_ptr
    integer(c_int64_t) :: n_wall = 0
    type(c_ptr) :: also_moved = c_null_ptr
    integer(c_int64_t) :: n_also_moved = 0
    real(c_double) :: slide_tolerance = 0.05_c_double
  end type

  type, bind(c), public :: certificate
    integer(c_size_t) :: size = 0
    integer(c_int32_t) :: complete = 0, substeps = 0
    real(c_double) :: fraction = 0
    integer(c_int64_t) :: inverted = 0, inverted_before = 0, bad = 0, worst_cell = -1
    real(c_double) :: worst_eas = 0, worst_place(3) = 0, seconds = 0
    integer(c_int64_t) :: worst_curved_cell = -1
    real(c_double) :: worst_curved_jacobian = 0
    integer(c_int64_t) :: leaves_plane_vertex = -1
    real(c_double) :: leaves_plane_distance = 0
  end type

  type, bind(c), public :: remesh_options
    integer(c_size_t) :: size = 0
    real(c_double) :: min_eas = 0.2_c_double, min_dihedral_deg = 0
    integer(c_int32_t) :: best = 0, surface = 0
    real(c_double) :: distance = 0
    integer(c_int32_t) :: repair_layers = 0, rounds = 20, threads = 0
    real(c_double) :: edge_length = 0
    type(c_ptr) :: sizes = c_null_ptr
    integer(c_int64_t) :: n_sizes = 0
    type(c_ptr) :: hold = c_null_ptr
    integer(c_int64_t) :: n_hold = 0
  end type

  type, bind(c), public :: implant_options
    integer(c_size_t) :: size = 0
    integer(c_int32_t) :: inside = 0, conform = 0
    real(c_double) :: tolerance = 0
    integer(c_int32_t) :: keep_outside = 0, adapt = 1
    real(c_double) :: stray = -1, edge_length = 0, growth = 0.5_c_double, carve = 1, reach = 3, min_eas = 0.2_c_double
    integer(c_int32_t) :: threads = 0
  end type

  type, bind(c), public :: contact_options
    integer(c_size_t) :: size = 0
    real(c_double) :: warn = 0, within = 0, fold = 3
    integer(c_int32_t) :: own = 0, facing = 0, threads = 0
  end type

  ! Options of a moving mesh; members as in motet.h, lists of names as of mover_options.
  type, bind(c), public :: moving_options
    integer(c_size_t) :: size = 0
    integer(c_int32_t) :: method = 0, within_walls = 0, smooth = 0, rigid_layer_cells = 0
    real(c_double) :: rigid_layer = 0
    type(c_ptr) :: inside = c_null_ptr
    integer(c_int64_t) :: n_inside = 0
    type(c_ptr) :: slide = c_null_ptr
    integer(c_int64_t) :: n_slide = 0
    type(c_ptr) :: bodies = c_null_ptr
    integer(c_int64_t) :: n_bodies = 0
    type(c_ptr) :: wall = c_null_ptr
    integer(c_int64_t) :: n_wall = 0
    integer(c_int32_t) :: no_repair = 0, surface = 0
    real(c_double) :: distance = 0, min_eas = 0.2_c_double, margin = 0.05_c_double, floor = 0.05_c_double
    real(c_double) :: improve_below = 0.75_c_double
    type(c_ptr) :: contents = c_null_ptr
    integer(c_int64_t) :: n_contents = 0
    type(c_ptr) :: watch = c_null_ptr
    integer(c_int64_t) :: n_watch = 0
    real(c_double) :: warn = 0, within = 0, horizon = 0, hold = 0
    integer(c_int32_t) :: remembered = 64, threads = 0
    type(c_ptr) :: hold_names = c_null_ptr
    integer(c_int64_t) :: n_hold_names = 0
    real(c_double) :: slide_tolerance = 0.05_c_double
    integer(c_int32_t) :: valid_at_start = 0, strain_in_band = 0, returns = 0
  end type

  ! What became of a step of a moving mesh.
  type, bind(c), public :: moving_step
    integer(c_size_t) :: size = 0
    integer(c_int64_t) :: step = 0
    real(c_double) :: time = 0
    integer(c_int32_t) :: complete = 0, legs = 0
    real(c_double) :: fraction = 0
    integer(c_int64_t) :: changes = 0, points = 0, tets = 0, bad = 0, forced = 0, inverted = 0, worst_cell = -1
    real(c_double) :: worst_eas = 0, worst_place(3) = 0, gap = 0
    integer(c_int64_t) :: warned = 0, held = 0
    real(c_double) :: touch_not_before = 0, seconds = 0
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

  ! Points after nodes, without a mesh.
  type, public :: point_mover
    private
    type(c_ptr) :: handle = c_null_ptr
  contains
    procedure :: new => point_mover_new
    procedure :: step => point_mover_step
    procedure :: free => point_mover_free
    final :: point_mover_final
  end type

  ! What remesh and implant give: the new mesh by `mesh`, a copy.
  type, public :: outcome
    private
    type(c_ptr) :: handle = c_null_ptr
  contains
    procedure :: remesh => outcome_remesh
    procedure :: implant => outcome_implant
    procedure :: complete => outcome_complete
    procedure :: mesh => outcome_mesh
    procedure :: to_old => outcome_to_old
    procedure :: transfer => outcome_transfer
    procedure :: free => outcome_free
    final :: outcome_final
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

  ! A mesh that moves with its walls and stays good; the mesh as it is by `mesh`, a copy.
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

  public :: motet_version

  interface
    function motet_version() bind(c)
      import
      integer(c_int32_t) :: motet_version
    end function
    function c_error_message(error) bind(c, name='motet_error_message')
      import
      type(c_ptr), value :: error
      type(c_ptr) :: c_error_message
    end function
    subroutine c_error_free(error) bind(c, name='motet_error_free')
      import
      type(c_ptr), value :: error
    end subroutine
    function c_strlen(text) bind(c, name='strlen')
      import
      type(c_ptr), value :: text
      integer(c_size_t) :: c_strlen
    end function
    function c_mesh_new(points, n, stride, mesh, error) bind(c, name='motet_mesh_new')
      import
      real(c_double), intent(in) :: points(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr) :: mesh, error
      integer(c_int32_t) :: c_mesh_new
    end function
    function c_mesh_add_cells(mesh, kind, vertices, n, error) bind(c, name='motet_mesh_add_cells')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: kind
      integer(c_int32_t), intent(in) :: vertices(*)
      integer(c_int64_t), value :: n
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mesh_add_cells
    end function
    function c_mesh_set_points(mesh, points, n, stride, error) bind(c, name='motet_mesh_set_points')
      import
      type(c_ptr), value :: mesh
      real(c_double), intent(in) :: points(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mesh_set_points
    end function
    function c_mesh_read(path, mesh, error) bind(c, name='motet_mesh_read')
      import
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr) :: mesh, error
      integer(c_int32_t) :: c_mesh_read
    end function
    function c_mesh_write(mesh, path, error) bind(c, name='motet_mesh_write')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mesh_write
    end function
    function c_mesh_copy(mesh, copy, error) bind(c, name='motet_mesh_copy')
      import
      type(c_ptr), value :: mesh
      type(c_ptr) :: copy, error
      integer(c_int32_t) :: c_mesh_copy
    end function
    subroutine c_mesh_free(mesh) bind(c, name='motet_mesh_free')
      import
      type(c_ptr), value :: mesh
    end subroutine
    function c_mesh_n_points(mesh) bind(c, name='motet_mesh_n_points')
      import
      type(c_ptr), value :: mesh
      integer(c_int64_t) :: c_mesh_n_points
    end function
    function c_mesh_n_cells(mesh) bind(c, name='motet_mesh_n_cells')
      import
      type(c_ptr), value :: mesh
      integer(c_int64_t) :: c_mesh_n_cells
    end function
    function c_mesh_n_of_kind(mesh, kind) bind(c, name='motet_mesh_n_of_kind')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: kind
      integer(c_int64_t) :: c_mesh_n_of_kind
    end function
    function c_mesh_points(mesh, points, n, stride, error) bind(c, name='motet_mesh_points')
      import
      type(c_ptr), value :: mesh
      real(c_double), intent(out) :: points(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mesh_points
    end function
    function c_mesh_of_kind(mesh, kind, vertices, n, error) bind(c, name='motet_mesh_of_kind')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), value :: kind
      integer(c_int32_t), intent(out) :: vertices(*)
      integer(c_int64_t), value :: n
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mesh_of_kind
    end function
    function c_mesh_eas(mesh, eas, n, error) bind(c, name='motet_mesh_eas')
      import
      type(c_ptr), value :: mesh
      real(c_double), intent(out) :: eas(*)
      integer(c_int64_t), value :: n
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mesh_eas
    end function
    function c_mesh_labels(mesh, labels, n, error) bind(c, name='motet_mesh_labels')
      import
      type(c_ptr), value :: mesh
      integer(c_int32_t), intent(out) :: labels(*)
      integer(c_int64_t), value :: n
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mesh_labels
    end function
    function c_mesh_region(mesh, name) bind(c, name='motet_mesh_region')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int32_t) :: c_mesh_region
    end function
    function c_mesh_patch(mesh, name) bind(c, name='motet_mesh_patch')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int32_t) :: c_mesh_patch
    end function
    function c_mesh_n_patch_vertices(mesh, name) bind(c, name='motet_mesh_n_patch_vertices')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int64_t) :: c_mesh_n_patch_vertices
    end function
    function c_mesh_patch_vertices(mesh, name, vertices, n, error) bind(c, name='motet_mesh_patch_vertices')
      import
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int32_t), intent(out) :: vertices(*)
      integer(c_int64_t), value :: n
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mesh_patch_vertices
    end function
    function c_mover_new(mesh, options, mover, error) bind(c, name='motet_mover_new')
      import
      type(c_ptr), value :: mesh
      type(mover_options), intent(in) :: options
      type(c_ptr) :: mover, error
      integer(c_int32_t) :: c_mover_new
    end function
    subroutine c_mover_free(mover) bind(c, name='motet_mover_free')
      import
      type(c_ptr), value :: mover
    end subroutine
    function c_mover_n_points(mover) bind(c, name='motet_mover_n_points')
      import
      type(c_ptr), value :: mover
      integer(c_int64_t) :: c_mover_n_points
    end function
    function c_mover_n_boundary(mover) bind(c, name='motet_mover_n_boundary')
      import
      type(c_ptr), value :: mover
      integer(c_int64_t) :: c_mover_n_boundary
    end function
    function c_mover_boundary(mover, vertices, n, error) bind(c, name='motet_mover_boundary')
      import
      type(c_ptr), value :: mover
      integer(c_int32_t), intent(out) :: vertices(*)
      integer(c_int64_t), value :: n
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mover_boundary
    end function
    function c_mover_step(mover, displacement, n_boundary, displacement_stride, points, n_points, points_stride, error) &
        bind(c, name='motet_mover_step')
      import
      type(c_ptr), value :: mover
      real(c_double), intent(in) :: displacement(*)
      integer(c_int64_t), value :: n_boundary, displacement_stride, n_points, points_stride
      real(c_double), intent(inout) :: points(*)
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mover_step
    end function
    function c_mover_advance(mover, displacement, n_boundary, displacement_stride, points, n_points, &
        points_stride, reached, error) bind(c, name='motet_mover_advance')
      import
      type(c_ptr), value :: mover
      real(c_double), intent(in) :: displacement(*)
      integer(c_int64_t), value :: n_boundary, displacement_stride, n_points, points_stride
      real(c_double), intent(inout) :: points(*)
      type(certificate), intent(inout) :: reached
      type(c_ptr) :: error
      integer(c_int32_t) :: c_mover_advance
    end function
    function c_point_mover_new(nodes, n_nodes, node_stride, points, n_points, point_stride, threads, mover, error) &
        bind(c, name='motet_point_mover_new')
      import
      real(c_double), intent(in) :: nodes(*), points(*)
      integer(c_int64_t), value :: n_nodes, node_stride, n_points, point_stride
      integer(c_int32_t), value :: threads
      type(c_ptr) :: mover, error
      integer(c_int32_t) :: c_point_mover_new
    end function
    function c_point_mover_step(mover, displacement, n_nodes, displacement_stride, points, n_points, points_stride, error) &
        bind(c, name='motet_point_mover_step')
      import
      type(c_ptr), value :: mover
      real(c_double), intent(in) :: displacement(*)
      integer(c_int64_t), value :: n_nodes, displacement_stride, n_points, points_stride
      real(c_double), intent(inout) :: points(*)
      type(c_ptr) :: error
      integer(c_int32_t) :: c_point_mover_step
    end function
    subroutine c_point_mover_free(mover) bind(c, name='motet_point_mover_free')
      import
      type(c_ptr), value :: mover
    end subroutine
    function c_remesh(mesh, options, outcome, error) bind(c, name='motet_remesh')
      import
      type(c_ptr), value :: mesh
      type(remesh_options), intent(in) :: options
      type(c_ptr) :: outcome, error
      integer(c_int32_t) :: c_remesh
    end function
    function c_implant(host, devices, names, n_devices, options, outcome, error) bind(c, name='motet_implant')
      import
      type(c_ptr), value :: host
      type(c_ptr), intent(in) :: devices(*), names(*)
      integer(c_int64_t), value :: n_devices
      type(implant_options), intent(in) :: options
      type(c_ptr) :: outcome, error
      integer(c_int32_t) :: c_implant
    end function
    function c_outcome_complete(outcome) bind(c, name='motet_outcome_complete')
      import
      type(c_ptr), value :: outcome
      integer(c_int32_t) :: c_outcome_complete
    end function
    function c_outcome_mesh(outcome) bind(c, name='motet_outcome_mesh')
      import
      type(c_ptr), value :: outcome
      type(c_ptr) :: c_outcome_mesh
    end function
    function c_outcome_to_old(outcome, on, old, n, error) bind(c, name='motet_outcome_to_old')
      import
      type(c_ptr), value :: outcome
      integer(c_int32_t), value :: on
      integer(c_int32_t), intent(out) :: old(*)
      integer(c_int64_t), value :: n
      type(c_ptr) :: error
      integer(c_int32_t) :: c_outcome_to_old
    end function
    function c_outcome_transfer(outcome, on, rule, values, n, components, out, n_out, error) bind(c, name='motet_outcome_transfer')
      import
      type(c_ptr), value :: outcome
      integer(c_int32_t), value :: on, rule, components
      real(c_double), intent(in) :: values(*)
      integer(c_int64_t), value :: n, n_out
      real(c_double), intent(out) :: out(*)
      type(c_ptr) :: error
      integer(c_int32_t) :: c_outcome_transfer
    end function
    subroutine c_outcome_free(outcome) bind(c, name='motet_outcome_free')
      import
      type(c_ptr), value :: outcome
    end subroutine
    function c_contact_new(points, n_points, stride, triangles, counts, is_room, n_bodies, options, contact, error) &
        bind(c, name='motet_contact_new')
      import
      real(c_double), intent(in) :: points(*)
      integer(c_int64_t), value :: n_points, stride, n_bodies
      integer(c_int32_t), intent(in) :: triangles(*)
      integer(c_int64_t), intent(in) :: counts(*)
      type(c_ptr), value :: is_room
      type(contact_options), intent(in) :: options
      type(c_ptr) :: contact, error
      integer(c_int32_t) :: c_contact_new
    end function
    function c_contact_refit(contact, points, n_points, stride, error) bind(c, name='motet_contact_refit')
      import
      type(c_ptr), value :: contact
      real(c_double), intent(in) :: points(*)
      integer(c_int64_t), value :: n_points, stride
      type(c_ptr) :: error
      integer(c_int32_t) :: c_contact_refit
    end function
    function c_contact_measure(contact, gaps, n_points, least, error) bind(c, name='motet_contact_measure')
      import
      type(c_ptr), value :: contact
      real(c_double), intent(out) :: gaps(*)
      integer(c_int64_t), value :: n_points
      real(c_double), intent(out) :: least
      type(c_ptr) :: error
      integer(c_int32_t) :: c_contact_measure
    end function
    subroutine c_contact_free(contact) bind(c, name='motet_contact_free')
      import
      type(c_ptr), value :: contact
    end subroutine
    function c_moving_new(mesh, options, moving, error) bind(c, name='motet_moving_new')
      import
      type(c_ptr), value :: mesh
      type(moving_options), intent(in) :: options
      type(c_ptr) :: moving, error
      integer(c_int32_t) :: c_moving_new
    end function
    function c_moving_load(path, options, moving, error) bind(c, name='motet_moving_load')
      import
      character(kind=c_char), intent(in) :: path(*)
      type(moving_options), intent(in) :: options
      type(c_ptr) :: moving, error
      integer(c_int32_t) :: c_moving_load
    end function
    function c_moving_save(moving, path, error) bind(c, name='motet_moving_save')
      import
      type(c_ptr), value :: moving
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr) :: error
      integer(c_int32_t) :: c_moving_save
    end function
    subroutine c_moving_free(moving) bind(c, name='motet_moving_free')
      import
      type(c_ptr), value :: moving
    end subroutine
    function c_moving_n_driven(moving) bind(c, name='motet_moving_n_driven')
      import
      type(c_ptr), value :: moving
      integer(c_int64_t) :: c_moving_n_driven
    end function
    function c_moving_time(moving) bind(c, name='motet_moving_time')
      import
      type(c_ptr), value :: moving
      real(c_double) :: c_moving_time
    end function
    function c_moving_mesh(moving) bind(c, name='motet_moving_mesh')
      import
      type(c_ptr), value :: moving
      type(c_ptr) :: c_moving_mesh
    end function
    function c_moving_driven_places(moving, places, n, stride, error) bind(c, name='motet_moving_driven_places')
      import
      type(c_ptr), value :: moving
      real(c_double), intent(inout) :: places(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr) :: error
      integer(c_int32_t) :: c_moving_driven_places
    end function
    function c_moving_velocity(moving, velocity, n, stride, error) bind(c, name='motet_moving_velocity')
      import
      type(c_ptr), value :: moving
      real(c_double), intent(inout) :: velocity(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr) :: error
      integer(c_int32_t) :: c_moving_velocity
    end function
    function c_moving_displacement(moving, displacement, n, stride, error) bind(c, name='motet_moving_displacement')
      import
      type(c_ptr), value :: moving
      real(c_double), intent(inout) :: displacement(*)
      integer(c_int64_t), value :: n, stride
      type(c_ptr) :: error
      integer(c_int32_t) :: c_moving_displacement
    end function
    function c_moving_set_array(moving, on, name, values, n, components, error) bind(c, name='motet_moving_set_array')
      import
      type(c_ptr), value :: moving
      integer(c_int32_t), value :: on, components
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: values(*)
      integer(c_int64_t), value :: n
      type(c_ptr) :: error
      integer(c_int32_t) :: c_moving_set_array
    end function
    function c_moving_advance(moving, time, displacement, n_driven, stride, step, error) bind(c, name='motet_moving_advance')
      import
      type(c_ptr), value :: moving
      real(c_double), value :: time
      real(c_double), intent(in) :: displacement(*)
      integer(c_int64_t), value :: n_driven, stride
      type(moving_step), intent(inout) :: step
      type(c_ptr) :: error
      integer(c_int32_t) :: c_moving_advance
    end function
    function c_moving_repair(moving, changes, error) bind(c, name='motet_moving_repair')
      import
      type(c_ptr), value :: moving
      integer(c_int64_t), intent(out) :: changes
      type(c_ptr) :: error
      integer(c_int32_t) :: c_moving_repair
    end function
    function c_moving_refine_near(moving, surface, at, growth, coarsen, changes, error) bind(c, name='motet_moving_refine_near')
      import
      type(c_ptr), value :: moving, surface
      real(c_double), value :: at, growth
      integer(c_int32_t), value :: coarsen
      integer(c_int64_t), intent(out) :: changes
      type(c_ptr) :: error
      integer(c_int32_t) :: c_moving_refine_near
    end function
    function c_moving_refine_gaps(moving, smallest, coarsen, changes, error) bind(c, name='motet_moving_refine_gaps')
      import
      type(c_ptr), value :: moving
      real(c_double), value :: smallest
      integer(c_int32_t), value :: coarsen
      integer(c_int64_t), intent(out) :: changes
      type(c_ptr) :: error
      integer(c_int32_t) :: c_moving_refine_gaps
    end function
    function c_moving_since(moving, step, outcome, error) bind(c, name='motet_moving_since')
      import
      type(c_ptr), value :: moving
      integer(c_int64_t), value :: step
      type(c_ptr) :: outcome, error
      integer(c_int32_t) :: c_moving_since
    end function
  end interface

contains

  ! Tells the caller how a call ended, or stops.
  subroutine tell(code, error, status, message)
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

  subroutine mesh_new(self, points, status, message)
    class(mesh), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    code = c_mesh_new(points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), self%handle, error)
    call tell(code, error, status, message)
  end subroutine

  subroutine mesh_read(self, path, status, message)
    class(mesh), intent(inout) :: self
    character(*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    code = c_mesh_read(trim(path)//c_null_char, self%handle, error)
    call tell(code, error, status, message)
  end subroutine

  subroutine mesh_write(self, path, status, message)
    class(mesh), intent(in) :: self
    character(*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_write(self%handle, trim(path)//c_null_char, error)
    call tell(code, error, status, message)
  end subroutine

  ! vertices has a column for each cell.
  subroutine mesh_add_cells(self, kind, vertices, status, message)
    class(mesh), intent(inout) :: self
    integer(c_int32_t), intent(in) :: kind
    integer(c_int32_t), contiguous, intent(in) :: vertices(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_add_cells(self%handle, kind, vertices, size(vertices, 2, c_int64_t), error)
    call tell(code, error, status, message)
  end subroutine

  subroutine mesh_set_points(self, points, status, message)
    class(mesh), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_set_points(self%handle, points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), error)
    call tell(code, error, status, message)
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

  ! Allocated here: (3, n_points).
  subroutine mesh_points(self, points, status, message)
    class(mesh), intent(in) :: self
    real(c_double), allocatable, intent(out) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(points(3, self%n_points()))
    code = c_mesh_points(self%handle, points, self%n_points(), 3_c_int64_t, error)
    call tell(code, error, status, message)
  end subroutine

  ! Allocated here: a column of so many vertices for each cell of the kind.
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
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
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

  ! Allocated here: the vertices of a patch, rising.
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
    call tell(code, error, status, message)
  end subroutine

  subroutine mesh_free(self)
    class(mesh), intent(inout) :: self
    call c_mesh_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  subroutine mesh_final(self)
    type(mesh), intent(inout) :: self
    call self%free()
  end subroutine

  subroutine mover_new(self, of, options, status, message)
    class(mover), intent(inout) :: self
    class(mesh), intent(in) :: of
    type(mover_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(mover_options) :: asked
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) asked = options
    asked%size = c_sizeof(asked)
    code = c_mover_new(of%handle, asked, self%handle, error)
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
  end subroutine

  ! displacement (3, n_boundary) and points (3, n_points) are read and written where they lie; more rows than three are strides.
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
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
  end subroutine

  subroutine mover_free(self)
    class(mover), intent(inout) :: self
    call c_mover_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  subroutine mover_final(self)
    type(mover), intent(inout) :: self
    call self%free()
  end subroutine

  ! nodes (3, n_nodes): those of the whole boundary, wherever it is; points (3, n_points): those that follow.
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
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
  end subroutine

  subroutine point_mover_free(self)
    class(point_mover), intent(inout) :: self
    call c_point_mover_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  subroutine point_mover_final(self)
    type(point_mover), intent(inout) :: self
    call self%free()
  end subroutine

  subroutine outcome_remesh(self, of, options, status, message)
    class(outcome), intent(inout) :: self
    class(mesh), intent(in) :: of
    type(remesh_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(remesh_options) :: asked
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) asked = options
    asked%size = c_sizeof(asked)
    code = c_remesh(of%handle, asked, self%handle, error)
    call tell(code, error, status, message)
  end subroutine

  ! One device; what is in it and its surface get its name.
  subroutine outcome_implant(self, host, device, name, options, status, message)
    class(outcome), intent(inout) :: self
    class(mesh), intent(in) :: host, device
    character(*), intent(in) :: name
    type(implant_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(implant_options) :: asked
    character(kind=c_char), target :: letters(len_trim(name) + 1)
    type(c_ptr) :: devices(1), names(1), error
    integer(c_int32_t) :: code, i
    call self%free()
    if (present(options)) asked = options
    asked%size = c_sizeof(asked)
    do i = 1, len_trim(name)
      letters(i) = name(i:i)
    end do
    letters(len_trim(name) + 1) = c_null_char
    devices(1) = device%handle
    names(1) = c_loc(letters)
    code = c_implant(host%handle, devices, names, 1_c_int64_t, asked, self%handle, error)
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
  end subroutine

  ! values has a column for each old point or cell, new one for each new.
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
    call tell(code, error, status, message)
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

  subroutine outcome_final(self)
    type(outcome), intent(inout) :: self
    call self%free()
  end subroutine

  ! triangles has a column for each triangle of all bodies, one body after the other; counts the number of each.
  subroutine contact_new(self, points, triangles, counts, options, status, message)
    class(contact), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: points(:, :)
    integer(c_int32_t), contiguous, intent(in) :: triangles(:, :)
    integer(c_int64_t), intent(in) :: counts(:)
    type(contact_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(contact_options) :: asked
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) asked = options
    asked%size = c_sizeof(asked)
    code = c_contact_new(points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), triangles, counts, c_null_ptr, &
        size(counts, kind=c_int64_t), asked, self%handle, error)
    call tell(code, error, status, message)
  end subroutine

  subroutine contact_refit(self, points, status, message)
    class(contact), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: points(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_contact_refit(self%handle, points, size(points, 2, c_int64_t), size(points, 1, c_int64_t), error)
    call tell(code, error, status, message)
  end subroutine

  ! gaps has an entry for each point.
  subroutine contact_measure(self, gaps, least, status, message)
    class(contact), intent(inout) :: self
    real(c_double), contiguous, intent(out) :: gaps(:)
    real(c_double), intent(out) :: least
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_contact_measure(self%handle, gaps, size(gaps, kind=c_int64_t), least, error)
    call tell(code, error, status, message)
  end subroutine

  subroutine contact_free(self)
    class(contact), intent(inout) :: self
    call c_contact_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  subroutine contact_final(self)
    type(contact), intent(inout) :: self
    call self%free()
  end subroutine

  subroutine moving_new(self, of, options, status, message)
    class(moving_mesh), intent(inout) :: self
    class(mesh), intent(in) :: of
    type(moving_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(moving_options) :: asked
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) asked = options
    asked%size = c_sizeof(asked)
    code = c_moving_new(of%handle, asked, self%handle, error)
    call tell(code, error, status, message)
  end subroutine

  subroutine moving_save(self, path, status, message)
    class(moving_mesh), intent(in) :: self
    character(*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_moving_save(self%handle, trim(path)//c_null_char, error)
    call tell(code, error, status, message)
  end subroutine

  subroutine moving_load(self, path, options, status, message)
    class(moving_mesh), intent(inout) :: self
    character(*), intent(in) :: path
    type(moving_options), intent(in), optional :: options
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(moving_options) :: asked
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) asked = options
    asked%size = c_sizeof(asked)
    code = c_moving_load(trim(path)//c_null_char, asked, self%handle, error)
    call tell(code, error, status, message)
  end subroutine

  function moving_n_driven(self) result(n)
    class(moving_mesh), intent(in) :: self
    integer(c_int64_t) :: n
    n = c_moving_n_driven(self%handle)
  end function

  ! Allocated here: (3, n_driven).
  subroutine moving_driven_places(self, places, status, message)
    class(moving_mesh), intent(in) :: self
    real(c_double), allocatable, intent(out) :: places(:, :)
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    allocate(places(3, self%n_driven()))
    code = c_moving_driven_places(self%handle, places, self%n_driven(), 3_c_int64_t, error)
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
  end subroutine

  ! Allocated here, and those below: (3, n_points) of the mesh as it is.
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
    call tell(code, error, status, message)
  end subroutine

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
    call tell(code, error, status, message)
  end subroutine

  ! values (components, n)
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
    call tell(code, error, status, message)
  end subroutine

  ! displacement (3, n_driven); more rows than three are a stride.
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
    call tell(code, error, status, message)
  end subroutine

  ! changes: how often connectivity was changed.
  subroutine moving_repair(self, changes, status, message)
    class(moving_mesh), intent(inout) :: self
    integer(c_int64_t), intent(out) :: changes
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_moving_repair(self%handle, changes, error)
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
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
    call tell(code, error, status, message)
  end subroutine

  ! From the mesh after a step to the mesh as it is; has_changed is false where arrays serve as they are, and `changes` is empty.
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
    call tell(code, error, status, message)
  end subroutine

  subroutine moving_free(self)
    class(moving_mesh), intent(inout) :: self
    call c_moving_free(self%handle)
    self%handle = c_null_ptr
  end subroutine

  subroutine moving_final(self)
    type(moving_mesh), intent(inout) :: self
    call self%free()
  end subroutine

end module motet

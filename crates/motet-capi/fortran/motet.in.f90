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
! A list of names in options is a list of C: c_loc of an array of c_ptr to texts that end with c_null_char.
module motet
  use, intrinsic :: iso_c_binding
  implicit none
  private

  public :: motet_version
  public :: mover_options, certificate, remesh_options, implant_options, contact_options, moving_options
  public :: moving_step

  !{constants}
  !{types}
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

  ! The result of `remesh` and `implant`; `mesh` copies the new mesh.
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

  !{interfaces}
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
    call finish(code, error, status, message)
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
    call finish(code, error, status, message)
  end subroutine

  subroutine mesh_write(self, path, status, message)
    class(mesh), intent(in) :: self
    character(*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    character(*), intent(inout), optional :: message
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    code = c_mesh_write(self%handle, trim(path)//c_null_char, error)
    call finish(code, error, status, message)
  end subroutine

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
    type(mover_options) :: used
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) used = options
    used%size = c_sizeof(used)
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

  subroutine mover_final(self)
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
    type(remesh_options) :: used
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) used = options
    used%size = c_sizeof(used)
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
    type(implant_options) :: used
    character(kind=c_char), target :: letters(len_trim(name) + 1)
    type(c_ptr) :: devices(1), names(1), error
    integer(c_int32_t) :: code, i
    call self%free()
    if (present(options)) used = options
    used%size = c_sizeof(used)
    do i = 1, len_trim(name)
      letters(i) = name(i:i)
    end do
    letters(len_trim(name) + 1) = c_null_char
    devices(1) = device%handle
    names(1) = c_loc(letters)
    code = c_implant(host%handle, devices, names, 1_c_int64_t, used, self%handle, error)
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

  subroutine outcome_final(self)
    type(outcome), intent(inout) :: self
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
    type(contact_options) :: used
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) used = options
    used%size = c_sizeof(used)
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
    type(moving_options) :: used
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) used = options
    used%size = c_sizeof(used)
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
    type(moving_options) :: used
    type(c_ptr) :: error
    integer(c_int32_t) :: code
    call self%free()
    if (present(options)) used = options
    used%size = c_sizeof(used)
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

  subroutine moving_final(self)
    type(moving_mesh), intent(inout) :: self
    call self%free()
  end subroutine

end module motet

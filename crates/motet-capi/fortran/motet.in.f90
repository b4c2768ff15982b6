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

  !{constants}
  !{types}
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

  !{conversions}
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

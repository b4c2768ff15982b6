! Tests the Fortran module: lists in options, long calls, refinement, filling. Prints one line, or the first check that fails.
module listeners
  use, intrinsic :: iso_c_binding
  implicit none
  integer :: n_told = 0, stop_at = 0
  logical :: is_wrong = .false.
  character(:), allocatable :: last_stage

contains

  function listen(stage, done, of) result(stops)
    character(*), intent(in) :: stage
    integer(c_int64_t), intent(in) :: done, of
    logical :: stops
    n_told = n_told + 1
    last_stage = stage
    is_wrong = is_wrong .or. done < 0 .or. (of > 0 .and. done > of)
    stops = n_told == stop_at
  end function

end module

program client
  use, intrinsic :: iso_c_binding
  use motet
  use listeners
  implicit none
  integer, parameter :: n = 6

  call lists()
  call notes()
  call long_calls()
  call refining()
  print '(a)', 'all checks of the Fortran module passed'

contains

  subroutine check(is_so, what)
    logical, intent(in) :: is_so
    character(*), intent(in) :: what
    if (.not. is_so) error stop 'check failed: '//what
  end subroutine

  integer function corner(i, j, k)
    integer, intent(in) :: i, j, k
    corner = (k*(n + 1) + j)*(n + 1) + i
  end function

  ! The unit cube: each cell of a grid cut into six tets around its diagonal; floor and roof are patches.
  subroutine cube(new)
    type(mesh), intent(inout) :: new
    real(c_double) :: points(3, (n + 1)**3)
    integer(c_int32_t) :: tets(4, 6*n**3), triangles(3, 4*n**2), labels(6*n**3 + 4*n**2)
    integer, parameter :: paths(3, 7) = reshape([1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 1, 1, 0, 0], [3, 7])
    integer :: i, j, k, p, t, s
    t = 0
    do k = 0, n
      do j = 0, n
        do i = 0, n
          points(:, corner(i, j, k) + 1) = real([i, j, k], c_double)/n
        end do
      end do
    end do
    do k = 0, n - 1
      do j = 0, n - 1
        do i = 0, n - 1
          do p = 1, 6
            t = t + 1
            tets(:, t) = [corner(i, j, k), corner(i + paths(1, p), j + paths(2, p), k + paths(3, p)), &
                corner(i + paths(1, p + 1), j + paths(2, p + 1), k + paths(3, p + 1)), corner(i + 1, j + 1, k + 1)]
          end do
        end do
      end do
    end do
    s = 0
    do k = 0, n, n
      do j = 0, n - 1
        do i = 0, n - 1
          triangles(:, s + 1) = [corner(i, j, k), corner(i + 1, j + 1, k), corner(i + 1, j, k)]
          triangles(:, s + 2) = [corner(i, j, k), corner(i, j + 1, k), corner(i + 1, j + 1, k)]
          s = s + 2
        end do
      end do
    end do
    labels(:6*n**3) = 1
    labels(6*n**3 + 1:6*n**3 + 2*n**2) = 2
    labels(6*n**3 + 2*n**2 + 1:) = 3
    call new%new(points)
    call new%add_cells(MOTET_TETRA, tets)
    call new%add_cells(MOTET_TRIANGLE, triangles)
    call new%set_labels(labels)
    call new%name_region(1, 'block')
    call new%name_patch(2, 'floor')
    call new%name_patch(3, 'roof')
  end subroutine

  subroutine octahedron(new, radius)
    type(mesh), intent(inout) :: new
    real(c_double), intent(in) :: radius
    real(c_double) :: points(3, 6)
    integer :: i
    points = 0.5_c_double
    do i = 1, 3
      points(i, 2*i - 1) = 0.5_c_double + radius
      points(i, 2*i) = 0.5_c_double - radius
    end do
    call new%new(points)
    call new%add_cells(MOTET_TRIANGLE, reshape([0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5], [3, 8]))
  end subroutine

  ! Names and numbers in options are arrays of Fortran.
  subroutine lists()
    type(mesh) :: block, new
    type(mover) :: mine
    type(mover_options) :: options, same
    type(moving_mesh) :: moving
    type(moving_options) :: loop
    type(moving_step) :: step
    type(outcome) :: finer
    type(remesh_options) :: repair
    integer(c_int32_t) :: status
    character(200) :: message
    real(c_double), allocatable :: displacement(:, :), values(:, :)
    call cube(block)
    call check(block%region('block') == 1 .and. block%patch('roof') == 3, 'names of labels')
    call mine%new(block, options)
    call check(mine%n_boundary() == (n + 1)**3 - (n - 1)**3, 'nothing slides')
    options%slide = [character(8) :: 'floor', 'roof']
    same = options
    call mine%new(block, same, status, message)
    call check(status == MOTET_OK, 'patches slide')
    options%slide = [character(8) :: 'floor', 'cellar', 'roof']
    call mine%new(block, options, status, message)
    call check(status == MOTET_ERROR_OPTIONS .and. index(message, 'cellar`') > 0, 'a patch that does not exist')
    deallocate(options%slide)
    options%also_moved = [corner(3, 3, 3), corner(2, 3, 3)]
    call mine%new(block, options)
    call check(mine%n_boundary() == (n + 1)**3 - (n - 1)**3 + 2, 'inner vertices that are moved')
    options%also_moved = [integer(c_int32_t) ::]
    call mine%new(block, options)
    call check(mine%n_boundary() == (n + 1)**3 - (n - 1)**3, 'an empty list')

    allocate(values(1, block%n_cells()), source=2.0_c_double)
    call block%set_array(MOTET_ON_CELLS, 'density', values)
    loop%watch = ['floor', 'roof ']
    loop%contents = ['density']
    call moving%new(block, loop)
    allocate(displacement(3, moving%n_driven()), source=0.0_c_double)
    call moving%advance(1.0_c_double, displacement, step)
    call check(step%complete == 1 .and. abs(step%gap - 1) < 1e-12_c_double, 'watched patches')
    call moving%mesh(new)
    deallocate(values)
    call new%array(MOTET_ON_CELLS, 'density', values)
    call check(size(values, 1) == 1 .and. all(values == 2), 'an array that is kept')

    allocate(repair%sizes(block%n_points()), source=0.1_c_double)
    repair%hold = ['floor']
    call finer%remesh(block, repair)
    call finer%mesh(new)
    call check(new%n_points() > block%n_points(), 'sizes at points')
    repair%sizes = [0.1_c_double]
    call finer%remesh(block, repair, status)
    call check(status /= MOTET_OK, 'sizes of another mesh')
  end subroutine

  subroutine notes()
    type(mesh) :: block, read
    character(:), allocatable :: lost
    integer :: unit
    call cube(block)
    call block%write('client_f.off', lost=lost)
    call check(len(lost) > 0, 'what is lost')
    call block%write('client_f.vtu', lost=lost)
    call check(len(lost) == 0, 'nothing is lost')
    call read%read('client_f.vtu', notes=lost)
    call check(len(lost) == 0 .and. read%patch('floor') == 2, 'nothing is skipped')
    open (newunit=unit, file='client_f.vtu')
    close (unit, status='delete')
    open (newunit=unit, file='client_f.off')
    close (unit, status='delete')
  end subroutine

  ! A repair is stopped ever later, until it is done.
  subroutine long_calls()
    type(mesh) :: block, new
    type(remesh_options) :: options
    type(watch), target :: mine, silent
    type(outcome) :: finer
    real(c_double), allocatable :: plain(:, :), points(:, :)
    character(:), allocatable :: stage
    character(200) :: message
    integer(c_int64_t) :: done, of
    integer(c_int32_t) :: status
    integer :: n_stopped
    call cube(block)
    options%edge_length = 0.11_c_double
    call finer%remesh(block, options)
    call finer%mesh(new)
    call new%points(plain)
    call mine%new(listen, 2e-4_c_double)
    options%watched_by => mine
    n_stopped = 0
    stop_at = 1
    do
      n_told = 0
      call finer%remesh(block, options, status, message)
      if (status == MOTET_OK) exit
      call check(status == MOTET_ERROR_STOPPED .and. index(message, 'stopped on request') > 0, 'it was stopped')
      call check(n_told == stop_at, 'nobody is told after a stop')
      n_stopped = n_stopped + 1
      stop_at = 4*stop_at
    end do
    call check(n_stopped > 1 .and. n_told > 0 .and. len(last_stage) > 0 .and. .not. is_wrong, 'progress is told')
    call finer%mesh(new)
    call new%points(points)
    call check(size(points, 2) == size(plain, 2), 'the same points')
    call check(all(points == plain), 'the same places')
    call mine%progress(stage, done, of)
    call check(len(stage) > 0 .and. done >= 0, 'the last progress')

    call silent%new()
    options%watched_by => silent
    call silent%stop()
    call finer%remesh(block, options, status)
    call check(status == MOTET_ERROR_STOPPED, 'a request before the call')
    call finer%remesh(block, options)
  end subroutine

  subroutine refining()
    type(mesh) :: block, device, surfaces(1), new
    type(refinement) :: levels
    type(refinement_options) :: options
    type(fill_options) :: sizes
    type(outcome) :: changes, filled
    type(watch), target :: silent
    integer(c_int32_t), allocatable :: generations(:)
    integer(c_int32_t) :: status
    integer(c_int64_t) :: before
    character(200) :: message
    call cube(block)
    call octahedron(device, 0.1_c_double)
    call silent%new()
    options%watched_by => silent
    call levels%new(block, options)
    call silent%stop()
    call levels%near(device, 0.05_c_double, 0.5_c_double, changes, status)
    call levels%mesh(new)
    call check(status == MOTET_ERROR_STOPPED .and. new%n_cells() == block%n_cells(), 'a refinement that is stopped')
    call levels%near(device, 0.05_c_double, 0.5_c_double, changes)
    call check(changes%complete(), 'a refinement')
    before = 0
    do
      call levels%mesh(new)
      if (new%n_cells() == before) exit
      before = new%n_cells()
      call levels%generations(generations)
      call levels%coarsen(merge(1, 0, generations > 0))
    end do
    call check(before == block%n_cells(), 'divisions taken back')
    generations = 0
    generations(1) = 1
    call levels%divide(generations, changes)
    call changes%mesh(new)
    call check(new%n_cells() > before, 'a tet is divided')

    call octahedron(surfaces(1), 0.2_c_double)
    sizes%edge_length = 0.04_c_double
    call filled%fill(surfaces, ['seed'], sizes)
    call filled%mesh(new)
    call check(new%n_of_kind(MOTET_TETRA) > 8 .and. new%patch('seed') > 0, 'a surface is filled')
    call filled%fill(surfaces, ['a', 'b'], sizes, status, message)
    call check(status == MOTET_ERROR_OPTIONS .and. index(message, 'names') > 0, 'each surface has a name')
  end subroutine

end program

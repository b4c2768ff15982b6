! Runs the small cases of testdata by the Fortran module: prints a name and a number a line, as ctest/cases.c does.
program cases
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use motet, only: mesh, mover, outcome, contact, moving_mesh, mover_options, certificate, moving_options, moving_step, &
      MOTET_TRIANGLE, MOTET_TETRA, MOTET_ON_POINTS, MOTET_RULE_MEAN, MOTET_ERROR_IO
  implicit none

  call errors_are_reported()
  select case (word(1))
  case ('repair')
    call repair()
  case ('implant')
    call put_in()
  case ('contact')
    call measure()
  case ('loop')
    call there_and_back()
  case default
    error stop 2
  end select

contains

  function word(i) result(text)
    integer, intent(in) :: i
    character(:), allocatable :: text
    integer :: n
    call get_command_argument(i, length=n)
    allocate(character(len=n) :: text)
    call get_command_argument(i, text)
  end function

  function number(i) result(x)
    integer, intent(in) :: i
    real(c_double) :: x
    character(:), allocatable :: text
    text = word(i)
    read (text, *) x
  end function

  subroutine report(name, value)
    character(*), intent(in) :: name
    real(c_double), intent(in) :: value
    write (*, '(a,1x,es25.17e3)') name, value
  end subroutine

  subroutine errors_are_reported()
    type(mesh) :: none
    character(200) :: message
    integer(c_int32_t) :: status
    call none%read('/nowhere/mesh.vtu', status, message)
    if (status /= MOTET_ERROR_IO .or. index(message, '/nowhere/mesh.vtu') == 0) error stop 'an error is not reported'
  end subroutine

  subroutine report_mesh(of)
    type(mesh), intent(in) :: of
    real(c_double), allocatable :: points(:, :), eas(:)
    real(c_double) :: sums(3)
    integer :: i
    call of%points(points)
    call of%eas(eas)
    sums = 0
    do i = 1, size(points, 2)
      sums = sums + points(:, i)
    end do
    call report('points', real(of%n_points(), c_double))
    call report('tets', real(of%n_of_kind(MOTET_TETRA), c_double))
    call report('sum_x', sums(1))
    call report('sum_y', sums(2))
    call report('sum_z', sums(3))
    call report('worst_eas', min(1.0_c_double, minval(eas, mask=.not. ieee_is_nan(eas))))
  end subroutine

  subroutine repair()
    type(mesh) :: moving, repaired
    type(mover) :: mine
    type(mover_options) :: options
    type(certificate) :: reached
    type(outcome) :: done
    integer(c_int32_t), allocatable :: patch(:), boundary(:)
    real(c_double), allocatable :: displacement(:, :), points(:, :), carried(:, :)
    real(c_double) :: total
    integer :: i
    call moving%read(word(2))
    call moving%patch_vertices(word(3), patch)
    options%smooth = nint(number(7))
    call mine%new(moving, options)
    call mine%boundary(boundary)
    allocate(displacement(3, size(boundary)), points(3, mine%n_points()))
    do i = 1, size(boundary)
      displacement(:, i) = 0
      if (any(patch == boundary(i))) displacement(:, i) = [number(4), number(5), number(6)]
    end do
    call mine%advance(displacement, points, reached)
    call report('complete', real(reached%complete, c_double))
    call report('bad_after_motion', real(reached%bad, c_double))
    call report('worst_after_motion', reached%worst_eas)
    call moving%set_points(points)
    call done%remesh(moving)
    call report('repaired', merge(1.0_c_double, 0.0_c_double, done%complete()))
    call done%mesh(repaired)
    call report_mesh(repaired)
    call done%transfer(MOTET_ON_POINTS, MOTET_RULE_MEAN, points(1:1, :), carried)
    total = 0
    do i = 1, size(carried, 2)
      total = total + carried(1, i)
    end do
    call report('sum_carried', total)
  end subroutine

  subroutine put_in()
    type(mesh) :: host, device, new
    type(outcome) :: done
    call host%read(word(2))
    call device%read(word(3))
    call done%implant(host, device, word(4))
    call done%mesh(new)
    call report('complete', merge(1.0_c_double, 0.0_c_double, done%complete()))
    call report('region', real(new%region(word(4)), c_double))
    call report_mesh(new)
  end subroutine

  subroutine measure()
    type(mesh) :: first, second
    type(contact) :: both
    real(c_double), allocatable :: a(:, :), b(:, :), points(:, :), gaps(:)
    integer(c_int32_t), allocatable :: of_a(:, :), of_b(:, :), triangles(:, :)
    integer(c_int64_t) :: counts(2)
    real(c_double) :: least, total
    integer :: i
    call first%read(word(2))
    call second%read(word(3))
    call first%points(a)
    call second%points(b)
    call first%of_kind(MOTET_TRIANGLE, 3, of_a)
    call second%of_kind(MOTET_TRIANGLE, 3, of_b)
    points = reshape([a, b], [3, size(a, 2) + size(b, 2)])
    triangles = reshape([of_a, of_b + size(a, 2)], [3, size(of_a, 2) + size(of_b, 2)])
    counts = [size(of_a, 2), size(of_b, 2)]
    call both%new(points, triangles, counts)
    allocate(gaps(size(points, 2)))
    call both%measure(gaps, least)
    total = 0
    do i = 1, size(gaps)
      if (ieee_is_finite(gaps(i))) total = total + gaps(i)
    end do
    call report('least', least)
    call report('sum_of_gaps', total)
  end subroutine

  subroutine there_and_back()
    type(mesh) :: first, last
    type(moving_mesh) :: moving
    type(moving_options) :: options
    type(moving_step) :: reached
    type(outcome) :: changes
    integer(c_int32_t), allocatable :: patch(:)
    real(c_double), allocatable :: points(:, :), places(:, :), shifts(:, :), x(:, :), carried(:, :), velocity(:, :)
    real(c_double) :: total, part
    integer(c_int64_t) :: n_changes, k, n_steps
    integer :: i, next
    logical :: has_changed
    character(:), allocatable :: state
    n_steps = nint(number(7))
    state = word(2)//'.state.vtu'
    call first%read(word(2))
    call first%points(points)
    call first%patch_vertices(word(3), patch)
    options%smooth = 2
    call moving%new(first, options)
    call moving%driven_places(places)
    allocate(shifts, mold=places)
    shifts = 0
    next = 1
    do i = 1, size(places, 2) ! driven vertices and those of the patch are in ascending order
      if (next > size(patch)) exit
      if (all(places(:, i) == points(:, patch(next) + 1))) then
        shifts(:, i) = [number(4), number(5), number(6)]
        next = next + 1
      end if
    end do
    x = points(1:1, :)
    n_changes = 0
    do k = 1, 2*n_steps
      part = real(min(k, 2*n_steps - k), c_double)/real(n_steps, c_double)
      call moving%advance(real(k, c_double), part*shifts, reached)
      if (reached%complete /= 1 .or. reached%bad > 0 .or. reached%inverted > 0) error stop 'a step is not as it should be'
      n_changes = n_changes + reached%changes
      call moving%since(k - 1, changes, has_changed)
      if (has_changed) then
        call changes%transfer(MOTET_ON_POINTS, MOTET_RULE_MEAN, x, carried)
        call move_alloc(carried, x)
      end if
      if (k == n_steps) then
        call moving%save(state)
        call moving%load(state, options)
      end if
    end do
    call moving%velocity(velocity)
    call report('changes', real(n_changes, c_double))
    call report('time', moving%time())
    total = 0
    do i = 1, size(velocity, 2)
      total = total + velocity(1, i)
    end do
    call report('sum_velocity', total)
    total = 0
    do i = 1, size(x, 2)
      total = total + x(1, i)
    end do
    call report('sum_carried', total)
    call moving%mesh(last)
    call report_mesh(last)
  end subroutine

end program

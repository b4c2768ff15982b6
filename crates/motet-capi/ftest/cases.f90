! The small cases of testdata, by the Fortran module: prints a name and a number a line. Calls are as those of ctest/cases.c.
program cases
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use motet, only: mesh, mover, outcome, contact, mover_options, certificate, MOTET_TRIANGLE, MOTET_TETRA, &
      MOTET_ON_POINTS, MOTET_RULE_MEAN, MOTET_ERROR_IO
  implicit none

  call errors_are_told()
  select case (word(1))
  case ('repair')
    call repair()
  case ('implant')
    call put_in()
  case ('contact')
    call measure()
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

  subroutine told(name, value)
    character(*), intent(in) :: name
    real(c_double), intent(in) :: value
    write (*, '(a,1x,es25.17e3)') name, value
  end subroutine

  subroutine errors_are_told()
    type(mesh) :: none
    character(200) :: message
    integer(c_int32_t) :: status
    call none%read('/nowhere/mesh.vtu', status, message)
    if (status /= MOTET_ERROR_IO .or. index(message, '/nowhere/mesh.vtu') == 0) error stop 'an error is not told'
  end subroutine

  subroutine tell_mesh(of)
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
    call told('points', real(of%n_points(), c_double))
    call told('tets', real(of%n_of_kind(MOTET_TETRA), c_double))
    call told('sum_x', sums(1))
    call told('sum_y', sums(2))
    call told('sum_z', sums(3))
    call told('worst_eas', min(1.0_c_double, minval(eas, mask=.not. ieee_is_nan(eas))))
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
    call told('complete', real(reached%complete, c_double))
    call told('bad_after_motion', real(reached%bad, c_double))
    call told('worst_after_motion', reached%worst_eas)
    call moving%set_points(points)
    call done%remesh(moving)
    call told('repaired', merge(1.0_c_double, 0.0_c_double, done%complete()))
    call done%mesh(repaired)
    call tell_mesh(repaired)
    call done%transfer(MOTET_ON_POINTS, MOTET_RULE_MEAN, points(1:1, :), carried)
    total = 0
    do i = 1, size(carried, 2)
      total = total + carried(1, i)
    end do
    call told('sum_carried', total)
  end subroutine

  subroutine put_in()
    type(mesh) :: host, device, new
    type(outcome) :: done
    call host%read(word(2))
    call device%read(word(3))
    call done%implant(host, device, word(4))
    call done%mesh(new)
    call told('complete', merge(1.0_c_double, 0.0_c_double, done%complete()))
    call told('region', real(new%region(word(4)), c_double))
    call tell_mesh(new)
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
    call told('least', least)
    call told('sum_of_gaps', total)
  end subroutine

end program

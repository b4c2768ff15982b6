! A user's subroutine in Fortran, as solvers call it once a step: `x` has the coordinates of all nodes, which are updated;
! `on_walls` are the numbers of the nodes on walls, from 1.
!
! The motion of the walls is prescribed: here a sphere at the origin swings. The first call sets up the graph. It was run
! with stand-in/solver.f90, not in a commercial solver; adapt names and arguments to those of your solver.
subroutine user_grid(n_points, x, n_walls, on_walls, time)
  use, intrinsic :: iso_c_binding
  use motet, only: point_mover
  implicit none
  integer, intent(in) :: n_points, n_walls
  real(c_double), intent(inout) :: x(3, n_points)
  integer, intent(in) :: on_walls(n_walls)
  real(c_double), intent(in) :: time

  type(point_mover), save :: mover
  real(c_double), allocatable, save :: first(:, :)
  real(c_double) :: displacement(3, n_walls)
  integer :: i

  if (.not. allocated(first)) then
    first = x(:, on_walls)
    call mover%new(first, x)
  end if
  displacement = 0
  do i = 1, n_walls
    if (sum(first(:, i)**2) < 1.01) displacement(1, i) = 0.5 * sin(6.2832 * time)
  end do
  call mover%step(displacement, x)
end subroutine

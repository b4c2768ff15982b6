! Stands in for a solver that calls a user's Fortran subroutine once a step with its own arrays, as CFX and CFD-ACE+ do:
! calls user_grid.f90 with a tiny mesh. It contains no code of these solvers.
program solver
  use, intrinsic :: iso_c_binding
  implicit none
  integer, parameter :: n_points = 13, n_walls = 12
  real(c_double) :: x(3, n_points)
  integer :: on_walls(n_walls), i
  interface
    subroutine user_grid(n_points, x, n_walls, on_walls, time)
      import
      integer, intent(in) :: n_points, n_walls
      real(c_double), intent(inout) :: x(3, n_points)
      integer, intent(in) :: on_walls(n_walls)
      real(c_double), intent(in) :: time
    end subroutine
  end interface

  ! Two octahedra, of radius 1 and 4, and a node between.
  x = 0
  do i = 1, 3
    x(i, 2 * i - 1) = 1
    x(i, 2 * i) = -1
  end do
  x(:, 7:12) = 4 * x(:, 1:6)
  x(1, 13) = 2.5
  on_walls = [(i, i = 1, n_walls)]
  call user_grid(n_points, x, n_walls, on_walls, 0.25_c_double)
  write (*, '(a,3f8.3)') 'body, node between, wall: ', x(1, 1), x(1, 13), x(1, 7)
  if (abs(x(1, 1) - 1.5) > 1e-6 .or. abs(x(1, 13) - 2.75) > 1e-6 .or. abs(x(1, 7) - 4) > 0) error stop 'the node did not follow'
end program

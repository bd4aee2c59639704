! Upwind differences for u_t + u_x = 0 on [0, period), u = sin(x) at t = 0. Of the case it needs three numbers.
program upwind
  implicit none
  integer, parameter :: dp = kind(1.0d0)
  character(len=4096) :: text   ! numbers stand before the lists of particles
  real(dp) :: period, T, h
  real(dp), allocatable :: u(:)
  integer :: N, steps, step, j

  text = ''
  read (*, '(a)') text
  period = number('"period":')
  T = number('"T":')
  N = nint(number('"N":'))
  h = period / N
  steps = ceiling(2 * T / h)
  u = [(sin(j * h), j = 0, N - 1)]
  do step = 1, steps
    u = u - T / steps * (u - cshift(u, -1)) / h
  end do
  write (*, '(a)', advance='no') '{"x": ['
  write (*, '(*(es24.16e3, :, ","))', advance='no') [(j * h, j = 0, N - 1)]
  write (*, '(a)', advance='no') '], "u": ['
  write (*, '(*(es24.16e3, :, ","))', advance='no') u
  write (*, '(a)') ']}'

contains

  real(dp) function number(name)
    character(len=*), intent(in) :: name
    integer :: at
    at = index(text, name)
    if (at == 0) error stop 'the case lacks a number'
    read (text(at + len(name):at + len(name) + scan(text(at + len(name):), ',}') - 2), *) number
  end function number

end program upwind

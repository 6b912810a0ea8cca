program lie2
    implicit none
    integer, parameter :: real64 = selected_real_kind(15)
    real(real64), parameter :: h = 0.001_real64, delta = 1
    real(real64) :: p, q, f, g, drift
    integer :: n
    p = 0
    q = 1.5_real64
    print '(a)', 'step,p,q'
    do n = 0, 5000
        print '(i0, 2(",", es25.17e3))', n, p, q
        f = -q - delta*q**3                    ! p' = f(q)
        g = (-1 - 3*delta*q**2)*p              ! p''
        drift = h*p + h*h/2*f
        p = p + h*f + h*h/2*g
        q = q + drift
    end do
end program

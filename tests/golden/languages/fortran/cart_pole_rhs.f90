! Cart-pole: dx = f(t, x, p), the equations of motion solved for the accelerations
!
! made by eomgen from models/cart_pole.toml
!
!     x[0]  x  [m] place of the cart */ /* ??/
!     x[1]  theta
!     x[2]  x'
!     x[3]  theta'
!     p[0]  M
!     p[1]  m
!     p[2]  l  [m]
!     p[3]  g
!     inputs[0]  F
!     dx  4 values, in the order of x
module cart_pole_rhs
    use, intrinsic :: iso_fortran_env, only: dp => real64
    implicit none
    private
    public :: rhs, constants, evaluate
    character(6), parameter, public :: x_names(4) = [character(6) :: "x", "theta", "x'", "theta'"]
    character(1), parameter, public :: p_names(4) = [character(1) :: "M", "m", "l", "g"]
    character(1), parameter, public :: input_names(1) = [character(1) :: "F"]

contains
    ! dx has 4 places; without inputs the model's own
    subroutine rhs(t, x, p, dx, inputs)
        real(dp), intent(in) :: t, x(4), p(4)
        real(dp), intent(inout) :: dx(4)
        real(dp), intent(in), optional :: inputs(1)
        real(dp) :: c(4)
        call constants(p, c)
        call evaluate(t, x, p, c, inputs, dx)
    end subroutine rhs

    recursive subroutine constants(p, c)
        real(dp), intent(in) :: p(0:*)
        real(dp), intent(inout) :: c(0:*)
        real(dp) :: M
        real(dp) :: m_2
        real(dp) :: l
        real(dp) :: g
        M = p(0)
        m_2 = p(1) ! m
        l = p(2) ! [m]
        g = p(3)
        c(0) = M + m_2
        c(1) = m_2*l
        c(2) = l*(m_2*g)
        c(3) = 1.0_dp/(m_2*(l*l))
    end subroutine constants

    recursive subroutine evaluate(t, x, p, c, inputs, dx)
        real(dp), intent(in) :: t
        real(dp), intent(in) :: x(0:*)
        real(dp), intent(in) :: p(0:*)
        real(dp), intent(in) :: c(0:*)
        real(dp), intent(in), optional :: inputs(0:*)
        real(dp), intent(inout) :: dx(0:*)
        real(dp) :: theta
        real(dp) :: x_dot
        real(dp) :: theta_dot
        real(dp) :: acting(0:1 - 1)
        real(dp) :: F
        real(dp) :: v1
        real(dp) :: v2
        real(dp) :: v3
        real(dp) :: v4
        real(dp) :: v5
        if (kind(t) < 0) return  ! t does not stand in it
        if (kind(p) < 0) return  ! p does not stand in it
        theta = x(1)
        x_dot = x(2) ! x'
        theta_dot = x(3) ! theta'
        acting = 0.0_dp
        if (present(inputs)) then
            acting(0) = inputs(0)
        else
            acting(0) = 0.0_dp
        end if
        F = acting(0)
        v1 = sin(theta)
        v2 = c(2)*v1
        v3 = cos(theta)*c(1)
        v4 = v3*c(3)
        v5 = (F + theta_dot*theta_dot*(c(1)*v1) + v2*v4)/(c(0) - v3*v4)
        dx(0) = x_dot
        dx(1) = theta_dot
        dx(2) = v5
        dx(3) = -(v2*c(3) + v4*v5)
    end subroutine evaluate
end module cart_pole_rhs

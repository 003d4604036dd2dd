! Held against its test vectors: stops where they do not agree
program cart_pole_rhs_test
    use, intrinsic :: iso_fortran_env, only: dp => real64
    use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
    use cart_pole_rhs, only: rhs
    implicit none
    real(dp), parameter :: none(0) = [real(dp) ::]
    real(dp) :: nan
    integer :: vector = 0
    nan = ieee_value(1.0_dp, ieee_quiet_nan)
    call check(0.057_dp, [-0.731_dp, 0.695_dp, 0.528_dp, -0.49_dp], [1.243_dp, 1.174_dp, 1.477_dp, 1.683_dp], none, &
        &[0.528_dp, -0.49_dp, 0.7181607985094061_dp, -1.1031514925578993_dp], 1e-12_dp)
    call check(0.061_dp, [0.672_dp, -0.134_dp, 0.525_dp, -0.996_dp], [1.168_dp, 1.582_dp, 0.843_dp, 1.918_dp], &
        &[0.803_dp], [0.525_dp, -0.996_dp, 0.1876783302033243_dp, 0.08333056354864529_dp], 1e-12_dp)
    call check(0.992_dp, [-0.949_dp, 0.083_dp, 0.878_dp, -0.238_dp], [0.825_dp, 1.133_dp, 0.544_dp, 0.833_dp], none, &
        &[0.878_dp, -0.238_dp, 0.097107194891642_dp, -0.3048392378332513_dp], 1e-12_dp)
    call check(0.372_dp, [-0.534_dp, -0.538_dp, -0.562_dp, -0.081_dp], [0.935_dp, 0.532_dp, 1.756_dp, 1.335_dp], &
        &[0.285_dp], [-0.562_dp, -0.081_dp, -0.02852990140408754_dp, 0.40351920678391584_dp], 1e-12_dp)
    call check(1.341_dp, [0.985_dp, 0.72_dp, -0.758_dp, -0.335_dp], [1.582_dp, 1.567_dp, 1.905_dp, 1.133_dp], none, &
        &[-0.758_dp, -0.335_dp, 0.4864644658627943_dp, -0.584152024043461_dp], 1e-12_dp)
    call check(0.829_dp, [-0.393_dp, 0.175_dp, 0.765_dp, 0.692_dp], [1.258_dp, 1.384_dp, 0.552_dp, 0.864_dp], &
        &[0.595_dp], [0.765_dp, 0.692_dp, 0.6644155012006843_dp, -1.4577844343713828_dp], 1e-12_dp)
    call check(0.0_dp, [0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp], [1.243_dp, 1.174_dp, 1.477_dp, 1.683_dp], none, [0.0_dp, &
        &0.0_dp, 0.0_dp, 0.0_dp], 1e-12_dp)
contains
    subroutine check(t, x, p, inputs, right, tolerance)
        real(dp), intent(in) :: t, x(:), p(:), inputs(:), right(:), tolerance
        real(dp) :: found(size(right)), largest
        integer :: k
        found = 0
        vector = vector + 1
        if (size(inputs) > 0) then
            call rhs(t, x, p, found, inputs)
        else
            call rhs(t, x, p, found)
        end if
        largest = max(1.0_dp, maxval(abs(right), mask=abs(right) >= 0))
        do k = 1, size(right)
            if (.not. abs(right(k)) >= 0) then
                if (.not. abs(found(k)) >= 0) cycle
            else if (abs(found(k) - right(k)) <= tolerance*largest) then
                cycle
            end if
            print *, "vector", vector, "dx", k, "is", found(k), "not", right(k)
            error stop 1
        end do
    end subroutine check
end program cart_pole_rhs_test

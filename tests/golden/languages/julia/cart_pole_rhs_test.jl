# Held against its test vectors: julia cart_pole_rhs_test.jl. Not run where it was made: no Julia was there.
include("cart_pole_rhs.jl")
using .cart_pole_rhs
using Test

function check(t, x, p, inputs, right, tolerance)
    found = cart_pole_rhs.rhs(t, x, p, inputs)
    largest = maximum(abs, filter(!isnan, right); init=1.0)
    @test length(found) == length(right)
    for (a, b) in zip(found, right)
        @test isnan(b) ? isnan(a) : abs(a - b) <= tolerance*largest
    end
end

@testset "cart_pole_rhs" begin
    check(0.057, Float64[-0.731, 0.695, 0.528, -0.49], Float64[1.243, 1.174, 1.477, 1.683], Float64[], Float64[0.528, -0.49, 0.7181607985094061, -1.1031514925578993], 1e-12)
    check(0.061, Float64[0.672, -0.134, 0.525, -0.996], Float64[1.168, 1.582, 0.843, 1.918], Float64[0.803], Float64[0.525, -0.996, 0.1876783302033243, 0.08333056354864529], 1e-12)
    check(0.992, Float64[-0.949, 0.083, 0.878, -0.238], Float64[0.825, 1.133, 0.544, 0.833], Float64[], Float64[0.878, -0.238, 0.097107194891642, -0.3048392378332513], 1e-12)
    check(0.372, Float64[-0.534, -0.538, -0.562, -0.081], Float64[0.935, 0.532, 1.756, 1.335], Float64[0.285], Float64[-0.562, -0.081, -0.02852990140408754, 0.40351920678391584], 1e-12)
    check(1.341, Float64[0.985, 0.72, -0.758, -0.335], Float64[1.582, 1.567, 1.905, 1.133], Float64[], Float64[-0.758, -0.335, 0.4864644658627943, -0.584152024043461], 1e-12)
    check(0.829, Float64[-0.393, 0.175, 0.765, 0.692], Float64[1.258, 1.384, 0.552, 0.864], Float64[0.595], Float64[0.765, 0.692, 0.6644155012006843, -1.4577844343713828], 1e-12)
    check(0.0, Float64[0.0, 0.0, 0.0, 0.0], Float64[1.243, 1.174, 1.477, 1.683], Float64[], Float64[0.0, 0.0, 0.0, 0.0], 1e-12)
end

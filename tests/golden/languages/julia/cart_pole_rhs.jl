# Cart-pole: dx = f(t, x, p), the equations of motion solved for the accelerations
#
# made by eomgen from models/cart_pole.toml
#
#     x[0]  x  [m] place of the cart */ /* ??/
#     x[1]  theta
#     x[2]  x'
#     x[3]  theta'
#     p[0]  M
#     p[1]  m
#     p[2]  l  [m]
#     p[3]  g
#     inputs[0]  F
#     dx  4 values, in the order of x
module cart_pole_rhs
# Not run where it was made: no Julia was there.

export rhs

const x_names = String["x", "theta", "x'", "theta'"]
const p_names = String["M", "m", "l", "g"]
const input_names = String["F"]

# f where it has a value, else nan: Julia's own end in an error there
function within(f, a)
    try
        return f(a)
    catch error
        error isa DomainError || rethrow()
        return oftype(float(a), NaN)
    end
end

function constants(p)
    c = zeros(Real, 4)
    M = p[1]
    m = p[2]
    l = p[3] # [m]
    g = p[4]
    c[1] = M + m
    c[2] = m*l
    c[3] = l*(m*g)
    c[4] = 1.0/(m*(l*l))
    return c
end

function evaluate(t, x, p, c, inputs)
    dx = zeros(Real, 4)
    theta = x[2]
    x_dot = x[3] # x'
    theta_dot = x[4] # theta'
    acting = zeros(Real, 1)
    if !isempty(inputs)
        acting[1] = inputs[1]
    else
        acting[1] = 0.0
    end
    F = acting[1]
    v1 = within(cos, theta)*c[2]
    v2 = within(sin, theta)
    v3 = c[3]*v2
    v4 = v1*c[4]
    v5 = (F + theta_dot*theta_dot*(c[2]*v2) + v3*v4)/(c[1] - v1*v4)
    dx[1] = x_dot
    dx[2] = theta_dot
    dx[3] = v5
    dx[4] = -(v3*c[4] + v4*v5)
    return dx
end

"""
    rhs(t, x, p, inputs=Float64[])

dx: a vector of 4; without inputs the model's own act. For OrdinaryDiffEq: (x, p, t) -> rhs(t, x, p).
"""
rhs(t, x, p, inputs=Float64[]) = identity.(evaluate(t, x, p, constants(p), inputs))

end

function cart_pole_rhs_test()
% Held against its test vectors: ends without a word where all agree. In Octave: octave --eval cart_pole_rhs_test
    check(0.057, [-0.731, 0.695, 0.528, -0.49], [1.243, 1.174, 1.477, 1.683], [], [0.528, -0.49, 0.7181607985094061, -1.1031514925578993], 1e-12);
    check(0.061, [0.672, -0.134, 0.525, -0.996], [1.168, 1.582, 0.843, 1.918], [0.803], [0.525, -0.996, 0.1876783302033243, 0.08333056354864529], 1e-12);
    check(0.992, [-0.949, 0.083, 0.878, -0.238], [0.825, 1.133, 0.544, 0.833], [], [0.878, -0.238, 0.097107194891642, -0.3048392378332513], 1e-12);
    check(0.372, [-0.534, -0.538, -0.562, -0.081], [0.935, 0.532, 1.756, 1.335], [0.285], [-0.562, -0.081, -0.02852990140408754, 0.40351920678391584], 1e-12);
    check(1.341, [0.985, 0.72, -0.758, -0.335], [1.582, 1.567, 1.905, 1.133], [], [-0.758, -0.335, 0.4864644658627943, -0.584152024043461], 1e-12);
    check(0.829, [-0.393, 0.175, 0.765, 0.692], [1.258, 1.384, 0.552, 0.864], [0.595], [0.765, 0.692, 0.6644155012006843, -1.4577844343713828], 1e-12);
    check(0.0, [0.0, 0.0, 0.0, 0.0], [1.243, 1.174, 1.477, 1.683], [], [0.0, 0.0, 0.0, 0.0], 1e-12);
end

function check(t, x, p, inputs, right, tolerance)
    if isempty(inputs)
        found = cart_pole_rhs(t, x, p);
    else
        found = cart_pole_rhs(t, x, p, inputs);
    end
    right = right(:);
    known = right == right;
    assert(isequal(size(found), size(right)), 'the size of the result is not that of the vector');
    assert(all(isnan(found(~known))), 'a value where there is none');
    wrong = find(abs(found(known) - right(known)) > tolerance*max([1; abs(right(known))]), 1);
    assert(isempty(wrong), 'at t = %g: %s is not %s', t, mat2str(found', 17), mat2str(right', 17));
end

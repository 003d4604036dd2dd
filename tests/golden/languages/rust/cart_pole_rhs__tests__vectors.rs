//! Held against the test vectors: cargo test
#![allow(clippy::approx_constant, clippy::excessive_precision)]

fn agree(found: &[f64], right: &[f64], tolerance: f64) {
    let largest = right.iter().fold(1.0_f64, |most, value| most.max(value.abs()));
    for (k, (a, b)) in found.iter().zip(right).enumerate() {
        let same = if b.is_nan() { a.is_nan() } else { (a - b).abs() <= tolerance*largest };
        assert!(same, "place {k} is {a}, not {b}");
    }
}

#[test]
fn rhs_gives_the_values_of_its_test_vectors() {
    use cart_pole_rhs::rhs::rhs;
    let out = &mut [0.0; 4];
    rhs(0.057, &[-0.731, 0.695, 0.528, -0.49], &[1.243, 1.174, 1.477, 1.683], None, out);
    agree(out, &[0.528, -0.49, 0.7181607985094061, -1.1031514925578993], 1e-12);
    rhs(0.061, &[0.672, -0.134, 0.525, -0.996], &[1.168, 1.582, 0.843, 1.918], Some(&[0.803]), out);
    agree(out, &[0.525, -0.996, 0.1876783302033243, 0.08333056354864529], 1e-12);
    rhs(0.992, &[-0.949, 0.083, 0.878, -0.238], &[0.825, 1.133, 0.544, 0.833], None, out);
    agree(out, &[0.878, -0.238, 0.097107194891642, -0.3048392378332513], 1e-12);
    rhs(0.372, &[-0.534, -0.538, -0.562, -0.081], &[0.935, 0.532, 1.756, 1.335], Some(&[0.285]), out);
    agree(out, &[-0.562, -0.081, -0.02852990140408754, 0.40351920678391584], 1e-12);
    rhs(1.341, &[0.985, 0.72, -0.758, -0.335], &[1.582, 1.567, 1.905, 1.133], None, out);
    agree(out, &[-0.758, -0.335, 0.4864644658627943, -0.584152024043461], 1e-12);
    rhs(0.829, &[-0.393, 0.175, 0.765, 0.692], &[1.258, 1.384, 0.552, 0.864], Some(&[0.595]), out);
    agree(out, &[0.765, 0.692, 0.6644155012006843, -1.4577844343713828], 1e-12);
    rhs(0.0, &[0.0, 0.0, 0.0, 0.0], &[1.243, 1.174, 1.477, 1.683], None, out);
    agree(out, &[0.0, 0.0, 0.0, 0.0], 1e-12);
}

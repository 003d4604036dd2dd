// Held against its test vectors: exit 0 where all agree
#include "cart_pole_rhs.hpp"
#include <stdio.h>

static const struct {
    double t, x[4], p[4];
    int given;
    double inputs[1], dx[4], tolerance;
} vectors[] = {
    {0.057, {-0.731, 0.695, 0.528, -0.49}, {1.243, 1.174, 1.477, 1.683}, 0, {0}, {0.528, -0.49, 0.7181607985094061, -1.1031514925578993}, 1e-12},
    {0.061, {0.672, -0.134, 0.525, -0.996}, {1.168, 1.582, 0.843, 1.918}, 1, {0.803}, {0.525, -0.996, 0.1876783302033243, 0.08333056354864529}, 1e-12},
    {0.992, {-0.949, 0.083, 0.878, -0.238}, {0.825, 1.133, 0.544, 0.833}, 0, {0}, {0.878, -0.238, 0.097107194891642, -0.3048392378332513}, 1e-12},
    {0.372, {-0.534, -0.538, -0.562, -0.081}, {0.935, 0.532, 1.756, 1.335}, 1, {0.285}, {-0.562, -0.081, -0.02852990140408754, 0.40351920678391584}, 1e-12},
    {1.341, {0.985, 0.72, -0.758, -0.335}, {1.582, 1.567, 1.905, 1.133}, 0, {0}, {-0.758, -0.335, 0.4864644658627943, -0.584152024043461}, 1e-12},
    {0.829, {-0.393, 0.175, 0.765, 0.692}, {1.258, 1.384, 0.552, 0.864}, 1, {0.595}, {0.765, 0.692, 0.6644155012006843, -1.4577844343713828}, 1e-12},
    {0.0, {0.0, 0.0, 0.0, 0.0}, {1.243, 1.174, 1.477, 1.683}, 0, {0}, {0.0, 0.0, 0.0, 0.0}, 1e-12},
};

int main(void)
{
    int wrong = 0;
    for (size_t i = 0; i < sizeof vectors/sizeof *vectors; i++) {
        double dx[4], largest = 1;
        cart_pole_rhs<double>::rhs(vectors[i].t, vectors[i].x, vectors[i].p, vectors[i].given ? vectors[i].inputs : NULL, dx);
        for (int j = 0; j < 4; j++)
            if (fabs(vectors[i].dx[j]) > largest) largest = fabs(vectors[i].dx[j]);
        for (int j = 0; j < 4; j++)
            if (isnan(vectors[i].dx[j]) ? !isnan(dx[j])
                : !(fabs(dx[j] - vectors[i].dx[j]) <= vectors[i].tolerance*largest)) {
                fprintf(stderr, "vector %d: dx[%d] is %.17g, not %.17g\n", (int)i, j, (double)dx[j], (double)vectors[i].dx[j]);
                wrong = 1;
            }
    }
    return wrong;
}

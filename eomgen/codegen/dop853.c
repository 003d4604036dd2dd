/* DOP853: explicit Runge-Kutta of order 8, error estimates of orders 5 and 3, output between the steps of order 7.

   x' = f(t, x). REAL is double, float, or a vector of several runs at once; nothing is allocated, nothing is kept.
   Source: Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 2nd ed., II.5 and II.6. */

#include <stddef.h>

#ifndef REAL
#define REAL double
#endif
#ifndef R
#define R(number) ((REAL)number)
#define SIZE(a) ((a) < 0 ? -(a) : (a))
#define LARGER(a, b) ((a) > (b) ? (a) : (b))
#endif

#define DOP853_STAGES 16 /* rows of n in K: 12, the rate after the step, 3 for what is between */
#define DOP853_DENSE 7   /* rows of n in F */

/* by which rates, times h, the states of the last two stages differ: both look at the end of the step */
#define DOP853_APART \
    -2.2190164133999692, 0.0, 0.0, 10.53449546673725, 2.0008720582248625, \
    22.409244755871207, -26.05736663010546, -2.9422056828755614, 9.18402130048845, -12.51272812545682, \
    -0.44202734521173326, 0.04471061572777259

struct rate {
    void (*f)(REAL t, const REAL *x, const REAL *p, const REAL *c, const REAL *inputs, REAL *dx);
    const REAL *p, *c, *inputs;
};

#define EACH for (size_t k = 0; k < n; k++)
#define CALL(rate, t, x, dx) (rate)->f(t, x, (rate)->p, (rate)->c, (rate)->inputs, dx)
#define ROWS_OF_K \
    REAL *K0 = K, *K1 = K + n, *K2 = K + 2*n, *K3 = K + 3*n, *K4 = K + 4*n, *K5 = K + 5*n, *K6 = K + 6*n, \
         *K7 = K + 7*n, *K8 = K + 8*n, *K9 = K + 9*n, *K10 = K + 10*n, *K11 = K + 11*n, *K12 = K + 12*n

/* y, the state after a step h from x; K0 = f(t, x) is there before, K1 ... K12 are there after, K12 = f(t + h, y) */
static void dop853_step(const struct rate *f, size_t n, REAL t, REAL h, const REAL *x, REAL *y, REAL *K)
{
    ROWS_OF_K;
    EACH y[k] = x[k] + h*(R(0.05260015195876773)*K0[k]);
    CALL(f, t + R(0.05260015195876773)*h, y, K1);
    EACH y[k] = x[k] + h*(R(0.0197250569845379)*K0[k] + R(0.0591751709536137)*K1[k]);
    CALL(f, t + R(0.0789002279381516)*h, y, K2);
    EACH y[k] = x[k] + h*(R(0.02958758547680685)*K0[k] + R(0.08876275643042054)*K2[k]);
    CALL(f, t + R(0.1183503419072274)*h, y, K3);
    EACH y[k] = x[k] + h*(R(0.2413651341592667)*K0[k] - R(0.8845494793282861)*K2[k]
                + R(0.924834003261792)*K3[k]);
    CALL(f, t + R(0.2816496580927726)*h, y, K4);
    EACH y[k] = x[k] + h*(R(0.037037037037037035)*K0[k] + R(0.17082860872947386)*K3[k]
                + R(0.12546768756682242)*K4[k]);
    CALL(f, t + R(0.3333333333333333)*h, y, K5);
    EACH y[k] = x[k] + h*(R(0.037109375)*K0[k] + R(0.17025221101954405)*K3[k] + R(0.06021653898045596)*K4[k]
                - R(0.017578125)*K5[k]);
    CALL(f, t + R(0.25)*h, y, K6);
    EACH y[k] = x[k] + h*(R(0.03709200011850479)*K0[k] + R(0.17038392571223998)*K3[k]
                + R(0.10726203044637328)*K4[k] - R(0.015319437748624402)*K5[k] + R(0.008273789163814023)*K6[k]);
    CALL(f, t + R(0.3076923076923077)*h, y, K7);
    EACH y[k] = x[k] + h*(R(0.6241109587160757)*K0[k] - R(3.3608926294469414)*K3[k]
                - R(0.868219346841726)*K4[k] + R(27.59209969944671)*K5[k] + R(20.154067550477894)*K6[k]
                - R(43.48988418106996)*K7[k]);
    CALL(f, t + R(0.6512820512820513)*h, y, K8);
    EACH y[k] = x[k] + h*(R(0.47766253643826434)*K0[k] - R(2.4881146199716677)*K3[k]
                - R(0.590290826836843)*K4[k] + R(21.230051448181193)*K5[k] + R(15.279233632882423)*K6[k]
                - R(33.28821096898486)*K7[k] - R(0.020331201708508627)*K8[k]);
    CALL(f, t + R(0.6)*h, y, K9);
    EACH y[k] = x[k] + h*(-R(0.9371424300859873)*K0[k] + R(5.186372428844064)*K3[k]
                + R(1.0914373489967295)*K4[k] - R(8.149787010746927)*K5[k] - R(18.52006565999696)*K6[k]
                + R(22.739487099350505)*K7[k] + R(2.4936055526796523)*K8[k] - R(3.0467644718982196)*K9[k]);
    CALL(f, t + R(0.8571428571428571)*h, y, K10);
    EACH y[k] = x[k] + h*(R(2.273310147516538)*K0[k] - R(10.53449546673725)*K3[k]
                - R(2.0008720582248625)*K4[k] - R(17.9589318631188)*K5[k] + R(27.94888452941996)*K6[k]
                - R(2.8589982771350235)*K7[k] - R(8.87285693353063)*K8[k] + R(12.360567175794303)*K9[k]
                + R(0.6433927460157636)*K10[k]);
    CALL(f, t + h, y, K11);
    EACH y[k] = x[k] + h*(R(0.054293734116568765)*K0[k] + R(4.450312892752409)*K5[k]
                + R(1.8915178993145003)*K6[k] - R(5.801203960010585)*K7[k] + R(0.3111643669578199)*K8[k]
                - R(0.1521609496625161)*K9[k] + R(0.20136540080403034)*K10[k] + R(0.04471061572777259)*K11[k]);
    CALL(f, t + h, y, K12);
}

/* both estimates of the error of a step over h, squared and summed over the states, each against its scale */
static void dop853_errors(size_t n, const REAL *x, const REAL *y, REAL *K, REAL rtol, REAL atol, REAL *errors)
{
    ROWS_OF_K;
    (void)K1, (void)K2, (void)K3, (void)K4, (void)K12;
    errors[0] = errors[1] = (REAL){0};
    EACH {
        REAL scale = atol + rtol*LARGER(SIZE(x[k]), SIZE(y[k])), five, three;
        five = R(0.01312004499419488)*K0[k] - R(1.2251564463762044)*K5[k] - R(0.4957589496572502)*K6[k]
                    + R(1.6643771824549864)*K7[k] - R(0.35032884874997366)*K8[k] + R(0.3341791187130175)*K9[k]
                    + R(0.08192320648511571)*K10[k] - R(0.022355307863886294)*K11[k];
        three = -R(0.18980075407240762)*K0[k] + R(4.450312892752409)*K5[k] + R(1.8915178993145003)*K6[k]
                    - R(5.801203960010585)*K7[k] - R(0.4226823213237919)*K8[k] - R(0.1521609496625161)*K9[k]
                    + R(0.20136540080403034)*K10[k] + R(0.02265179219836082)*K11[k];
        errors[0] += (five/scale)*(five/scale);
        errors[1] += (three/scale)*(three/scale);
    }
}

/* F, of the polynomial between x and x_new; y is room for n */
static void dop853_dense(const struct rate *f, size_t n, REAL t, REAL h, const REAL *x, const REAL *x_new, REAL *y,
                         REAL *K, REAL *F)
{
    ROWS_OF_K;
    REAL *K13 = K + 13*n, *K14 = K + 14*n, *K15 = K + 15*n;
    (void)K1, (void)K2, (void)K3, (void)K4;
    EACH y[k] = x[k] + h*(R(0.056167502283047954)*K0[k] + R(0.25350021021662483)*K6[k]
                - R(0.2462390374708025)*K7[k] - R(0.12419142326381637)*K8[k] + R(0.15329179827876568)*K9[k]
                + R(0.00820105229563469)*K10[k] + R(0.007567897660545699)*K11[k] - R(0.008298)*K12[k]);
    CALL(f, t + R(0.1)*h, y, K13);
    EACH y[k] = x[k] + h*(R(0.03183464816350214)*K0[k] + R(0.028300909672366776)*K5[k]
                + R(0.053541988307438566)*K6[k] - R(0.05492374857139099)*K7[k]
                - R(0.00010834732869724932)*K10[k] + R(0.0003825710908356584)*K11[k]
                - R(0.00034046500868740456)*K12[k] + R(0.1413124436746325)*K13[k]);
    CALL(f, t + R(0.2)*h, y, K14);
    EACH y[k] = x[k] + h*(-R(0.42889630158379194)*K0[k] - R(4.697621415361164)*K5[k]
                + R(7.683421196062599)*K6[k] + R(4.06898981839711)*K7[k] + R(0.3567271874552811)*K8[k]
                - R(0.0013990241651590145)*K12[k] + R(2.9475147891527724)*K13[k] - R(9.15095847217987)*K14[k]);
    CALL(f, t + R(0.7777777777777778)*h, y, K15);
    EACH {
        REAL change = x_new[k] - x[k];
        F[k] = change;
        F[n + k] = h*K0[k] - change;
        F[2*n + k] = 2*change - h*(K12[k] + K0[k]);
        F[3*n + k] = h*(-R(8.428938276109013)*K0[k] + R(0.5667149535193777)*K5[k]
                - R(3.0689499459498917)*K6[k] + R(2.38466765651207)*K7[k] + R(2.117034582445028)*K8[k]
                - R(0.871391583777973)*K9[k] + R(2.2404374302607883)*K10[k] + R(0.6315787787694688)*K11[k]
                - R(0.08899033645133331)*K12[k] + R(18.148505520854727)*K13[k] - R(9.194632392478356)*K14[k]
                - R(4.436036387594894)*K15[k]);
        F[4*n + k] = h*(R(10.427508642579134)*K0[k] + R(242.28349177525817)*K5[k]
                + R(165.20045171727028)*K6[k] - R(374.5467547226902)*K7[k] - R(22.113666853125306)*K8[k]
                + R(7.733432668472264)*K9[k] - R(30.674084731089398)*K10[k] - R(9.332130526430229)*K11[k]
                + R(15.697238121770845)*K12[k] - R(31.139403219565178)*K13[k] - R(9.35292435884448)*K14[k]
                + R(35.81684148639408)*K15[k]);
        F[5*n + k] = h*(R(19.985053242002433)*K0[k] - R(387.0373087493518)*K5[k] - R(189.17813819516758)*K6[k]
                + R(527.8081592054236)*K7[k] - R(11.57390253995963)*K8[k] + R(6.8812326946963)*K9[k]
                - R(1.0006050966910838)*K10[k] + R(0.7777137798053443)*K11[k] - R(2.778205752353508)*K12[k]
                - R(60.19669523126412)*K13[k] + R(84.32040550667716)*K14[k] + R(11.99229113618279)*K15[k]);
        F[6*n + k] = h*(-R(25.69393346270375)*K0[k] - R(154.18974869023643)*K5[k] - R(231.5293791760455)*K6[k]
                + R(357.6391179106141)*K7[k] + R(93.40532418362432)*K8[k] - R(37.45832313645163)*K9[k]
                + R(104.0996495089623)*K10[k] + R(29.8402934266605)*K11[k] - R(43.53345659001114)*K12[k]
                + R(96.32455395918828)*K13[k] - R(39.17726167561544)*K14[k] - R(149.72683625798564)*K15[k]);
    }
}

/* y, the state where `part` of the step is over */
static void dop853_between(size_t n, REAL part, const REAL *x, const REAL *F, REAL *y)
{
    REAL left = 1 - part;
    EACH {
        REAL high = F[4*n + k] + left*(F[5*n + k] + part*F[6*n + k]);
        y[k] = x[k] + part*(F[k] + left*(F[n + k] + part*(F[2*n + k] + left*(F[3*n + k] + part*high))));
    }
}

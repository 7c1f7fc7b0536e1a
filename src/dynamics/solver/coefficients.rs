//! The coefficients of DOP853.
//!
//! Hairer, E., Nørsett, S. P., Wanner, G.: Solving Ordinary Differential Equations I, second edition
//! (1993), section II.5 and appendix, there to more digits than a double has. Of the stages that a
//! row combines only those with a weight other than zero are listed; the solver names them.

/// Nodes of the stages 2 to 12.
pub(super) const C: [f64; 11] = [
    0.05260015195876773,
    0.0789002279381516,
    0.1183503419072274,
    0.2816496580927726,
    0.3333333333333333,
    0.25,
    0.3076923076923077,
    0.6512820512820513,
    0.6,
    0.8571428571428571,
    1.0,
];

/// Weight of stage 1 in stage 2.
pub(super) const A2: [f64; 1] = [0.05260015195876773];

/// Weights of the stages 1, 2 in stage 3.
pub(super) const A3: [f64; 2] = [0.0197250569845379, 0.0591751709536137];

/// Weights of the stages 1, 3 in stage 4.
pub(super) const A4: [f64; 2] = [0.02958758547680685, 0.08876275643042054];

/// Weights of the stages 1, 3, 4 in stage 5.
pub(super) const A5: [f64; 3] = [0.2413651341592667, -0.8845494793282861, 0.924834003261792];

/// Weights of the stages 1, 4, 5 in stage 6.
pub(super) const A6: [f64; 3] = [0.037037037037037035, 0.17082860872947386, 0.12546768756682242];

/// Weights of the stages 1, 4, 5, 6 in stage 7.
pub(super) const A7: [f64; 4] = [0.037109375, 0.17025221101954405, 0.06021653898045596, -0.017578125];

/// Weights of the stages 1, 4, 5, 6, 7 in stage 8.
pub(super) const A8: [f64; 5] =
    [0.03709200011850479, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402, 0.008273789163814023];

/// Weights of the stages 1, 4, 5, 6, 7, 8 in stage 9.
pub(super) const A9: [f64; 6] = [
    0.6241109587160757,
    -3.3608926294469414,
    -0.868219346841726,
    27.59209969944671,
    20.154067550477894,
    -43.48988418106996,
];

/// Weights of the stages 1, 4, 5, 6, 7, 8, 9 in stage 10.
pub(super) const A10: [f64; 7] = [
    0.47766253643826434,
    -2.4881146199716677,
    -0.590290826836843,
    21.230051448181193,
    15.279233632882423,
    -33.28821096898486,
    -0.020331201708508627,
];

/// Weights of the stages 1, 4, 5, 6, 7, 8, 9, 10 in stage 11.
pub(super) const A11: [f64; 8] = [
    -0.9371424300859873,
    5.186372428844064,
    1.0914373489967295,
    -8.149787010746927,
    -18.52006565999696,
    22.739487099350505,
    2.4936055526796523,
    -3.0467644718982196,
];

/// Weights of the stages 1, 4, 5, 6, 7, 8, 9, 10, 11 in stage 12.
pub(super) const A12: [f64; 9] = [
    2.273310147516538,
    -10.53449546673725,
    -2.0008720582248625,
    -17.9589318631188,
    27.94888452941996,
    -2.8589982771350235,
    -8.87285693353063,
    12.360567175794303,
    0.6433927460157636,
];

/// Weights of the stages 1, 6, 7, 8, 9, 10, 11, 12 in the solution of order 8.
pub(super) const B: [f64; 8] = [
    0.054293734116568765,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    0.3111643669578199,
    -0.1521609496625161,
    0.20136540080403034,
    0.04471061572777259,
];

/// The same less those of a solution of order 5: an error estimate.
pub(super) const ERROR_5: [f64; 8] = [
    0.01312004499419488,
    -1.2251564463762044,
    -0.4957589496572502,
    1.6643771824549864,
    -0.35032884874997366,
    0.3341791187130175,
    0.08192320648511571,
    -0.022355307863886294,
];

/// The same less those of a solution of order 3: another one.
pub(super) const ERROR_3: [f64; 8] = [
    -0.18980075407240762,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    -0.4226823213237919,
    -0.1521609496625161,
    0.20136540080403034,
    0.02265179219836082,
];

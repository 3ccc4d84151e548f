//! Tsitouras's pair of orders 5 and 4 (Computers & Mathematics with Applications 62, 2011), which satisfies fewer
//! simplifying assumptions than that of Dormand and Prince and so has smaller errors for the same number of stages.

use super::Tableau;
use crate::Real;

/// The pair; the last stage of a step is the first of the next.
pub(crate) struct Tsit5;

impl Tableau for Tsit5 {
    const STAGES: usize = 7;
    const ALL: usize = 7;
    const C: &'static [f64] = &[0.0, 0.161, 0.327, 0.9, 0.9800255409045097, 1.0, 1.0];
    const A: &'static [&'static [f64]] = &[
        &[],
        &[0.161],
        &[-0.008480655492356989, 0.335480655492357],
        &[2.8971530571054935, -6.359448489975075, 4.3622954328695815],
        &[
            5.325864828439257,
            -11.748883564062828,
            7.4955393428898365,
            -0.09249506636175525,
        ],
        &[
            5.86145544294642,
            -12.92096931784711,
            8.159367898576159,
            -0.071584973281401,
            -0.028269050394068383,
        ],
        Self::B,
    ];
    const B: &'static [f64] = &[
        0.09646076681806523,
        0.01,
        0.4798896504144996,
        1.379008574103742,
        -3.290069515436081,
        2.324710524099774,
    ];
    /// Weights of order 5 less those of order 4.
    const E: [&'static [f64]; 2] = [
        &[
            -0.001780011052225777,
            -0.0008164344596567469,
            0.007880878010261995,
            -0.1447110071732629,
            0.5823571654525552,
            -0.45808210592918697,
            1.0 / 66.0,
        ],
        &[],
    ];
    const LAST_IS_FIRST: bool = true;
    const ESTIMATE: u32 = 5;
    #[cfg(test)]
    const INTERPOLANT: u32 = 4;
    type Stages<S: Copy> = [S; 7];

    fn splat<S: Copy>(value: S) -> [S; 7] {
        [value; 7]
    }

    fn weights<T: Real>(theta: T) -> [T; 7] {
        let c = T::from_f64;
        let squared = theta * theta;
        [
            c(-1.0530884977290216)
                * theta
                * (theta - c(1.329989018975141))
                * (squared - c(1.4364028541716352) * theta + c(0.7139816917074209)),
            c(0.1017) * squared * (squared - c(2.1966568338249752) * theta + c(1.294985250737463)),
            c(2.490627285651253)
                * squared
                * (squared - c(2.3853564547206165) * theta + c(1.5780346820809248)),
            c(-16.548102889244902)
                * (theta - c(1.2171292729553325))
                * (theta - c(0.6162040603780009))
                * squared,
            c(47.37952196281928)
                * (theta - c(1.2030712083723627))
                * (theta - c(0.6580472926535473))
                * squared,
            c(-34.87065786149661) * (theta - c(1.2)) * (theta - c(0.6666666666666666)) * squared,
            c(2.5) * (theta - c(1.0)) * (theta - c(0.6)) * squared,
        ]
    }
}

//! Watches the measurements: which are missing, which are frozen, and when to give up.
//!
//! A measurement is *missing* at a tick if it is not finite there: the last valid one is used in
//! its place. A limb length or angle is *frozen* if for the time-out its reading has stayed the
//! same to the last bit although the reading of its own rate kept one sign and was large enough to
//! carry it over twice its resolution in that time. A mechanism at rest, a quantized sensor and
//! noise of either sign around zero raise no alarm; a frozen reading is found once its limb moves.
//! What the control law makes no use of may be missing for ever, it is reported and that is all.
//! Frozen rates and currents cannot be told from constant ones and are not looked for.

use serde::{Deserialize, Serialize};

use super::{Measurement, SensorParameters};

/// Scalars of a measurement, in the order of the fields of [`Measurement`].
pub const CHANNELS: usize = 21;

/// Limb lengths and angles, by place among the channels, and the places of their rates.
const POSITIONS: [(usize, usize); 6] = [(0, 3), (1, 4), (2, 5), (6, 9), (7, 10), (8, 11)];

/// Places of the currents of the revolute motors and of the acceleration.
const REVOLUTE_CURRENTS: u32 = 0b111 << 15;
const ACCELERATION: u32 = 0b111 << 18;

/// Which of the channels that not every control law needs are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Used {
    /// Of the revolute motors.
    pub revolute_currents: bool,
    /// Of P.
    pub acceleration: bool,
}

impl Used {
    /// Bits by channel.
    fn channels(self) -> u32 {
        let unless = |used: bool, channels: u32| if used { 0 } else { channels };
        !(unless(self.revolute_currents, REVOLUTE_CURRENTS) | unless(self.acceleration, ACCELERATION))
    }
}

/// Fresh readings in a row that have to agree: two could by chance where they come seldom.
const AGREEING: u32 = 3;

/// Least resolution, m or rad, where a perfect sensor is stated: rounding noise is no motion.
const LEAST_RESOLUTION: f64 = 5e-7;

/// What is wrong at a tick; bits by channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SensorFaults {
    /// No valid measurement; the last one is used.
    pub missing: u32,
    /// The reading does not follow the motion.
    pub frozen: u32,
    /// A fault has lasted for the time-out: the voltages are zero.
    pub cut_off: bool,
}

impl SensorFaults {
    /// Whether anything is wrong.
    pub fn any(&self) -> bool {
        self.missing | self.frozen != 0
    }
}

/// The memory of the watch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SensorWatch {
    /// Ticks that a fault lasts before the voltages are cut off; infinite: for ever, and nothing
    /// is looked upon as frozen.
    patience: f64,
    /// Rates below which a length (m/s) and an angle (rad/s) need not show a change.
    slow: [f64; 2],
    /// Last valid reading by channel.
    valid: [f64; CHANNELS],
    /// Ticks since then.
    missing_for: [u32; CHANNELS],
    stillness: [Stillness; 6],
    faults: SensorFaults,
}

/// How long a position reading has stayed the same while its rate says that it should not.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Stillness {
    reading: f64,
    rate: f64,
    /// Ticks, and fresh readings.
    ticks: u32,
    readings: u32,
}

impl SensorWatch {
    /// `timeout` in s, 0: never cut off.
    pub fn new(timeout: f64, sample_time: f64, sensors: &SensorParameters) -> Self {
        let patience = if timeout > 0.0 { timeout / sample_time } else { f64::INFINITY };
        let slow = [sensors.length_resolution, sensors.angle_resolution]
            .map(|resolution| 2.0 * resolution.max(LEAST_RESOLUTION) / timeout);
        Self {
            // 20 ticks of 1 ms are 20 ms, whatever the quotient's last bit
            patience: patience * (1.0 - 1e-9),
            slow,
            valid: [0.0; CHANNELS],
            missing_for: [0; CHANNELS],
            stillness: [Stillness::default(); 6],
            faults: SensorFaults::default(),
        }
    }

    /// Takes `measured` as valid, to have something to go on with from the very first tick.
    pub fn assume(&mut self, measured: &Measurement<f64>) {
        self.valid = measured.to_array();
    }

    /// Faults at the last tick.
    pub fn faults(&self) -> SensorFaults {
        self.faults
    }

    /// Checks a tick's measurement and returns it with the last valid readings in place of missing
    /// ones. `fresh` tells that the host had the chance to provide new readings since the last
    /// tick: several ticks within one communication step see the same. Only what is `used` leads to a cut-off.
    pub fn check(&mut self, measured: &Measurement<f64>, fresh: bool, used: Used) -> Measurement<f64> {
        let readings = measured.to_array();
        let mut missing = 0;
        for (channel, &reading) in readings.iter().enumerate() {
            if reading.is_finite() {
                self.valid[channel] = reading;
                self.missing_for[channel] = 0;
            } else {
                missing |= 1 << channel;
                self.missing_for[channel] = self.missing_for[channel].saturating_add(1);
            }
        }
        let mut frozen = self.faults.frozen;
        for (place, &(channel, rate)) in POSITIONS.iter().enumerate() {
            let (reading, rate) = (readings[channel], readings[rate]);
            let still = &mut self.stillness[place];
            still.ticks = still.ticks.saturating_add(1);
            if !fresh || !self.patience.is_finite() {
                continue;
            }
            let same = reading == still.reading;
            let moving = rate.abs() > self.slow[place / 3] && rate * still.rate > 0.0;
            if !same {
                frozen &= !(1 << channel);
            }
            if !(same && moving) {
                *still = Stillness { reading, rate, ticks: 0, readings: 1 };
                continue;
            }
            still.readings = still.readings.saturating_add(1);
            if still.readings >= AGREEING && f64::from(still.ticks) >= self.patience {
                frozen |= 1 << channel;
            }
        }
        let used = used.channels();
        let missed = |(channel, &ticks): (usize, &u32)| used & (1 << channel) != 0 && f64::from(ticks) >= self.patience;
        let overdue = self.missing_for.iter().enumerate().any(missed);
        self.faults = SensorFaults { missing, frozen, cut_off: overdue || frozen != 0 };
        Measurement::from_array(&self.valid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK: f64 = 1e-3;
    const TIMEOUT: f64 = 0.02;
    const ALL: Used = Used { revolute_currents: true, acceleration: true };

    fn watch() -> SensorWatch {
        SensorWatch::new(TIMEOUT, TICK, &SensorParameters::default())
    }

    /// All limbs move at `rate` (m/s, rad/s); readings are multiples of `resolution`.
    fn moving(t: f64, rate: f64, resolution: f64) -> [f64; CHANNELS] {
        let mut readings = [0.1; CHANNELS];
        for (position, its_rate) in POSITIONS {
            let truth = 0.2 + rate * t;
            readings[position] = if resolution > 0.0 { libm::round(truth / resolution) * resolution } else { truth };
            readings[its_rate] = rate;
        }
        readings
    }

    fn tick(watch: &mut SensorWatch, readings: &[f64; CHANNELS]) -> (Measurement<f64>, SensorFaults) {
        let used = watch.check(&Measurement::from_array(readings), true, ALL);
        (used, watch.faults())
    }

    #[test]
    fn a_missing_reading_is_reported_held_and_in_time_ends_the_voltages() {
        let mut watch = watch();
        let mut readings = moving(0.0, 0.0, 0.0);
        tick(&mut watch, &readings);
        readings[4] = f64::NAN;
        for k in 1..=30 {
            readings[0] = 0.2 + 1e-4 * f64::from(k);
            let (used, faults) = tick(&mut watch, &readings);
            assert_eq!(faults, SensorFaults { missing: 1 << 4, frozen: 0, cut_off: k >= 20 }, "tick {k}");
            assert_eq!((used.lengths[0], used.length_rates[1]), (readings[0], 0.0));
        }
        readings[4] = 0.25;
        let (used, faults) = tick(&mut watch, &readings);
        assert_eq!((used.length_rates[1], faults), (0.25, SensorFaults::default()), "it recovers");
    }

    #[test]
    fn what_is_not_used_may_be_missing_for_ever() {
        for (channel, used) in
            [(15, Used { revolute_currents: false, ..ALL }), (20, Used { acceleration: false, ..ALL })]
        {
            for (used, cut_off) in [(used, false), (ALL, true)] {
                let mut watch = watch();
                let mut readings = moving(0.0, 0.0, 0.0);
                readings[channel] = f64::NAN;
                for _ in 0..30 {
                    watch.check(&Measurement::from_array(&readings), true, used);
                }
                assert_eq!(watch.faults(), SensorFaults { missing: 1 << channel, frozen: 0, cut_off });
            }
        }
    }

    #[test]
    fn a_frozen_reading_is_found_within_the_timeout_and_forgiven_when_it_changes() {
        let mut watch = watch();
        for k in 0..60 {
            let mut readings = moving(f64::from(k) * TICK, 0.3, 0.0);
            if (20..50).contains(&k) {
                readings[7] = moving(20.0 * TICK, 0.3, 0.0)[7];
            }
            let (_, faults) = tick(&mut watch, &readings);
            let frozen = if (40..50).contains(&k) { 1 << 7 } else { 0 };
            assert_eq!(faults, SensorFaults { missing: 0, frozen, cut_off: frozen != 0 }, "tick {k}");
        }
    }

    #[test]
    fn quantized_sensors_and_slow_motion_raise_no_alarm() {
        // 1 mm/s takes 100 ms for a step of 0.1 mm; at 50 mm/s a step comes every second tick
        for rate in [1e-3, 9e-3, 11e-3, 0.05, -0.5] {
            let mut watch = watch();
            for k in 0..2000 {
                let readings = moving(f64::from(k) * TICK, rate, SensorParameters::default().length_resolution);
                assert!(!tick(&mut watch, &readings).1.any(), "{rate} at tick {k}");
            }
        }
    }

    #[test]
    fn noisy_rates_at_rest_raise_no_alarm() {
        let mut watch = watch();
        for k in 0..2000_u32 {
            let mut readings = moving(0.0, 0.0, 0.0);
            for (_, rate) in POSITIONS {
                // loud, but of alternating sign at least every seventh tick
                readings[rate] = if k % 7 < 4 { 5.0 } else { -5.0 };
            }
            assert!(!tick(&mut watch, &readings).1.any(), "tick {k}");
        }
    }

    #[test]
    fn readings_held_through_a_long_communication_step_are_not_frozen() {
        let mut watch = watch();
        for k in 0..3000 {
            let readings = moving(f64::from(k / 1000), 0.05, 0.0);
            watch.check(&Measurement::from_array(&readings), k % 1000 == 0, ALL);
            assert!(!watch.faults().any(), "tick {k}");
        }
    }

    #[test]
    fn without_a_timeout_faults_are_reported_and_voltages_stay() {
        let mut watch = SensorWatch::new(0.0, TICK, &SensorParameters::default());
        let mut readings = moving(0.0, 1.0, 0.0);
        readings[0] = f64::INFINITY;
        for _ in 0..1000 {
            let (_, faults) = tick(&mut watch, &readings);
            assert_eq!(faults, SensorFaults { missing: 1, frozen: 0, cut_off: false });
        }
    }
}

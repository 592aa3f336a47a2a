//! Two times against each other, with the noise of their repeats.

use super::Cost;

/// A ratio of times, and its range by the repeats of both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ratio {
    pub(super) median: f64,
    /// The range; `None` where one was timed once.
    pub(super) ends: Option<[f64; 2]>,
}

impl Ratio {
    pub(super) fn of(cost: &Cost, to: &Cost) -> Self {
        let ends = cost.interval().zip(to.interval());
        Self {
            median: cost.time() / to.time().max(f64::MIN_POSITIVE),
            ends: ends.map(|([low, high], [least, most])| [low / most, high / least]),
        }
    }

    /// The ratio after a function that grows.
    pub(super) fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self {
            median: function(self.median),
            ends: self.ends.map(|ends| ends.map(&function)),
        }
    }

    /// Returns whether it may as well be 1.
    pub(super) fn is_noise(&self) -> bool {
        self.ends
            .is_some_and(|[low, high]| low <= 1.0 && 1.0 <= high)
    }

    pub(super) fn noise_text(&self) -> String {
        let [low, high] = self.ends.unwrap_or([1.0; 2]);
        let noise = (high - 1.0).max(1.0 - low);
        format!("no difference in time beyond the noise of {}", part(noise))
    }

    pub(super) fn factor_text(&self) -> String {
        let within = match self.ends {
            Some([low, high]) => format!("{low:.2} to {high:.2}"),
            None => String::from(ONCE),
        };
        format!("{} the time ({within})", factor(self.median))
    }

    pub(super) fn saving_text(&self) -> String {
        let saves = self.median < 1.0;
        let share = |ratio: f64| 100.0 * (1.0 - ratio).abs();
        let within = match self.ends {
            Some(ends) => {
                let [mut low, mut high] = ends.map(share);
                if saves {
                    (low, high) = (high, low);
                }
                format!("{low:.0} to {high:.0} %")
            }
            None => String::from(ONCE),
        };
        let median = share(self.median);
        match saves {
            true => format!("saves {median:.0} % of the time ({within})"),
            false => format!("takes {median:.0} % more time ({within})"),
        }
    }
}

/// The text for times without repeats.
pub const ONCE: &str = "timed once, so its noise is unknown";

pub(super) fn factor(ratio: f64) -> String {
    format!("{ratio:.2} times")
}

pub(super) fn part(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

//! The common part of the reports of a picture and of frames.

use gridel_host::picture::Exposure;
use gridel_host::render::Job;
use gridel_host::table::counted;
use rayon::ThreadPool;
use serde::Serialize;
use std::fmt;
use std::time::Duration;

/// The settings of a rendering, and the time that it took.
#[derive(Serialize)]
pub struct RenderingReport {
    format: &'static str,
    accel: &'static str,
    samples: u16,
    depth: u8,
    threads: usize,
    /// Moments of each picture, while the shutter is open.
    #[serde(skip_serializing_if = "Option::is_none")]
    moments: Option<u16>,
    seconds: f64,
}

impl RenderingReport {
    pub fn of(job: &Job, pool: &ThreadPool, exposure: Option<Exposure>, taken: Duration) -> Self {
        Self {
            format: job.format.name(),
            accel: job.structure.name(),
            samples: job.settings.samples,
            depth: job.settings.depth,
            threads: pool.current_num_threads(),
            moments: exposure.map(|it| it.moments),
            seconds: taken.as_secs_f64(),
        }
    }
}

impl fmt::Display for RenderingReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let samples = counted(self.samples.into(), "sample");
        write!(f, "{}, {}, {samples} per pixel", self.format, self.accel)?;
        if let Some(moments) = self.moments {
            write!(f, " at {}", counted(moments.into(), "moment"))?;
        }
        let threads = counted(self.threads, "thread");
        write!(f, ", {:.3} s with {threads}", self.seconds)
    }
}

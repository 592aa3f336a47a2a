//! Upper bounds of the figures of a program that was not built, from those of programs that were.
//!
//! The compiler's work on one part depends on the rest, so neither bound is a proof. Each is raised by the largest
//! factor by which a program that was built exceeds the bound that the other programs give for it. Left out one by one,
//! 97 % of the recorded programs take less than the sum that [`from_less`] gives, and the others up to 8 % more.

/// The parts that a program has code for: one bit for each.
pub type Parts = u128;

/// A program that was built, and a figure of it.
pub type Built = (Parts, u64);

/// A program that has one part more than another.
struct Step {
    part: Parts,
    /// The places of both among the programs that were built.
    programs: [usize; 2],
    added: u64,
}

/// Returns the bound by the smallest program with code for more. `None` if there is none.
pub fn from_more(built: &[Built], parts: Parts) -> Option<f64> {
    let holds = |more: Parts, less: Parts| less & !more == 0;
    let more = built.iter().filter(|&&(all, _)| holds(all, parts));
    let least = more.map(|&(_, bytes)| bytes).min()?;
    // The compiler sometimes makes less code of a program with more parts.
    let pairs = built
        .iter()
        .flat_map(|less| built.iter().map(move |more| (less, more)));
    let excess = pairs
        .filter(|&((less, small), (more, large))| small > large && holds(*more, *less))
        .map(|((_, small), (_, large))| *small as f64 / *large as f64)
        .fold(1.0, f64::max);
    Some(least as f64 * excess)
}

/// Returns the bound by a program with code for less, and what each part that it lacks adds to a program at most. `None`
/// if there is none, or if that is not known of a part.
pub fn from_less(built: &[Built], parts: Parts) -> Option<f64> {
    let steps = steps(built);
    let bound = sum(built, &steps, parts, None)?;
    let excess = (0..built.len()).filter_map(|own| {
        let (parts, bytes) = built[own];
        Some(bytes as f64 / sum(built, &steps, parts, Some(own))? as f64)
    });
    Some(bound as f64 * excess.fold(1.0, f64::max))
}

fn steps(built: &[Built]) -> Vec<Step> {
    let mut steps = Vec::new();
    for (more, &(all, large)) in built.iter().enumerate() {
        for (less, &(rest, small)) in built.iter().enumerate() {
            let part = all & !rest;
            if rest & !all == 0 && part.is_power_of_two() {
                steps.push(Step {
                    part,
                    programs: [more, less],
                    added: large.saturating_sub(small),
                });
            }
        }
    }
    steps
}

/// The smallest sum over programs with code for less. One program can be left out.
fn sum(built: &[Built], steps: &[Step], parts: Parts, left_out: Option<usize>) -> Option<u64> {
    let is_used = |program: usize| Some(program) != left_out;
    let mut most = [None; Parts::BITS as usize];
    for step in steps
        .iter()
        .filter(|step| step.programs.into_iter().all(is_used))
    {
        let most = &mut most[step.part.trailing_zeros() as usize];
        *most = (*most).max(Some(step.added));
    }
    let sums = built
        .iter()
        .enumerate()
        .filter_map(|(program, &(less, bytes))| {
            if !is_used(program) || less & !parts != 0 {
                return None;
            }
            let lacks = |part: &usize| (parts & !less) >> part & 1 != 0;
            (0..most.len())
                .filter(lacks)
                .try_fold(bytes, |sum, part| Some(sum + most[part]?))
        });
    sums.min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smallest_program_with_more_is_a_bound() {
        let mut built = vec![(0b001, 1000), (0b111, 1500), (0b1111, 1600)];
        assert_eq!(from_more(&built, 0b11), Some(1500.0));
        assert_eq!(from_more(&built, 0b10000), None);
        // Where more code made a program smaller, by 2 %, it may be so here as well.
        built.push((0b1101, 1632));
        assert_eq!(from_more(&built, 0b11), Some(1530.0));
    }

    #[test]
    fn parts_that_a_smaller_program_lacks_add_what_they_add_to_others() {
        let mut built = vec![(0b001, 1000), (0b011, 1100), (0b101, 1300)];
        assert_eq!(from_less(&built, 0b111), Some(1400.0));
        assert_eq!(from_less(&built, 0b1111), None);
        // Two parts together take 10 % more than the sum of each. So may others.
        built.extend([(0b1000, 500), (0b1001, 1500), (0b1011, 1760)]);
        assert_eq!(from_less(&built, 0b1101), Some(1800.0 * (1760.0 / 1600.0)));
    }
}

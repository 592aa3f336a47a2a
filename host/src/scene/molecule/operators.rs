//! The operators of assemblies: rotations with a displacement, and expressions that combine them.

use super::parsed::{Matrix, Operators, Parsed};
use crate::scene::text::Source;
use crate::scene::{Placement, SceneError};
use crate::table::shortened;
use glam::{DMat3, DVec3};
use std::collections::HashMap;

/// The most instances of an assembly.
pub(super) const MOST_INSTANCES: u64 = 65_535;

/// The largest error of the entries of a rotation matrix: files round them to six digits or fewer.
const TOLERANCE: f64 = 1e-3;

/// The most factors of a product. Files have two or three.
const MOST_FACTORS: usize = 16;

/// The most characters of an operator's name that are kept. Files have one to three.
const MOST_CHARACTERS: usize = 32;

/// An operator.
#[derive(Clone)]
pub(super) struct Operator {
    pub(super) name: String,
    pub(super) placement: Placement,
}

impl<'a> Operators<'a> {
    /// Returns how many there are, without making them.
    pub(super) fn count(
        &self,
        source: &Source,
        parsed: &Parsed<'_>,
        line: usize,
    ) -> Result<u64, SceneError> {
        match self {
            Self::Listed(matrices) => Ok(matrices.len() as u64),
            Self::Expression(text) => {
                let mut product = 1_u64;
                for factor in factors(source, text, line)? {
                    let mut sum = 0_u64;
                    for item in items(factor) {
                        let [low, high] = range(source, parsed, item, line)?.unwrap_or([0, 0]);
                        sum = sum.saturating_add(u64::from(high - low) + 1);
                    }
                    product = product.saturating_mul(sum);
                }
                Ok(product)
            }
        }
    }

    /// Reads them; there are at most [`MOST_INSTANCES`].
    pub(super) fn read(
        &self,
        source: &Source,
        parsed: &Parsed<'_>,
        line: usize,
    ) -> Result<Vec<Operator>, SceneError> {
        let text = match self {
            Self::Listed(matrices) => {
                reject_doubled(source, matrices)?;
                return matrices.iter().map(|it| it.read(source)).collect();
            }
            Self::Expression(text) => *text,
        };
        let mut product: Option<Vec<Operator>> = None;
        for factor in factors(source, text, line)? {
            let right = named(source, parsed, factor, line)?;
            product = Some(match product {
                None => right,
                Some(left) => {
                    let pairs = left
                        .iter()
                        .flat_map(|left| right.iter().map(move |it| (left, it)));
                    let times = |(left, right): (&Operator, &Operator)| Operator {
                        name: format!("{}-{}", left.name, right.name),
                        placement: right.placement.within(&left.placement),
                    };
                    pairs.map(times).collect()
                }
            });
        }
        Ok(product.unwrap_or_default())
    }
}

/// Rejects a list in which two operators have one number. Names that are no numbers, such as `****`, distinguish none.
fn reject_doubled(source: &Source, matrices: &[Matrix<'_>]) -> Result<(), SceneError> {
    let mut lines = HashMap::new();
    for matrix in matrices {
        let first = *lines.entry(matrix.name).or_insert(matrix.line);
        if first != matrix.line && matrix.name.parse::<u32>().is_ok() {
            return Err(doubled(source, matrix.name, [first, matrix.line]));
        }
    }
    Ok(())
}

/// The error of two operators with one name, in these lines.
fn doubled(source: &Source, name: &str, [first, second]: [usize; 2]) -> SceneError {
    let cause = format!(
        "two operators have the name {}; the first is in line {first}",
        shortened(name)
    );
    let remedy = "remove one of them or give it another name, or choose another assembly";
    source.error(cause, remedy).at_line(second)
}

impl Matrix<'_> {
    fn read(&self, source: &Source) -> Result<Operator, SceneError> {
        if let Some(again) = self.again {
            return Err(doubled(source, self.name, [self.line, again]));
        }
        let mut rows = [[0.0; 4]; 3];
        for (words, row) in self.words.iter().zip(&mut rows) {
            for (word, number) in words.iter().zip(row) {
                if word.is_empty() {
                    return Err(source
                        .error(
                            format!("operator {} lacks some of its 12 numbers", self.name),
                            "complete its matrix and its vector, or choose another assembly",
                        )
                        .at_line(self.line));
                }
                *number = source.number(word, &format!("a number of operator {}", self.name))?;
            }
        }
        let row = |at: usize| DVec3::from_slice(&rows[at][..3]);
        let matrix = DMat3::from_cols(row(0), row(1), row(2)).transpose();
        let translation = DVec3::new(rows[0][3], rows[1][3], rows[2][3]);
        let placement = Placement::near(matrix, translation, TOLERANCE);
        let placement = placement.filter(|it| it.scale == 1.0).ok_or_else(|| {
            let cause = match matrix.determinant() < 0.0 {
                true => "mirrors the molecule",
                false => "is no rotation",
            };
            source
                .error(
                    format!(
                        "operator {} {cause}; operators of assemblies are rotations",
                        self.name
                    ),
                    "repair its matrix, or choose another assembly",
                )
                .at_line(self.line)
        })?;
        Ok(Operator {
            name: self.name.chars().take(MOST_CHARACTERS).collect(),
            placement,
        })
    }
}

/// Returns the factors of an expression: the text in parentheses, or between them.
fn factors<'a>(source: &Source, text: &'a str, line: usize) -> Result<Vec<&'a str>, SceneError> {
    let broken = |cause: &str| {
        let cause = format!("the operators {text:?} {cause}", text = shortened(text));
        let remedy = "write a list such as 1,2 or products of lists such as (1-60)(61,62)";
        source.error(cause, remedy).at_line(line)
    };
    let mut factors = Vec::new();
    let mut rest = text.trim();
    while !rest.is_empty() {
        let (factor, behind) = match rest.strip_prefix('(') {
            Some(inner) => {
                let closed = inner.split_once(')');
                closed.ok_or_else(|| broken("have a parenthesis that is not closed"))?
            }
            None => rest.split_at(rest.find('(').unwrap_or(rest.len())),
        };
        if factor.contains(['(', ')']) {
            return Err(broken(
                "have parentheses inside of each other, or one too many",
            ));
        }
        if items(factor).any(str::is_empty) {
            return Err(broken("have an empty place in a list"));
        }
        if factors.len() == MOST_FACTORS {
            return Err(broken(&format!("have more than {MOST_FACTORS} factors")));
        }
        factors.push(factor);
        rest = behind.trim_start();
    }
    match factors.is_empty() {
        true => Err(broken("are empty")),
        false => Ok(factors),
    }
}

/// The names and ranges of a list.
fn items(list: &str) -> impl Iterator<Item = &str> {
    list.split(',').map(str::trim)
}

/// The first and last number of a range; `None` for a name.
fn range(
    source: &Source,
    parsed: &Parsed<'_>,
    item: &str,
    line: usize,
) -> Result<Option<[u32; 2]>, SceneError> {
    if parsed.operators.contains_key(item) {
        return Ok(None);
    }
    let Some((low, high)) = item.split_once('-') else {
        return Ok(None);
    };
    match (low.trim().parse(), high.trim().parse()) {
        (Ok(low), Ok(high)) if low <= high => Ok(Some([low, high])),
        _ => Err(source
            .error(
                format!(
                    "the operators {item:?} are no range of numbers",
                    item = shortened(item)
                ),
                "write the smaller number first, such as 1-60",
            )
            .at_line(line)),
    }
}

/// The operators of a list.
fn named(
    source: &Source,
    parsed: &Parsed<'_>,
    list: &str,
    line: usize,
) -> Result<Vec<Operator>, SceneError> {
    let find = |name: &str| {
        let matrix = parsed.operators.get(name).ok_or_else(|| {
            let cause = format!(
                "there is no operator {name:?}, which an assembly uses",
                name = shortened(name)
            );
            let remedy = "add it to _pdbx_struct_oper_list, or choose another assembly";
            source.error(cause, remedy).at_line(line)
        })?;
        matrix.read(source)
    };
    let mut operators = Vec::new();
    for item in items(list) {
        match range(source, parsed, item, line)? {
            None => operators.push(find(item)?),
            Some([low, high]) => {
                for number in low..=high {
                    operators.push(find(&number.to_string())?);
                }
            }
        }
        debug_assert!(operators.len() as u64 <= MOST_INSTANCES);
    }
    Ok(operators)
}

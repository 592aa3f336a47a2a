//! Values of a manifest that scene files do not have.

use crate::measure::board::{BOARDS, Board};
use crate::scene::toml::source::nearest;
use crate::scene::toml::value::Value;
use crate::scene::{Instances, RenderSettings, SceneError};
use gridel_core::{Format, Structure};
use std::collections::BTreeMap;

pub(super) fn target(value: Value<'_>) -> Result<&'static Board, SceneError> {
    match Board::named(value.text()?) {
        Some(board) => Ok(board),
        None => value.one_of(BOARDS.each_ref(), |board| board.name),
    }
}

pub(super) fn format(value: Value<'_>) -> Result<Format, SceneError> {
    value.one_of(Format::ALL, Format::name)
}

pub(super) fn formats(value: Value<'_>) -> Result<Vec<Format>, SceneError> {
    let items = value.items("`formats = [\"fixed\", \"f32\"]`")?;
    let formats: Vec<Format> = items.map(format).collect::<Result<_, _>>()?;
    let twice = (1..formats.len()).any(|last| formats[..last].contains(&formats[last]));
    if formats.is_empty() || twice {
        return Err(value.error(
            "`formats` must name one format or several, none of them twice",
            "write `formats = [\"f32\"]`, or more",
        ));
    }
    Ok(formats)
}

pub(super) fn structure(value: Value<'_>) -> Result<Structure, SceneError> {
    let name = value.text()?;
    Structure::from_name(name).ok_or_else(|| {
        let names = || Structure::ALL.into_iter().map(Structure::name);
        let near = nearest(name, names()).unwrap_or_default();
        let all: Vec<_> = names().collect();
        value.error(
            format!("there is no acceleration structure {name:?}"),
            format!("did you mean {near:?}? There are {}", all.join(", ")),
        )
    })
}

pub(super) fn instances(value: Value<'_>) -> Result<Instances, SceneError> {
    value.one_of(Instances::ALL, Instances::name)
}

pub(super) fn size(value: Value<'_>) -> Result<[u16; 2], SceneError> {
    let example = "`size = [640, 480]`";
    let sides: Vec<_> = value.items(example)?.collect();
    let [width, height] = sides[..] else {
        return Err(value.mistyped("a width and a height", example));
    };
    let side = |value: Value<'_>| Ok(value.integer_in(1..=u16::MAX.into())? as u16);
    let (width, height) = (side(width)?, side(height)?);
    let most = RenderSettings::MAX_ASPECT;
    if u32::from(width) > most * u32::from(height) {
        return Err(value.error(
            format!("the picture is more than {most} times as wide as high"),
            "write a smaller width or a larger height",
        ));
    }
    Ok([width, height])
}

pub(super) fn hashes(
    value: Value<'_>,
    formats: &[Format],
) -> Result<BTreeMap<String, String>, SceneError> {
    let names: Vec<_> = formats.iter().map(|format| format.name()).collect();
    let fields = value.fields("hash table", &[&names])?;
    let held = names
        .iter()
        .filter_map(|name| Some((name, fields.get(name)?)));
    held.map(|(name, value)| {
        let hash = value.text()?;
        let digits = hash
            .bytes()
            .all(|it| matches!(it, b'0'..=b'9' | b'a'..=b'f'));
        if hash.len() != 16 || !digits {
            return Err(value.error(
                format!("`{hash}` is not a picture hash; a hash has 16 hexadecimal digits, in small letters"),
                "remove it, and let `gridel check --bless` record the hash",
            ));
        }
        Ok((String::from(*name), hash.to_owned()))
    })
    .collect()
}

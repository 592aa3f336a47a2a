//! Keys and what they do, in a window and in a terminal.

/// A key, from any source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    Character(char),
    Left,
    Right,
    Up,
    Down,
    Escape,
}

/// The action of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Turn the camera around its target, in steps to the right and up.
    Orbit([i8; 2]),
    /// Go nearer, or further away.
    ZoomIn,
    ZoomOut,
    /// Show the scene from where it was first seen.
    Home,
    NextFormat,
    NextStructure,
    MoreSamples,
    FewerSamples,
    HeatMap,
    Save,
    Help,
    Quit,
}

/// A line of the help: keys, their names, and what they do.
type Line = (&'static [Key], &'static str, Action, &'static str);

/// All keys. The first of a line is named in the help; the others do the same.
pub const KEYS: [Line; 15] = [
    (
        &[Key::Left],
        "left",
        Action::Orbit([-1, 0]),
        "orbit to the left",
    ),
    (
        &[Key::Right],
        "right",
        Action::Orbit([1, 0]),
        "orbit to the right",
    ),
    (&[Key::Up], "up", Action::Orbit([0, 1]), "orbit upwards"),
    (
        &[Key::Down],
        "down",
        Action::Orbit([0, -1]),
        "orbit downwards",
    ),
    (
        &[Key::Character('+'), Key::Character('=')],
        "+",
        Action::ZoomIn,
        "zoom in",
    ),
    (&[Key::Character('-')], "-", Action::ZoomOut, "zoom out"),
    (
        &[Key::Character('r')],
        "r",
        Action::Home,
        "return to the first camera",
    ),
    (
        &[Key::Character('f')],
        "f",
        Action::NextFormat,
        "next number format",
    ),
    (
        &[Key::Character('a')],
        "a",
        Action::NextStructure,
        "next acceleration structure",
    ),
    (
        &[Key::Character('m')],
        "m",
        Action::MoreSamples,
        "twice as many samples per pixel",
    ),
    (
        &[Key::Character('l')],
        "l",
        Action::FewerSamples,
        "half as many samples per pixel",
    ),
    (
        &[Key::Character('c')],
        "c",
        Action::HeatMap,
        "cost per pixel as a heat map, or colors again",
    ),
    (
        &[Key::Character('s')],
        "s",
        Action::Save,
        "save the camera as TOML, in a new file",
    ),
    (&[Key::Character('h')], "h", Action::Help, "show these keys"),
    (
        &[Key::Character('q'), Key::Escape],
        "q",
        Action::Quit,
        "quit; Escape quits, too, in a window",
    ),
];

/// Returns the action of a key; capital letters do as small ones.
pub fn action(key: Key) -> Option<Action> {
    let key = match key {
        Key::Character(c) => Key::Character(c.to_ascii_lowercase()),
        key => key,
    };
    let line = KEYS.iter().find(|(keys, ..)| keys.contains(&key))?;
    Some(line.2)
}

/// Returns the keys as lines of text.
pub fn key_help() -> String {
    let line = |(_, name, _, text): &Line| format!("  {name:<7}{text}\n");
    KEYS.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_one_action() {
        let all: Vec<Key> = KEYS
            .iter()
            .flat_map(|(keys, ..)| keys.iter().copied())
            .collect();
        for (number, key) in all.iter().enumerate() {
            assert!(!all[..number].contains(key), "{key:?} twice");
        }
        assert_eq!(action(Key::Character('S')), Some(Action::Save));
        assert_eq!(action(Key::Character('=')), Some(Action::ZoomIn));
        assert_eq!(action(Key::Escape), Some(Action::Quit));
        assert_eq!(action(Key::Character('z')), None);
    }

    #[test]
    fn help_names_every_action() {
        let help = key_help();
        assert_eq!(help.lines().count(), KEYS.len());
        assert!(help.contains("  c      cost per pixel"), "{help}");
    }
}

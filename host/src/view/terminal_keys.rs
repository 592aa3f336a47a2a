//! Keys as terminals send them: arrows are sequences of characters, of which any part can arrive late.

use super::keys::Key;
use console::Key as Sent;

/// A key that was pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pressed {
    Key(Key),
    /// One that has no action.
    Other,
    /// The key that interrupts a program.
    Interrupt,
}

/// The place within a sequence.
#[derive(Clone, Copy, Debug, Default)]
enum Place {
    #[default]
    Outside,
    /// Behind the character that begins a sequence, or is the key Escape.
    BehindEscape,
    Inside,
}

/// Joins the parts of sequences.
#[derive(Debug, Default)]
pub(super) struct Sequences(Place);

impl Sequences {
    /// Returns the key that is complete with this part; `None` where more follows.
    pub(super) fn next(&mut self, sent: &Sent) -> Option<Pressed> {
        let place = std::mem::take(&mut self.0);
        let arrow = |key| Some(Pressed::Key(key));
        match (place, sent) {
            (_, Sent::CtrlC) => Some(Pressed::Interrupt),
            (_, Sent::ArrowLeft) | (Place::Inside, Sent::Char('D')) => arrow(Key::Left),
            (_, Sent::ArrowRight) | (Place::Inside, Sent::Char('C')) => arrow(Key::Right),
            (_, Sent::ArrowUp) | (Place::Inside, Sent::Char('A')) => arrow(Key::Up),
            (_, Sent::ArrowDown) | (Place::Inside, Sent::Char('B')) => arrow(Key::Down),
            (Place::Inside, Sent::Char('0'..='9' | ';'))
            | (Place::BehindEscape, Sent::Char('[' | 'O')) => {
                self.0 = Place::Inside;
                None
            }
            // Application mode: `console` gives the last character separately.
            (_, Sent::UnknownEscSeq(part)) if part[..] == ['O'] => {
                self.0 = Place::Inside;
                None
            }
            // By itself it may be the begin of an arrow, so it has no action.
            (_, Sent::Escape) => {
                self.0 = Place::BehindEscape;
                Some(Pressed::Other)
            }
            (Place::Outside | Place::BehindEscape, Sent::Char(c)) => {
                Some(Pressed::Key(Key::Character(*c)))
            }
            _ => Some(Pressed::Other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pressed(sent: &[Sent]) -> Vec<Pressed> {
        let mut sequences = Sequences::default();
        sent.iter().filter_map(|it| sequences.next(it)).collect()
    }

    #[test]
    fn arrows_are_keys_also_where_they_arrive_in_parts() {
        let up = Pressed::Key(Key::Up);
        assert_eq!(pressed(&[Sent::ArrowUp]), [up]);
        let parts = [Sent::Escape, Sent::Char('['), Sent::Char('A')];
        assert_eq!(pressed(&parts), [Pressed::Other, up]);
        let application = [Sent::UnknownEscSeq(vec!['O']), Sent::Char('A')];
        assert_eq!(pressed(&application), [up]);
        let with_shift = [';', '2', 'D'].map(Sent::Char);
        let with_shift = [&parts[..2], &[Sent::Char('1')], &with_shift].concat();
        let left = Pressed::Key(Key::Left);
        assert_eq!(pressed(&with_shift), [Pressed::Other, left]);
    }

    #[test]
    fn keys_behind_a_sequence_are_keys_again() {
        let a = Pressed::Key(Key::Character('A'));
        let sent = [Sent::ArrowUp, Sent::Char('A')];
        assert_eq!(pressed(&sent)[1], a);
        // Escape alone, and then a key.
        assert_eq!(
            pressed(&[Sent::Escape, Sent::Char('A')]),
            [Pressed::Other, a]
        );
        // Another function key has no action, and nor has its last character.
        let unknown = [Sent::Escape, Sent::Char('['), Sent::Char('q'), Sent::CtrlC];
        let expected = [Pressed::Other, Pressed::Other, Pressed::Interrupt];
        assert_eq!(pressed(&unknown), expected);
    }
}

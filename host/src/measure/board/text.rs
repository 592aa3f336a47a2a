//! The memory report as text.

use super::account::Account;
use super::memory::MemoryReport;
use crate::table::{Align, Table, grouped};
use std::fmt::{self, Display, Formatter};

/// Flash and RAM by their parts, what remains of each, and the builds that this holds for.
impl Display for MemoryReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let title = format!(
            "{}, {}, {}, {}",
            self.board, self.core, self.format, self.structure
        );
        let mut table = Table::new([(title.as_str(), Align::Left), ("bytes", Align::Right)]);
        for (name, account) in [("flash", &self.flash), ("RAM", &self.ram)] {
            add(&mut table, name, account);
        }
        writeln!(f, "{table}{}", self.holds_for())
    }
}

fn add(table: &mut Table, name: &str, account: &Account) {
    let bytes = |bytes: Option<u64>| bytes.map_or(String::from("unknown"), grouped);
    for item in &account.items {
        table.row([format!("{name}  {}", item.what), bytes(item.bytes)]);
    }
    table.row([format!("{name}  in all"), bytes(account.used)]);
    let missing = account.missing();
    table.row(if missing > 0 {
        [format!("{name}  MISSING"), grouped(missing)]
    } else {
        [format!("{name}  remains"), bytes(account.remains())]
    });
}

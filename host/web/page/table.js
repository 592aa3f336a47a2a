// The table of settings that were drawn.

export const errorText = (error) => (error === 0 ? "0" : error < 0.0001 ? error.toExponential(1) : error.toFixed(5));
export const secondsText = (seconds) => (seconds < 1 ? `${Math.round(1000 * seconds)} ms` : `${seconds.toFixed(2)} s`);
/** A share in percent, with the digits that tell it from none and from all. */
export function shareText(share) {
  const percent = 100 * share;
  const least = Math.min(percent, 100 - percent);
  return `${least > 0 ? percent.toFixed(Math.max(2, Math.ceil(-Math.log10(least)))) : percent} %`;
}
export const bytesText = (bytes) => `${bytes.toLocaleString("en")} bytes`;

export class Table {
  /** `use` is called with what was chosen for a row. */
  constructor(body, use) {
    Object.assign(this, { body, use, rows: new Map(), key: null });
  }

  clear(key) {
    this.key = key;
    this.rows.clear();
    this.show();
  }

  /** Adds a row, in place of an earlier one with the same setting. */
  add(row) {
    this.current = row.name;
    this.rows.set(row.name, row);
    this.show();
  }

  show() {
    const rows = [...this.rows.values()];
    const focused = this.body.contains(document.activeElement) ? document.activeElement.dataset.row : null;
    const most = (value) => Math.max(...rows.map(value), 1e-12);
    const [error, seconds, bytes] = [(it) => it.rmse, (it) => it.seconds, (it) => it.bytes];
    this.body.replaceChildren(...rows.map((row) => {
      const line = document.createElement("tr");
      if (row.name === this.current) line.setAttribute("aria-current", "true");
      const head = Object.assign(document.createElement("th"), { scope: "row", textContent: row.name });
      const button = Object.assign(document.createElement("button"), { type: "button", textContent: "Use" });
      button.setAttribute("aria-label", `Use ${row.name}`);
      button.dataset.row = row.name;
      button.onclick = () => this.use(row.chosen);
      const last = document.createElement("td");
      last.append(button);
      line.append(head,
        cell(errorText(row.rmse), row.rmse / most(error), "bar"), cell(errorText(row.largest)),
        cell(shareText(row.share)),
        cell(secondsText(row.seconds), row.seconds / most(seconds), "bar cost"),
        cell(row.bytes.toLocaleString("en"), row.bytes / most(bytes), "bar cost"), last);
      return line;
    }));
    // The button that had the focus is another one now.
    const again = Array.from(this.body.querySelectorAll("button")).find(({ dataset }) => dataset.row === focused);
    again?.focus({ preventScroll: true });
  }
}

function cell(text, share, kind) {
  const cell = Object.assign(document.createElement("td"), { textContent: text });
  if (kind) {
    const bar = Object.assign(document.createElement("span"), { className: kind });
    // The page's policy allows no styles in attributes, but those that scripts set.
    bar.style.width = `${Math.round(100 * share)}%`;
    cell.append(bar);
  }
  return cell;
}

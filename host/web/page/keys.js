// Keys of the picture, as in `gridel view`.

/** An orbit to a whole turn, and a step across the picture in its heights. */
const ORBIT_STEP = 2 * Math.PI / 48;
const PAN_STEP = 1 / 24;

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Does what a key asks for; false for one that nothing hears. `actions` are by small letters. */
export function press({ key, shiftKey, ctrlKey, altKey, metaKey }, move, actions) {
  if (ctrlKey || altKey || metaKey) return false;
  const way = ARROWS[key];
  if (way) {
    const by = (length) => way.map((steps) => steps * length);
    move(shiftKey ? { pan: by(PAN_STEP) } : { orbit: by(ORBIT_STEP) });
    return true;
  }
  if (key === "+" || key === "=" || key === "-") {
    move({ zoom: key === "-" ? -1 : 1 });
    return true;
  }
  const action = actions[key.toLowerCase()];
  action?.();
  return Boolean(action);
}

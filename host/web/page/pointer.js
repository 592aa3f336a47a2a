// Mouse, touch and keys of the picture.

/** How far a pointer moves in a click, in pixels of the screen. */
const CLICK_DISTANCE = 4;
const PIXELS_PER_STEP = 100;

/** Calls functions for what is done to a canvas. */
export function listen(canvas, { move, key, click }) {
  /** Pointers that are down: where they are, and where they went down. */
  const down = new Map();
  let isDrag = false;

  /** By half a turn over the picture's height. */
  const height = () => canvas.getBoundingClientRect().height;
  const orbit = ([right, bottom]) => move({ orbit: [-Math.PI * right / height(), Math.PI * bottom / height()] });
  const pan = ([right, bottom]) => move({ pan: [-right / height(), bottom / height()] });

  canvas.onpointerdown = (event) => {
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    if (down.size === 0) isDrag = false;
    const place = [event.clientX, event.clientY];
    down.set(event.pointerId, { place, start: place, pans: event.button !== 0 || event.shiftKey });
    event.preventDefault();
  };

  canvas.onpointermove = (event) => {
    const pointer = down.get(event.pointerId);
    if (!pointer) return;
    const place = [event.clientX, event.clientY];
    const before = pointer.place;
    const way = (from) => [place[0] - from[0], place[1] - from[1]];
    if (down.size > 1) {
      const other = [...down].find(([id]) => id !== event.pointerId)[1].place;
      const apart = ([x, y]) => Math.hypot(x - other[0], y - other[1]);
      pointer.place = place;
      isDrag = true;
      pan(way(before).map((it) => it / 2));
      const ratio = apart(place) / Math.max(apart(before), 1);
      if (ratio > 0) move({ zoom: Math.log(ratio) / Math.log(1.25) });
      return;
    }
    // The way of what has only now become a drag counts whole.
    const from = isDrag ? before : pointer.start;
    isDrag ||= Math.hypot(...way(pointer.start)) > CLICK_DISTANCE;
    if (!isDrag) return;
    pointer.place = place;
    if (pointer.pans) pan(way(from));
    else orbit(way(from));
  };

  canvas.onpointerup = (event) => {
    const pointer = down.get(event.pointerId);
    down.delete(event.pointerId);
    if (!pointer || isDrag || pointer.pans) return;
    const box = canvas.getBoundingClientRect();
    const pixel = (place, size, pixels) => Math.min(Math.max(0, Math.floor(place / size * pixels)), pixels - 1);
    click(pixel(event.clientX - box.left, box.width, canvas.width), pixel(event.clientY - box.top, box.height, canvas.height));
  };

  canvas.onpointercancel = (event) => down.delete(event.pointerId);
  canvas.oncontextmenu = (event) => event.preventDefault();

  // Without the focus the wheel scrolls the page.
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas) return;
    event.preventDefault();
    const pixels = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY : PIXELS_PER_STEP * Math.sign(event.deltaY);
    move({ zoom: -pixels / PIXELS_PER_STEP });
  }, { passive: false });

  canvas.onkeydown = (event) => {
    if (key(event)) event.preventDefault();
  };
}

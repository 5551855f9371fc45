/** What of a large fleet the page asks for: the robots on its map, and how many there are where they are too many. */

/** Robots above which the page asks by view: all of 1 000 take its budget already at one position in 4 s. */
const VIEWS_FROM = 1000, VIEWS_UNTIL = 800;
/** Robots on the map that are told one by one: as arrows they cover most of a phone's. */
const MOST = 300;
/** The part of the map's width and height that a view is larger at each side, so that a short pan needs no other. */
const BUFFER = 0.2;
/** Times as wide and high as the map: then the view is asked for anew, with finer cells. */
const TOO_LARGE = 2.5;
const FARTHEST_M = 1e8;

export class ViewChoice {
  constructor() {
    this._robots = 0;
    this._view = null;
  }

  /** The view to ask for, null where the fleet is small. */
  get view() {
    return this._view;
  }

  /** Whether the fleet has become large, or small again, since the view was chosen. */
  get isDue() {
    return this._isLarge !== (this._view !== null);
  }

  get _isLarge() {
    return this._robots > (this._view ? VIEWS_UNTIL : VIEWS_FROM);
  }

  /** Take in how many robots there are. */
  count(robots) {
    this._robots = robots;
  }

  /** Forget what was asked for: the site is another one. */
  restart() {
    this._view = null;
  }

  /**
   * Choose what to ask for, where the map shows `seen` (x_min, y_min, x_max, y_max in the site frame) and `selected`
   * is to be heard of wherever it is; return whether that is something else than before.
   */
  renew(seen, selected) {
    const before = this._view, always = selected === null ? [] : [selected];
    if (!this._isLarge) this._view = null;
    else if (before === null || !willDo(before.bounds, seen)) this._view = { bounds: grown(seen), always, most: MOST };
    else if (before.always[0] !== always[0]) this._view = { ...before, always };
    return this._view !== before;
  }
}

function grown([xMin, yMin, xMax, yMax]) {
  // Never without an extent.
  const dx = Math.max(BUFFER * (xMax - xMin), 1), dy = Math.max(BUFFER * (yMax - yMin), 1);
  return [xMin - dx, yMin - dy, xMax + dx, yMax + dy].map((value) => Math.min(Math.max(value, -FARTHEST_M), FARTHEST_M));
}

function willDo(asked, seen) {
  const holds = asked[0] <= seen[0] && asked[1] <= seen[1] && asked[2] >= seen[2] && asked[3] >= seen[3];
  // As much as a view is grown by, at least, is never too much.
  return holds && asked[2] - asked[0] <= TOO_LARGE * (seen[2] - seen[0]) + 2 && asked[3] - asked[1] <= TOO_LARGE * (seen[3] - seen[1]) + 2;
}

/** Return the cells of a density as [[x, y of the middle, column and row from the frame's origin, counts], …]. */
export function cellsOf({ cell, x, y, columns, cells, fresh, silent, offline }) {
  const firstColumn = Math.round(x / cell), firstRow = Math.round(y / cell);
  return cells.map((at, k) => {
    const column = firstColumn + (at % columns), row = firstRow + Math.floor(at / columns);
    return { x: (column + 0.5) * cell, y: (row + 0.5) * cell, column, row, counts: [fresh[k], silent[k], offline[k]] };
  });
}

/** Return groups of cells, `size` by `size` of them each, with the counts of all and the middle of their robots on the screen. */
export function grouped(cells, size) {
  const groups = new Map();
  for (const { column, row, counts, at } of cells) {
    const key = `${Math.floor(column / size)},${Math.floor(row / size)}`, robots = counts[0] + counts[1] + counts[2];
    let group = groups.get(key);
    if (!group) groups.set(key, (group = { x: 0, y: 0, robots: 0, counts: [0, 0, 0] }));
    group.robots += robots;
    group.x += (robots * (at.x - group.x)) / group.robots;
    group.y += (robots * (at.y - group.y)) / group.robots;
    counts.forEach((count, k) => (group.counts[k] += count));
  }
  return [...groups.values()];
}

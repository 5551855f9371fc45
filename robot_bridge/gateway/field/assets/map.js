/** The map: the site on a Web Mercator map, and the robots, or how many are where, on one canvas above it. */

import { cellsOf, grouped } from "/field/view.js";

const STATES = {
  fresh: { fill: "#136b2c", text: "" },
  stale: { fill: "#b36b00", text: "?" },
  lost: { fill: "#b00020", text: "!" },
  offline: { fill: "#5b6670", text: "–" },
};
/** A fresh robot that may be elsewhere: hollow, with a broken outline. */
const UNSURE = { fill: "#ffffff", text: "?", colour: "#b36b00", dashes: [4, 3] };
const AS_LAST_SEEN = "#5b6670";
const SIZE = 13;
const NAMED_AT_MOST = 80;
const FINGER = 28;
const SURFACES = "#c9c2b2", ROADS = "#7a6f5d", KEEPOUTS = "#b00020", OBSTACLES = "#4a4f55", BOUNDS = "#0b57a4";
const LARGEST_ZOOM = 24;
/** Pixels that circles of a density are apart, at least: room for a number, and for a finger. */
const APART = 62;
const RING = 5, CLOSER = 2;
const COUNTED = [STATES.fresh.fill, STATES.lost.fill, STATES.offline.fill];

/** Return the way from metres in the site frame to [lat, lon], by the polynomials of site.json. */
export function earthOf({ centre, scale, lon, lat }) {
  return (x, y) => {
    const u = (x - centre[0]) / scale, v = (y - centre[1]) / scale;
    let k = 0, longitude = 0, latitude = 0;
    for (let i = 0; i < 4; i++) {
      for (let j = 0; j < 4 - i; j++, k++) {
        const term = u ** i * v ** j;
        longitude += lon[k] * term;
        latitude += lat[k] * term;
      }
    }
    return [latitude, longitude];
  };
}

/** Return the way from [lat, lon] to metres in the site frame; beyond the site it is the straight one. */
export function siteOf(polynomials) {
  const { centre, scale, lon, lat } = polynomials, toEarth = earthOf(polynomials);
  const [lonU, lonV, latU, latV] = [lon[4], lon[1], lat[4], lat[1]], area = lonU * latV - lonV * latU;
  const inside = (value) => Math.min(Math.max(value, -1), 1);
  return (latitude, longitude) => {
    let u = 0, v = 0;
    // Nearly linear as it is, each time leaves a hundredth of the error.
    for (let k = 0; k < 6; k++) {
      const du = u - inside(u), dv = v - inside(v);
      const [north, east] = toEarth(centre[0] + scale * (u - du), centre[1] + scale * (v - dv));
      const toEast = longitude - east - lonU * du - lonV * dv, toNorth = latitude - north - latU * du - latV * dv;
      u += (toEast * latV - toNorth * lonV) / area;
      v += (toNorth * lonU - toEast * latU) / area;
    }
    return [centre[0] + scale * u, centre[1] + scale * v];
  };
}

const swapped = (ring) => ring.map(([lon, lat]) => [lat, lon]);

const RobotLayer = L.Layer.extend({
  onAdd(map) {
    this._canvas = L.DomUtil.create("canvas", "leaflet-zoom-hide");
    this._canvas.setAttribute("aria-hidden", "true");
    map.getPane("markerPane").appendChild(this._canvas);
    map.on("move moveend zoomend resize viewreset", this.draw, this);
    this.draw();
  },
  onRemove(map) {
    map.off("move moveend zoomend resize viewreset", this.draw, this);
    this._canvas.remove();
  },
  show(robots, density, selected, asLastSeen) {
    this._robots = robots;
    this._density = density;
    this._selected = selected;
    this._asLastSeen = asLastSeen;
    this.draw();
  },
  draw() {
    if (this._asked) return;
    this._asked = requestAnimationFrame(() => {
      this._asked = null;
      if (this._map) this._draw();
    });
  },
  _draw() {
    const map = this._map, size = map.getSize(), ratio = window.devicePixelRatio || 1, canvas = this._canvas;
    L.DomUtil.setPosition(canvas, map.containerPointToLayerPoint([0, 0]));
    if (canvas.width !== size.x * ratio || canvas.height !== size.y * ratio) {
      canvas.width = size.x * ratio;
      canvas.height = size.y * ratio;
      canvas.style.width = `${size.x}px`;
      canvas.style.height = `${size.y}px`;
    }
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, size.x, size.y);
    const inView = [];
    for (const one of this._robots ?? []) {
      const at = map.latLngToContainerPoint(one.place);
      if (at.x < -SIZE || at.y < -SIZE || at.x > size.x + SIZE || at.y > size.y + SIZE) continue;
      inView.push([one, at]);
    }
    this.circles = this._density ? this._circles(context, size) : [];
    const counted = this.circles.reduce((sum, { robots }) => sum + robots, 0);
    for (const [one, at] of inView) this._robot(context, one, at);
    this.fire("drawn", { robots: this._density ? counted : inView.length });
    if (inView.length > NAMED_AT_MOST) return;
    context.font = "600 13px system-ui, sans-serif";
    context.lineWidth = 3;
    for (const [one, at] of inView) {
      context.strokeStyle = "#ffffff";
      context.strokeText(one.robot, at.x + SIZE, at.y - SIZE / 2);
      context.fillStyle = "#14181c";
      context.fillText(one.robot, at.x + SIZE, at.y - SIZE / 2);
    }
  },
  /** Draw circles with how many robots are about there; return those that are in view. */
  _circles(context, size) {
    const { cells, edge } = this._density, [a, b] = edge.map((place) => this._map.latLngToContainerPoint(place));
    // Cells that are as large as a world are not grouped for ever.
    let together = 1;
    while (together < 64 && a.distanceTo(b) * together < APART) together *= 2;
    const placed = cells.map((one) => ({ ...one, at: this._map.latLngToContainerPoint(one.place) }));
    const circles = grouped(placed, together).filter(({ x, y }) => x >= 0 && y >= 0 && x <= size.x && y <= size.y);
    const words = new Intl.NumberFormat(document.documentElement.lang, { notation: "compact", maximumSignificantDigits: 2 });
    for (const one of circles) {
      one.radius = Math.min(15 + 4 * Math.log10(one.robots), APART / 2 - 1);
      this._circle(context, one, one.robots < 1000 ? String(one.robots) : words.format(one.robots));
    }
    return circles;
  },
  _circle(context, { x, y, radius, robots, counts }, text) {
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fillStyle = "#ffffff";
    context.fill();
    context.lineWidth = RING;
    let from = -Math.PI / 2;
    counts.forEach((count, k) => {
      const to = from + (2 * Math.PI * count) / robots;
      context.beginPath();
      context.arc(x, y, radius - RING / 2, from, to);
      context.strokeStyle = this._asLastSeen ? AS_LAST_SEEN : COUNTED[k];
      if (count) context.stroke();
      from = to;
    });
    context.font = "700 13px system-ui, sans-serif";
    context.fillStyle = "#14181c";
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillText(text, x, y);
    context.textAlign = "start";
    context.textBaseline = "alphabetic";
  },
  _robot(context, one, at) {
    const look = one.isUnsure ? UNSURE : (STATES[one.state] ?? STATES.offline);
    context.save();
    context.translate(at.x, at.y);
    if (one.robot === this._selected) {
      context.beginPath();
      context.arc(0, 0, SIZE + 6, 0, 2 * Math.PI);
      context.lineWidth = 3;
      context.strokeStyle = "#0b57a4";
      context.stroke();
    }
    context.beginPath();
    if (one.bearing === null) {
      context.arc(0, 0, SIZE * 0.6, 0, 2 * Math.PI);
    } else {
      context.rotate(one.bearing);
      context.moveTo(0, -SIZE);
      context.lineTo(SIZE * 0.7, SIZE * 0.8);
      context.lineTo(0, SIZE * 0.45);
      context.lineTo(-SIZE * 0.7, SIZE * 0.8);
      context.closePath();
    }
    context.fillStyle = this._asLastSeen && !look.dashes ? AS_LAST_SEEN : look.fill;
    context.strokeStyle = "#ffffff";
    context.lineWidth = look.dashes ? 5 : 2;
    context.fill();
    context.stroke();
    if (look.dashes) {
      context.strokeStyle = this._asLastSeen ? AS_LAST_SEEN : look.colour;
      context.lineWidth = 3;
      context.setLineDash(look.dashes);
      context.stroke();
    }
    context.restore();
    if (look.text && !this._asLastSeen) {
      context.font = "800 14px system-ui, sans-serif";
      context.fillStyle = look.colour ?? look.fill;
      context.fillText(look.text, at.x - 4, at.y - SIZE - 3);
    }
  },
});

/**
 * Events: `robot` (detail: name, or null beside all), `place` (detail: {lat, lng}), `moved` (it shows something else),
 * `drawn` (detail: how many robots are in view), `tiles-failed`, `tiles-came`.
 */
export class SiteMap extends EventTarget {
  constructor(element) {
    super();
    this._map = L.map(element, { zoomControl: true, preferCanvas: true, maxZoom: LARGEST_ZOOM, zoomSnap: 0.25 });
    this._map.attributionControl.setPrefix(false);
    this._map.setView([0, 0], 2);
    this._site = L.layerGroup().addTo(this._map);
    this._layer = new RobotLayer().addTo(this._map);
    this._robots = [];
    this._density = null;
    this._toEarth = this._toSite = null;
    this.isChoosing = false;
    this._layer.on("drawn", ({ robots }) => this.dispatchEvent(new CustomEvent("drawn", { detail: robots })));
    this._map.on("moveend", () => this.dispatchEvent(new Event("moved")));
    this._map.on("click", (event) => this._tapped(event));
    // What is under the finger when it comes down is what was meant: until it is let go the map may move, and robots do.
    element.addEventListener("pointerdown", (event) => (this._touched = event.isPrimary ? this._at(event) : null), true);
  }

  /** Draw a site as site.json gives it, and look at the whole of it, unless it is the one that is seen already. */
  showSite(site, isSeen) {
    this._site.clearLayers();
    this._toEarth = earthOf(site.to_earth);
    this._toSite = siteOf(site.to_earth);
    this._density = null;
    if (site.tiles) this._addTiles(site.tiles);
    const plain = { interactive: false };
    for (const one of site.surfaces) {
      L.polygon(one.rings.map(swapped), { ...plain, stroke: false, fillColor: SURFACES, fillOpacity: 0.55 }).addTo(this._site);
    }
    L.polyline(site.roads.map(swapped), { ...plain, color: ROADS, weight: 2, dashArray: "6 4" }).addTo(this._site);
    L.polyline(site.obstacles.map(swapped), { ...plain, color: OBSTACLES, weight: 1.5 }).addTo(this._site);
    for (const one of site.keepouts) {
      L.polygon(one.rings.map(swapped), { ...plain, color: KEEPOUTS, weight: 2, fillOpacity: 0.2 }).addTo(this._site);
    }
    const rim = L.polyline(swapped(site.bounds), { ...plain, color: BOUNDS, weight: 2 }).addTo(this._site);
    this._bounds = rim.getBounds();
    if (!isSeen) this.showWhole();
  }

  /** Draw neither site nor robots: metres are other places now, and it is not known yet which. */
  hideSite() {
    this._site.clearLayers();
    this._toEarth = this._toSite = this._density = null;
    this._robots = [];
    this._touched = null;
    this._layer.show([], null, null, false);
  }

  showWhole() {
    if (this._bounds) this._map.fitBounds(this._bounds, { padding: [10, 10], animate: false });
  }

  /** What the map shows, as x_min, y_min, x_max, y_max in the site frame; null before a site is shown. */
  get seen() {
    if (!this._toSite) return null;
    const rim = this._map.getBounds();
    const corners = [rim.getNorthWest(), rim.getNorthEast(), rim.getSouthEast(), rim.getSouthWest()];
    const places = corners.map(({ lat, lng }) => this._toSite(lat, lng)), xs = places.map(([x]) => x), ys = places.map(([, y]) => y);
    return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
  }

  /**
   * Show robots: each with x, y, theta in the site frame, state; those without a place are nowhere. With a density they
   * are besides those that it counts.
   */
  showRobots(robots, density, selected, asLastSeen) {
    if (!this._toEarth) return;
    this._robots = [];
    for (const one of robots) {
      if (one.x === undefined || one.y === undefined) continue;
      const isUnsure = one.state === "fresh" && Boolean(one.doubt);
      this._robots.push({ robot: one.robot, state: one.state, isUnsure, place: this._toEarth(one.x, one.y), bearing: this._bearing(one) });
    }
    // Hundreds with an alarm would hide the numbers, which have them in red.
    if (density && this._robots.length > NAMED_AT_MOST) this._robots = this._robots.filter(({ robot }) => robot === selected);
    this._layer.show(this._robots, density && this._placed(density), selected, asLastSeen);
  }

  /** Return the cells of a density with their places on the earth, and the two ends of a cell's edge. */
  _placed(density) {
    if (this._density?.of !== density) {
      const cells = cellsOf(density).map((one) => ({ ...one, place: this._toEarth(one.x, one.y) }));
      const edge = [0, density.cell].map((along) => this._toEarth(density.x + along, density.y));
      this._density = { of: density, cells, edge };
    }
    return this._density;
  }

  /** Put a robot into the middle of what is seen above a sheet that covers so many pixels of the map. */
  lookAt(name, covered) {
    const one = this._robots.find(({ robot }) => robot === name);
    if (!one) return;
    const at = this._map.latLngToContainerPoint(one.place), size = this._map.getSize();
    this._map.panBy(at.subtract([size.x / 2, (size.y - covered) / 2]), { animate: false });
  }

  markTarget(place) {
    this._target?.remove();
    this._target = place && L.circleMarker(place, { radius: 10, color: "#b00020", weight: 3, fillOpacity: 0.1, interactive: false }).addTo(this._map);
  }

  showMe(place, accuracy) {
    this._me?.remove();
    this._me = L.layerGroup([
      L.circle(place, { radius: accuracy, color: "#6a1b9a", weight: 1, fillOpacity: 0.1, interactive: false }),
      L.circleMarker(place, { radius: 7, color: "#ffffff", weight: 2, fillColor: "#6a1b9a", fillOpacity: 1, interactive: false }),
    ]).addTo(this._map);
  }

  centreOn(place) {
    this._map.setView(place, Math.max(this._map.getZoom(), 18));
  }

  resized() {
    this._map.invalidateSize({ animate: false });
  }

  _bearing({ x, y, theta }) {
    if (theta === undefined) return null;
    const [lat, lon] = this._toEarth(x, y), [lat2, lon2] = this._toEarth(x + Math.cos(theta), y + Math.sin(theta));
    return Math.atan2((lon2 - lon) * Math.cos((lat * Math.PI) / 180), lat2 - lat);
  }

  _addTiles({ url, attribution, largest_zoom }) {
    const tiles = L.tileLayer(url, {
      maxNativeZoom: largest_zoom,
      maxZoom: LARGEST_ZOOM,
      attribution: escaped(attribution),
    });
    tiles.on("tileerror", () => this.dispatchEvent(new Event("tiles-failed")));
    tiles.on("tileload", () => this.dispatchEvent(new Event("tiles-came")));
    tiles.addTo(this._site);
  }

  _tapped(event) {
    // Assistive programs send a click alone.
    const { lat, lng, nearest, circle } = this._touched ?? this._at(event.originalEvent);
    this._touched = null;
    if (this.isChoosing) {
      this.dispatchEvent(new CustomEvent("place", { detail: { lat, lng } }));
      return;
    }
    if (nearest === null && circle) this._map.setZoomAround(L.point(circle.x, circle.y), this._map.getZoom() + CLOSER);
    else this.dispatchEvent(new CustomEvent("robot", { detail: nearest }));
  }

  /** Return the place under a finger, the robot that is nearest to it, and the circle there. */
  _at(event) {
    const { lat, lng } = this._map.mouseEventToLatLng(event), point = this._map.mouseEventToContainerPoint(event);
    let nearest = null, least = FINGER;
    for (const one of this._robots) {
      const away = this._map.latLngToContainerPoint(one.place).distanceTo(point);
      if (away < least) [nearest, least] = [one.robot, away];
    }
    const circle = this._layer.circles?.find(({ x, y, radius }) => point.distanceTo([x, y]) < Math.max(radius, FINGER));
    return { lat, lng, nearest, circle };
  }
}

function escaped(text) {
  const element = document.createElement("span");
  element.textContent = text;
  return element.innerHTML;
}

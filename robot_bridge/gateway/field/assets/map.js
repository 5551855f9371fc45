/** The map: the site on a Web Mercator map, and the robots on one canvas above it. */

const STATES = {
  fresh: { fill: "#136b2c", text: "" },
  stale: { fill: "#b36b00", text: "?" },
  lost: { fill: "#b00020", text: "!" },
  offline: { fill: "#5b6670", text: "–" },
};
const AS_LAST_SEEN = "#5b6670";
const SIZE = 13;
const NAMED_AT_MOST = 80;
const FINGER = 28;
const SURFACES = "#c9c2b2", ROADS = "#7a6f5d", KEEPOUTS = "#b00020", OBSTACLES = "#4a4f55", BOUNDS = "#0b57a4";
const LARGEST_ZOOM = 24;

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
  show(robots, selected, asLastSeen) {
    this._robots = robots;
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
    this.drawn = inView.length;
    for (const [one, at] of inView) this._robot(context, one, at);
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
  _robot(context, one, at) {
    const look = STATES[one.state] ?? STATES.offline;
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
    context.fillStyle = this._asLastSeen ? AS_LAST_SEEN : look.fill;
    context.strokeStyle = "#ffffff";
    context.lineWidth = 2;
    context.fill();
    context.stroke();
    context.restore();
    if (look.text && !this._asLastSeen) {
      context.font = "800 14px system-ui, sans-serif";
      context.fillStyle = look.fill;
      context.fillText(look.text, at.x - 4, at.y - SIZE - 3);
    }
  },
});

/** Events: `robot` (detail: name, or null beside all), `place` (detail: {lat, lng}), `tiles-failed`, `tiles-came`. */
export class SiteMap extends EventTarget {
  constructor(element) {
    super();
    this._map = L.map(element, { zoomControl: true, preferCanvas: true, maxZoom: LARGEST_ZOOM, zoomSnap: 0.25 });
    this._map.attributionControl.setPrefix(false);
    this._map.setView([0, 0], 2);
    this._site = L.layerGroup().addTo(this._map);
    this._layer = new RobotLayer().addTo(this._map);
    this._robots = [];
    this._toEarth = null;
    this.isChoosing = false;
    this._map.on("click", (event) => this._tapped(event));
  }

  /** Draw a site as site.json gives it, and look at the whole of it. */
  showSite(site) {
    this._site.clearLayers();
    this._toEarth = earthOf(site.to_earth);
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
    this.showWhole();
  }

  showWhole() {
    if (this._bounds) this._map.fitBounds(this._bounds, { padding: [10, 10], animate: false });
  }

  /** Show robots: each with x, y, theta in the site frame, state; those without a place are nowhere. */
  showRobots(robots, selected, asLastSeen) {
    if (!this._toEarth) return;
    this._robots = [];
    for (const one of robots) {
      if (one.x === undefined || one.y === undefined) continue;
      this._robots.push({ robot: one.robot, state: one.state, place: this._toEarth(one.x, one.y), bearing: this._bearing(one) });
    }
    this._layer.show(this._robots, selected, asLastSeen);
  }

  /** How many robots were drawn last, being in view. */
  get drawn() {
    return this._layer.drawn ?? 0;
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

  _tapped({ latlng, containerPoint }) {
    if (this.isChoosing) {
      this.dispatchEvent(new CustomEvent("place", { detail: { lat: latlng.lat, lng: latlng.lng } }));
      return;
    }
    let nearest = null, least = FINGER;
    for (const one of this._robots) {
      const away = this._map.latLngToContainerPoint(one.place).distanceTo(containerPoint);
      if (away < least) [nearest, least] = [one.robot, away];
    }
    this.dispatchEvent(new CustomEvent("robot", { detail: nearest }));
  }
}

function escaped(text) {
  const element = document.createElement("span");
  element.textContent = text;
  return element.innerHTML;
}

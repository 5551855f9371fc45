/** Where the phone is: shown on the map, and centred once it is known. */

import { tr } from "/field/texts.js";

export class OwnPosition {
  constructor(map, banners) {
    this._map = map;
    this._banners = banners;
    this._watch = null;
  }

  /** Follow the phone's position from now on, and centre the map on the first one. */
  find() {
    if (!window.isSecureContext) {
      this._banners.show("me", tr("The position of a phone is given to pages with https only."));
      return;
    }
    if (this._watch !== null) navigator.geolocation.clearWatch(this._watch);
    let isFirst = true;
    this._watch = navigator.geolocation.watchPosition(
      ({ coords }) => {
        const place = [coords.latitude, coords.longitude];
        this._map.showMe(place, coords.accuracy);
        this._banners.show("me", tr("You are here, within {m} m", { m: Math.round(coords.accuracy) }));
        if (isFirst) this._map.centreOn(place);
        isFirst = false;
      },
      (error) => this._banners.show("me", tr("This phone does not say where it is: {reason}", { reason: error.message })),
      { enableHighAccuracy: true },
    );
  }
}

// Counts in window.fleetFrames how often the robots of the field page are drawn.
const clear = CanvasRenderingContext2D.prototype.clearRect;
window.fleetFrames = 0;
CanvasRenderingContext2D.prototype.clearRect = function (...box) {
  if (this.canvas.parentNode?.classList.contains("leaflet-marker-pane")) window.fleetFrames += 1;
  return clear.apply(this, box);
};

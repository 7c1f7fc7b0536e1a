// Colours of the limbs: blue pulls, red pushes, grey carries nothing.

import { THREE } from "three";

const stops = ["#2166ac", "#c9ccd1", "#b2182b"].map((hex) => new THREE.Color(hex));

/** Colour of an axial force as a fraction of the scale, -1 (tension) to 1 (compression). */
export function forceColour(fraction) {
  const x = Math.max(-1, Math.min(1, fraction));
  return stops[1].clone().lerp(x < 0 ? stops[0] : stops[2], Math.abs(x));
}

/** The same scale as a CSS gradient. */
export const forceGradient = `linear-gradient(to right, ${[-1, 0, 1].map((x) => `#${forceColour(x).getHexString()}`)})`;

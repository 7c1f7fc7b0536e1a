// The recorded runs, unpacked when they are asked for.

const raw = JSON.parse(document.getElementById("data").textContent);

export const { geometry, singularRegion, modes, styles, groups, cases } = raw;

const unpacked = new Map();

/** Numbers of a packed channel. */
export function numbers(packed) {
  if (!unpacked.has(packed)) {
    const bytes = Uint8Array.from(atob(packed), (character) => character.charCodeAt(0));
    unpacked.set(packed, new Float32Array(bytes.buffer));
  }
  return unpacked.get(packed);
}

/** One colour a control mode on the whole page. */
export const colour = (mode) => styles[mode].colour;

/** Index of the sample at or before a time (s), within the run's length. */
export function sampleAt(time, length, now) {
  const step = time.length > 1 ? time[1] - time[0] : 1;
  return Math.min(Math.floor(now / step + 1e-3), length - 1);
}

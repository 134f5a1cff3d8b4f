// Ticks once a second. See metronome.ts.
setInterval(() => (postMessage as (message: unknown) => void)(0), 1000);
export {};

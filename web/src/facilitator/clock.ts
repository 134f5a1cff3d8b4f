// The server's clock, and times as people read them.
import { createContext } from 'preact';
import { useContext, useEffect, useState } from 'preact/hooks';
import { duration } from '../shared/duration';

// Milliseconds to add to this computer's clock, which may be wrong by hours.
export const ClockOffset = createContext(0);

export function useNow(every_ms = 1000): number {
  const offset = useContext(ClockOffset);
  const [, tick] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => tick((n) => n + 1), every_ms);
    return () => clearInterval(timer);
  }, [every_ms]);
  return Date.now() + offset;
}

// "14:03:22", in the reader's time zone.
export function clockText(at_ms: number): string {
  return new Date(at_ms).toLocaleTimeString('en-GB', { hour: '2-digit', minute: '2-digit', second: '2-digit' });
}

export function secondsText(ms: number): string {
  return ms < 100_000 ? `${(ms / 1000).toFixed(ms < 10_000 ? 1 : 0)} s` : `${duration(ms)} min`;
}

// "8 to 12 min"
export function minutesText(low: number, high: number): string {
  const [a, b] = [Math.max(0, Math.round(low)), Math.max(0, Math.round(high))];
  if (b === 0) return 'under 1 min';
  return a === b ? `${b} min` : `${a} to ${b} min`;
}

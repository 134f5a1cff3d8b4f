// The server's clock, whatever the clock of this computer says.
import { useEffect, useState } from 'preact/hooks';

let offset = Date.now() - performance.now();

export function setServerTime(serverMs: number): void {
  offset = serverMs - performance.now();
}

export const serverNow = (): number => offset + performance.now();

// Renders again every second.
export function useTick(): void {
  const [, setCount] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => setCount((count) => count + 1), 1000);
    return () => clearInterval(timer);
  }, []);
}

// "1:05", "1:02:05"
export function duration(ms: number): string {
  const seconds = Math.max(0, Math.floor(ms / 1000));
  const two = (n: number): string => String(n).padStart(2, '0');
  const [h, m, s] = [Math.floor(seconds / 3600), Math.floor(seconds / 60) % 60, seconds % 60];
  return h > 0 ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)}`;
}

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

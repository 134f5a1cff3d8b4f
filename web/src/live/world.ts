// Tables of moves, as the server has them.
import { useLayoutEffect, useState } from 'preact/hooks';
import { World, type WorldDocument } from '../shared/play/world';
import { transport } from '../shared/transport';

const worlds = new Map<string, World>();

async function fetchWorld(key: string, token: string): Promise<World> {
  return new World((await transport().get(`/api/world/${encodeURIComponent(key)}`, token)) as WorldDocument);
}

// The world of a key, as soon as it is there; tries until it succeeds.
export function useWorld(key: string | undefined, token: string): { world: World | null; hasTrouble: boolean } {
  const [, setCount] = useState(0);
  const [hasTrouble, setTrouble] = useState(false);
  useLayoutEffect(() => {
    if (key === undefined || worlds.has(key)) return;
    let isOver = false;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const attempt = (pause: number): void => {
      fetchWorld(key, token).then(
        (world) => {
          worlds.set(key, world);
          if (isOver) return;
          setTrouble(false);
          setCount((count) => count + 1);
        },
        () => {
          if (isOver) return;
          setTrouble(true);
          timer = setTimeout(() => attempt(Math.min(8000, 2 * pause)), pause);
        },
      );
    };
    attempt(500);
    return () => {
      isOver = true;
      clearTimeout(timer);
    };
  }, [key, token]);
  return { world: key === undefined ? null : (worlds.get(key) ?? null), hasTrouble };
}

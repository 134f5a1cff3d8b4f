// How wide an element is, and how high the window.
import { useLayoutEffect, useState } from 'preact/hooks';

export function useWidth(): [(box: HTMLElement | null) => void, number] {
  const [box, setBox] = useState<HTMLElement | null>(null);
  const [width, setWidth] = useState(0);
  useLayoutEffect(() => {
    if (!box) return;
    const watcher = new ResizeObserver(() => setWidth(box.clientWidth));
    watcher.observe(box);
    return () => watcher.disconnect();
  }, [box]);
  return [setBox, width];
}

export function useWindowHeight(): number {
  const [height, setHeight] = useState(window.innerHeight);
  useLayoutEffect(() => {
    const changed = (): void => setHeight(window.innerHeight);
    window.addEventListener('resize', changed);
    return () => window.removeEventListener('resize', changed);
  }, []);
  return height;
}
